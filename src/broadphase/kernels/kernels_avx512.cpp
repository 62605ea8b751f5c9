// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// It stays beside AVX2: with 100,000 boxes a frame takes 12 to 23 % less time. Only robots with 1,000,000 boxes take more
// (doc/benchmark_figures.md, "hgrid: instruction sets and threads").
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
