// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/exactness/exactness_tally.h"

#include <algorithm>
#include <cmath>

#include "bench/measure/median.h"

namespace hgrid {
namespace bench {

void ExactnessTally::add(const ExactnessAnswer& answer, const ExactnessWitness& truth, double move, double shortest) {
  ++pairs_;
  if (!answer.given) {
    ++unanswered_;
    return;
  }
  if (!answer.touches && truth.overlap() && shortest > rounding_) {
    ++lost_;
    deepest_lost_ = std::max(deepest_lost_, shortest);
  }
  const test::Interval distance = truth.distance();
  if (answer.touches && distance.lower > rounding_) {
    ++false_;
    farthest_false_ = std::max(farthest_false_, distance.lower);
  }
  if (!std::isnan(answer.distance)) addDistance(answer, distance);
  if (!answer.touches || std::isnan(move)) return;
  ++depths_;
  left_ = std::max(left_, move - std::max(answer.depth, 0.0));
  too_long_ = std::max(too_long_, move - shortest);
}

void ExactnessTally::addDistance(const ExactnessAnswer& answer, const test::Interval& truth) {
  errors_.push_back(truth.errorOf(answer.distance));
  if (std::isnan(answer.lower_bound) || answer.touches) return;
  has_bounds_ = true;
  widest_ = std::max(widest_, answer.distance - answer.lower_bound);
  outside_ = std::max({outside_, truth.lower - answer.distance, answer.lower_bound - truth.upper});
}

void ExactnessTally::describe(Record& record) const {
  const auto count = [&](const char* name, std::size_t value) { record.number(name, static_cast<double>(value)); };
  count("pairs", pairs_);
  count("unanswered", unanswered_);
  count("lost", lost_);
  record.number("deepest_lost", deepest_lost_);
  count("false", false_);
  record.number("farthest_false", farthest_false_);
  if (!errors_.empty()) {
    record.number("median_error", medianOf(errors_));
    record.number("largest_error", *std::max_element(errors_.begin(), errors_.end()));
  }
  count("depths", depths_);
  record.number("left", left_).number("too_long", too_long_);
  if (has_bounds_) record.number("widest", widest_).number("outside", outside_);
}

}  // namespace bench
}  // namespace hgrid
