// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>

#include "node/tick/tick.h"

namespace hgrid {

/// The part of the world that the markers show, and the size of texts and lines in it. If the whole part is on the
/// screen, the texts can be read.
///
/// The box and the height change in steps, so that texts stay where they are while bodies move a little.
struct MarkerScale {
  Eigen::AlignedBox3d world;  ///< [m, world] contains all placed bodies apart from planes, maps and clouds; not empty
  double text_height;         ///< [m]
};

MarkerScale scaleOf(const Tick& tick);

}  // namespace hgrid
