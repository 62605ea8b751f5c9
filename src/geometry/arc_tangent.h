// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Returns the angle [rad] of the direction (x, y) from the x axis, in [-pi, pi]; 0 if both are 0. The error is a few
/// units in the last place. The function of the C library is more accurate, but its results differ between systems.
double arcTangent(double y, double x);

}  // namespace hgrid
