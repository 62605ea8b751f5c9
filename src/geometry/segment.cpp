// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/segment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/rounding.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {
namespace {

/// The fractions 0 and 1, and the fractions between them at which the point from + fraction * step crosses the plane of
/// a face of the box. Sorted.
struct Breaks {
  std::array<double, 8> fraction{};
  std::size_t count = 0;
};

Breaks breaksOf(const Eigen::Vector3d& from, const Eigen::Vector3d& step, const Aabb& box) {
  Breaks breaks;
  breaks.fraction[breaks.count++] = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (step[axis] == 0.0) continue;
    for (const double plane : {static_cast<double>(box.min[axis]), static_cast<double>(box.max[axis])}) {
      const double fraction = (plane - from[axis]) / step[axis];
      if (fraction > 0.0 && fraction < 1.0) breaks.fraction[breaks.count++] = fraction;
    }
  }
  breaks.fraction[breaks.count++] = 1.0;
  std::sort(breaks.fraction.begin(), breaks.fraction.begin() + static_cast<std::ptrdiff_t>(breaks.count));
  return breaks;
}

/// Between two breaks, the squared distance from the point to the box is a quadratic function of the fraction. This
/// struct describes the function as least + a * (fraction - lowest)².
///
/// `lowest` may be outside of the two breaks. The form a * fraction² + b * fraction + c would lose precision far away
/// from the box.
struct Piece {
  double a = 0.0, lowest = 0.0, least = 0.0;
};

Piece pieceBetween(double begin, double end, const Eigen::Vector3d& from, const Eigen::Vector3d& step,
                   const Aabb& box) {
  const Eigen::Vector3d middle = from + 0.5 * (begin + end) * step;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero(), rate = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    if (middle[axis] >= low && middle[axis] <= high) continue;
    offset[axis] = from[axis] - (middle[axis] < low ? low : high);
    rate[axis] = step[axis];
  }
  Piece piece;
  piece.a = rate.squaredNorm();
  if (piece.a > 0.0) piece.lowest = -rate.dot(offset) / piece.a;
  piece.least = (offset + piece.lowest * rate).squaredNorm();
  return piece;
}

}  // namespace

std::optional<Meeting> meet(const Segment& segment, const Aabb& box) {
  const Eigen::Vector3d step = segment.to - segment.from;
  const double reach = std::max(segment.from.cwiseAbs().maxCoeff(), segment.to.cwiseAbs().maxCoeff()) + segment.radius;
  const double radius = segment.radius + roundingSlack(reach);
  const auto distanceAt = [&](double fraction) { return distance(box, segment.from + fraction * step); };

  const Breaks breaks = breaksOf(segment.from, step, box);
  double best = distanceAt(0.0), best_fraction = 0.0;
  std::optional<double> first;
  if (best <= radius) first = 0.0;
  for (std::size_t i = 0; i + 1 < breaks.count; ++i) {
    const double begin = breaks.fraction[i], end = breaks.fraction[i + 1];
    const Piece piece = pieceBetween(begin, end, segment.from, step, box);
    const double lowest = piece.a > 0.0 ? std::clamp(piece.lowest, begin, end) : end;
    for (const double fraction : {lowest, end}) {  // also the end, because rounding may have moved `lowest`
      const double here = distanceAt(fraction);
      if (here <= radius && !first) {
        // `root` is the smaller solution of least + a * (fraction - lowest)² = radius².
        const double rise = std::max(radius * radius - piece.least, 0.0);
        const double root = piece.a > 0.0 ? piece.lowest - std::sqrt(rise / piece.a) : begin;
        first = std::clamp(root, begin, fraction);
      }
      if (here < best) best = here, best_fraction = fraction;
    }
  }
  if (!first) return std::nullopt;
  return Meeting{*first * step.norm(), best, nearestPoint(box, segment.from + best_fraction * step)};
}

FirstTouch::FirstTouch(const Segment& segment, double error)
    : segment_(segment), error_(error), clips_(segment.radius == 0.0) {
  const Eigen::Vector3d step = segment.to - segment.from;
  // This is more than the tolerance of meet() and more than the rounding errors of this class.
  const double slack = 2.0 * roundingSlack(segment.from.lpNorm<1>() + segment.to.lpNorm<1>()) + error;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::abs(step[axis]);
    clips_ = clips_ && (size == 0.0 || (size > kLeastStep && size < 1e100));
    inverse_[axis] = 1.0 / step[axis];
    rounded_[axis] = slack * std::abs(inverse_[axis]);
  }
  length_ = step.norm();
}

std::optional<double> FirstTouch::operator()(const Aabb& box) const {
  double enter = 0.0, surely_in = 0.0, surely_out = 1.0, perhaps_in = 0.0, perhaps_out = 1.0;
  bool plain = clips_;
  for (int axis = 0; axis < 3 && plain; ++axis) {
    const double from = segment_.from[axis], to = segment_.to[axis];
    if (from == to) {
      plain = box.min[axis] < from && from < box.max[axis];
      continue;
    }
    const double a = (box.min[axis] - from) * inverse_[axis], b = (box.max[axis] - from) * inverse_[axis];
    const double in = std::min(a, b), out = std::max(a, b);
    enter = std::max(enter, in);
    surely_in = std::max(surely_in, in + rounded_[axis]);
    surely_out = std::min(surely_out, out - rounded_[axis]);
    perhaps_in = std::max(perhaps_in, in - rounded_[axis]);
    perhaps_out = std::min(perhaps_out, out + rounded_[axis]);
  }
  if (plain && surely_in < surely_out) return enter * length_;
  if (plain && perhaps_in > perhaps_out) return std::nullopt;
  const auto meeting = meet({segment_.from, segment_.to, segment_.radius + error_}, box);
  return meeting ? std::optional<double>(meeting->along) : std::nullopt;
}

}  // namespace hgrid
