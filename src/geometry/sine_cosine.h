// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "geometry/four_doubles.h"

namespace hgrid {

/// [rad] Largest angle of sineCosine().
constexpr double kLargestAngle = 1e8;

/// The sines and cosines of four angles.
struct SineCosine {
  FourDoubles sine, cosine;
};

/// Returns the sines and cosines of angles [rad] from -kLargestAngle to kLargestAngle. The error is a few units in the
/// last place of 1. The functions of the C library would be more accurate, but their results differ between systems.
SineCosine sineCosine(const FourDoubles& angles);

}  // namespace hgrid
