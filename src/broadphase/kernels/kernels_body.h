// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The algorithm, in the words of one thin layer of vector operations: the including file has defined a type Simd (see
// simd_portable.h for what each operation means) in its own unnamed namespace. One text, several instruction sets.
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
