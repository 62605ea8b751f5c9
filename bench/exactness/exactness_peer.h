// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace bench {

/// What a library says about two shapes. A value that the library does not tell is NaN.
struct ExactnessAnswer {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  bool given = false;             ///< whether the library answered at all
  bool touches = false;           ///< whether the shapes are in contact
  double distance = kUnknown;     ///< [m] 0 in contact
  double lower_bound = kUnknown;  ///< [m] the distance is at least this; only hgrid tells it
  double depth = kUnknown;        ///< [m] moving the second shape this far along the normal separates the shapes
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kUnknown);  ///< unit vector from the first shape to the second
};

/// A library that measures two convex shapes, as its documentation tells users to do it, and with its best accuracy.
struct ExactnessPeer {
  std::string name;
  std::function<ExactnessAnswer(const test::Case&)> measure;
  bool has_cones = true;  ///< whether the library has cones

  /// Returns whether the library has shapes of these kinds.
  bool knows(const test::Case& placed) const {
    const auto isKnown = [&](const Shape& shape) { return has_cones || shape.kind() != ShapeKind::cone; };
    return isKnown(placed.first_shape) && isKnown(placed.second_shape);
  }
};

/// Returns the peers that this program was built with, hgrid first.
std::vector<ExactnessPeer> exactnessPeers();

// Declared but not defined if the library was not found.
ExactnessAnswer measureWithFclLibccd(const test::Case& placed);
ExactnessAnswer measureWithFclIndep(const test::Case& placed);
ExactnessAnswer measureWithBulletFloat(const test::Case& placed);
ExactnessAnswer measureWithBulletDouble(const test::Case& placed);
ExactnessAnswer measureWithCcdGjk(const test::Case& placed);
ExactnessAnswer measureWithCcdMpr(const test::Case& placed);
ExactnessAnswer measureWithOde(const test::Case& placed);

}  // namespace bench
}  // namespace hgrid
