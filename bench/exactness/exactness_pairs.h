// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "test/narrow/narrow_phase_cases.h"

namespace hgrid {
namespace bench {

/// Pairs of convex shapes of one size and one class, the same in each run.
struct ExactnessWorld {
  bool thin;    ///< sides down to a ten-thousandth of the size; otherwise down to a tenth
  double size;  ///< [m] the longest side of the shapes

  std::string shapes() const { return thin ? "thin" : "ordinary"; }
  /// Returns so many pairs. Every other one is aimed (test::AimedCases); the others are at random poses, so that about
  /// half of them overlap.
  std::vector<test::Case> pairs(std::size_t count) const;
};

/// Returns all worlds: ordinary and thin shapes of 1 cm to 1 km.
std::vector<ExactnessWorld> exactnessWorlds();

}  // namespace bench
}  // namespace hgrid
