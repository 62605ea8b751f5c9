// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/kernels/simd_avx512.h"

namespace hgrid {
namespace kernels {
namespace {
using Simd = SimdAvx512;
}  // namespace
}  // namespace kernels
}  // namespace hgrid

#include "broadphase/kernels/kernels_body.h"

namespace hgrid {
namespace kernels {

const Kernels& avx512Kernels() { return kKernels; }

}  // namespace kernels
}  // namespace hgrid
