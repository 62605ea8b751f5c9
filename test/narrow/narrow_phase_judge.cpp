// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/narrow/narrow_phase_judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hgrid {
namespace test {
namespace {

constexpr double kMissedDepth = 1e-5;  // [m] a contact deeper than this must not be missed
constexpr double kFree = 1e-5;         // [m] added to the depth, so that the oracle clearly sees two shapes apart

bool isUnit(const Eigen::Vector3d& normal) { return std::abs(normal.norm() - 1.0) <= 1e-9; }

}  // namespace

void Claim::hold(double error, const Case& seen) {
  ++count_;
  const bool is_fault = !(error <= limit_);
  faults_ += is_fault;
  if (error <= worst_) return;
  worst_ = error;
  if (is_fault) worst_case_ = seen.text();
}

void Claim::expectHeld() const {
  EXPECT_EQ(faults_, 0u) << "The rule '" << sentence_ << "' is violated in " << faults_ << " of " << count_
                         << " checks. The largest error is " << worst_ << ", the limit is " << limit_
                         << ". The worst case: " << worst_case_;
}

std::string unsound(const Proximity& answer, double up_to) {
  const bool has_points = answer.on_first.allFinite() && answer.on_second.allFinite();
  switch (answer.status) {
    case Measure::apart:
      if (!(answer.distance > 0.0)) return "the shapes are apart, but the distance is not greater than 0";
      if (!std::isnan(answer.depth)) return "the shapes are apart, but there is a depth";
      if (std::isinf(answer.distance)) return std::isinf(up_to) ? "the distance is infinite without a limit" : "";
      if (answer.distance > up_to) return "the distance is finite, but beyond the limit";
      if (!has_points) return "the shapes are apart, but nearest points are missing";
      return isUnit(answer.normal) ? "" : "the shapes are apart, but the normal is not a unit vector";
    case Measure::contact:
    case Measure::contained:
    case Measure::containment_unknown:
      if (answer.distance != 0.0) return "the shapes are in contact, but the distance is not 0";
      if (!std::isnan(answer.depth) && !(answer.depth >= 0.0)) return "the depth is less than 0";
      if (std::isinf(answer.depth)) return "the depth is infinite";
      if (!answer.normal.hasNaN() && !isUnit(answer.normal)) return "the normal is not a unit vector";
      if (!std::isnan(answer.depth) && answer.normal.hasNaN()) return "there is a depth, but no normal";
      return (answer.on_first.array().isInf() || answer.on_second.array().isInf()).any() ? "a point is infinite" : "";
    case Measure::failed:
      return answer.distance > 0.0 ? "the measurement failed, but there is a distance" : "";
    default:
      return "the shapes were not measured";
  }
}

Judge::Judge(double error)
    : sound_("there is an answer, and it is consistent", 0.0),
      same_("both orders of the shapes give the same answer", 0.0),
      distance_("the distance of separate shapes is right", error),
      false_contact_("shapes that are reported to touch are not apart", error),
      missed_("contact is not missed", 0.0),
      on_shapes_("the nearest points lie on the padded shapes", error),
      between_points_("the nearest points are as far apart as the distance", error),
      normal_("the normal points from the first nearest point to the second", error),
      depth_("moving the second shape by the depth along the normal separates the shapes", 0.0) {}

void Judge::look(const Case& placed) {
  const Trial trial(placed);
  const Proximity answer = trial.measure();
  sound_.hold(unsound(answer).empty() && answer.status != Measure::failed, placed);
  same_.hold(isSameInOtherOrder(placed, answer, trial.measureSwapped()), placed);

  const SolidOracle first = placed.first(), second = placed.second();
  const Interval truth = distanceOf(first, second).interval;
  widest_ = std::max(widest_, truth.width());
  if (answer.status == Measure::apart) {
    judgeApart(placed, answer, truth);
    if (truth.upper < 1e-9) missed_.hold(!overlapByMore(first, second, kMissedDepth), placed);
  } else if (answer.status != Measure::failed) {
    judgeContact(placed, answer, truth);
  }
}

void Judge::judgeApart(const Case& placed, const Proximity& answer, const Interval& truth) {
  distance_.hold(truth.errorOf(answer.distance), placed);
  on_shapes_.hold(
      std::max(distanceOf(placed.first(), answer.on_first).lower, distanceOf(placed.second(), answer.on_second).lower),
      placed);
  const Eigen::Vector3d way = answer.on_second - answer.on_first;
  between_points_.hold(std::abs(way.norm() - answer.distance), placed);
  normal_.hold((way - answer.distance * answer.normal).norm(), placed);
}

void Judge::judgeContact(const Case& placed, const Proximity& answer, const Interval& truth) {
  false_contact_.hold(truth.lower, placed);
  if (std::isnan(answer.depth)) return;
  Case freed = placed;
  freed.world_from_second.translation() += (answer.depth + kFree) * answer.normal;
  const SolidDistance apart = distanceOf(freed.first(), freed.second());
  depth_.hold(apart.interval.lower > 0.0 && !apart.enclosed, placed);
}

void Judge::expectAllHeld() const {
  for (const Claim* claim :
       {&sound_, &same_, &distance_, &false_contact_, &missed_, &on_shapes_, &between_points_, &normal_, &depth_}) {
    claim->expectHeld();
  }
  EXPECT_LE(widest_, 1e-9) << "the oracle's intervals are too wide for a judgment";
}

std::string Judge::figures() const {
  char line[256];
  std::snprintf(line, sizeof(line),
                "%6zu poses  %6zu apart, errors: distance %.1e  points %.1e  normal %.1e  "
                "%6zu in contact, true distance %.1e  %6zu with depth",
                sound_.count(), distance_.count(), distance_.worst(),
                std::max(on_shapes_.worst(), between_points_.worst()), normal_.worst(), false_contact_.count(),
                false_contact_.worst(), depth_.count());
  return line;
}

}  // namespace test
}  // namespace hgrid
