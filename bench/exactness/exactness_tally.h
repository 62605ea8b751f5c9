// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bench/exactness/exactness_peer.h"
#include "bench/exactness/exactness_witness.h"
#include "bench/measure/record.h"

namespace hgrid {
namespace bench {

/// Counts how exact the answers of one peer are in one world.
class ExactnessTally {
 public:
  /// @param size  [m] size of the shapes. 1e-14 of it count as rounding of doubles.
  explicit ExactnessTally(double size) : rounding_(1e-14 * size) {}

  /// @param move      [m] how far the answer's normal and depth move the second shape, and farther if that does not
  ///                  separate the shapes; NaN if the answer has no depth
  /// @param shortest  [m] the shortest move that separates the shapes, of all that are known
  void add(const ExactnessAnswer& answer, const ExactnessWitness& truth, double move, double shortest);

  /// Adds the fields of the table.
  void describe(Record& record) const;

 private:
  void addDistance(const ExactnessAnswer& answer, const test::Interval& truth);

  double rounding_;  // [m]
  std::size_t pairs_ = 0, unanswered_ = 0, lost_ = 0, false_ = 0, depths_ = 0;
  double deepest_lost_ = 0.0, farthest_false_ = 0.0;  // [m]
  std::vector<double> errors_;                        // [m] of the distances
  double left_ = 0.0, too_long_ = 0.0;                // [m] largest errors of the moves
  bool has_bounds_ = false;
  double widest_ = 0.0, outside_ = 0.0;  // [m] of intervals of shapes that are apart: width, truth outside
};

}  // namespace bench
}  // namespace hgrid
