// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bench/measure/record.h"

namespace hgrid {
namespace bench {

/// Times what becomes of a depth camera's messages, 640 x 480 points of a wavy wall 2 .. 4 m away that drifts by 0.1 m/s,
/// 30 a second with a lifetime of a second: read, voxelised with those seen before, and made a StaticGrid.
void playClouds(std::vector<Record>& records);

}  // namespace bench
}  // namespace hgrid
