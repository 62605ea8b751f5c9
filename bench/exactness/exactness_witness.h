// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "test/narrow/narrow_phase_cases.h"
#include "test/support/distance_oracle.h"

namespace hgrid {
namespace bench {

/// What is true of two shapes, as the reference of the tests knows it: a search in extended precision that proves both
/// bounds of each distance (test/support/distance_oracle.h).
class ExactnessWitness {
 public:
  /// @param size  [m] size of the shapes
  ExactnessWitness(const test::Case& placed, double size);

  /// Returns whether the bounds of the distance differ by at most 1e-15 of the size. If not, nothing else counts.
  bool isSure() const { return gap_.upper - gap_.lower <= resolution_; }
  test::Interval distance() const;
  /// Returns whether the shapes have a point in common, to 1e-15 of the size.
  bool overlap() const { return gap_.upper <= resolution_; }

  /// Returns how far [m] the second shape must be moved along `normal`, but at least `from` [m], until the shapes are
  /// apart. `normal` must be a unit vector.
  double separatingMove(const Eigen::Vector3d& normal, double from) const;
  /// Returns an upper bound of the length of the shortest separating move: the best of those along axes of the shapes.
  double moveAlongAxes() const;

 private:
  struct Gap {
    test::Real lower, upper;         // [m] negative: the shapes overlap, and their cores are apart (test::Convex)
    test::Vector3r first_to_second;  // from the nearest point of the first core to that of the second
  };
  Gap gapAfter(const Eigen::Vector3d& move) const;
  double extentsAlong(const Eigen::Vector3d& normal) const;

  const test::Case& placed_;
  double resolution_;  // [m]
  test::Convex first_, second_;
  Gap gap_;
};

}  // namespace bench
}  // namespace hgrid
