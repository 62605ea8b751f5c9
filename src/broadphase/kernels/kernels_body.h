// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The kernels, written in terms of a thin layer of vector operations, the type Simd. Each file that includes this one
// first defines Simd for its instruction set, in its own unnamed namespace. simd_portable.h explains each operation.
#pragma once

#include "broadphase/kernels/boxes_body.h"
#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/levels_body.h"
#include "broadphase/kernels/line_body.h"
#include "broadphase/kernels/pairs_body.h"
#include "broadphase/kernels/sorting_body.h"

namespace hgrid {
namespace kernels {
namespace {

constexpr Kernels kKernels = {sound, key, keyRegions, pairsWithin, pairsAcross, reaching, overlapping, along};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
