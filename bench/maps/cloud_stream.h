// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bench/measure/record.h"

namespace hgrid {
namespace bench {

/// Measures how long the messages of a depth camera take to process: to read the points, add their cells to the cells
/// seen before, and build a StaticGrid. Appends the results to `records`.
///
/// The camera sends 30 messages per second with 640 x 480 points each. It sees a wavy wall that is 2 .. 4 m away and
/// drifts by 0.1 m/s. A cell is kept for one second after the camera last saw it.
void playClouds(std::vector<Record>& records);

}  // namespace bench
}  // namespace hgrid
