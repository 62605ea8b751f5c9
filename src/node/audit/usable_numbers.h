// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// Whether a transform with these numbers is valid. The node refuses other transforms. Uses no code of the folder tf,
/// which the audit checks.
/// @param numbers  translation x, y, z [m], then the quaternion x, y, z, w
inline bool usableNumbers(const std::array<double, 7>& numbers) {
  constexpr double kFarthest = 1e9;  // [m]
  double norm = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i]) || (i < 3 && std::abs(numbers[i]) > kFarthest)) return false;
    if (i >= 3) norm += numbers[i] * numbers[i];
  }
  return std::abs(norm - 1.0) <= kQuaternionTolerance;
}

}  // namespace hgrid
