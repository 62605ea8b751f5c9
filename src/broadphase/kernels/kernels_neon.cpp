// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/kernels/simd_neon.h"

namespace hgrid {
namespace kernels {
namespace {
using Simd = SimdNeon;
}  // namespace
}  // namespace kernels
}  // namespace hgrid

#include "broadphase/kernels/kernels_body.h"

namespace hgrid {
namespace kernels {

const Kernels& neonKernels() { return kKernels; }

}  // namespace kernels
}  // namespace hgrid
