// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/depth_oracle.h"

#include <algorithm>
#include <map>
#include <utility>

namespace hgrid {
namespace test {
namespace {

constexpr Real kTolerance = 1e-8L;  // [m] the search stops when the bounds are this close
constexpr int kMaxSteps = 150;

/// A triangle of the polytope. Its normal points outward. `offset` [m] is the distance of its plane from the origin.
struct Face {
  std::array<int, 3> corners;
  Vector3r normal;
  Real offset;
};

/// A polytope inside the set of all differences of the points of two cores (their Minkowski difference).
class Polytope {
 public:
  Polytope(const Convex& first, const Convex& second)
      : first_(first), second_(second), scale_(first.reach() + second.reach()) {}

  /// Creates the first tetrahedron. Searches its corners along these orthonormal axes.
  /// @returns false if all differences lie in one plane
  bool begin(const std::array<Vector3r, 3>& axes) {
    Real longest = 0;
    for (const Vector3r& axis : axes) {
      const Vector3r high = farthest(axis), low = farthest(-axis);
      if ((high - low).norm() <= longest) continue;
      longest = (high - low).norm();
      points_ = {low, high};
    }
    if (longest <= flat()) return false;
    const Vector3r line = (points_[1] - points_[0]).normalized();
    Vector3r most_off = Vector3r::Zero();
    for (const Vector3r& axis : axes) {
      const Vector3r across = axis - axis.dot(line) * line;
      if (across.norm() < 0.5L) continue;
      for (const Real sign : {-1.0L, 1.0L}) {
        const Vector3r point = farthest(sign * across);
        const Vector3r way = point - points_[0], off = way - way.dot(line) * line;
        if (off.norm() <= most_off.norm()) continue;
        most_off = off;
        points_.resize(2);
        points_.push_back(point);
      }
    }
    if (most_off.norm() <= flat()) return false;
    const Vector3r normal = line.cross(most_off).normalized();
    const Vector3r above = farthest(normal), below = farthest(-normal);
    const Real rise = (above - points_[0]).dot(normal), fall = (points_[0] - below).dot(normal);
    if (std::max(rise, fall) <= flat()) return false;
    points_.push_back(rise > fall ? above : below);
    if (rise > fall) std::swap(points_[0], points_[1]);  // the faces added below must point outward
    return add({0, 1, 2}) && add({1, 0, 3}) && add({2, 1, 3}) && add({0, 2, 3});
  }

  const Face& shallowest() const {
    return *std::min_element(faces_.begin(), faces_.end(),
                             [](const Face& a, const Face& b) { return a.offset < b.offset; });
  }

  Vector3r farthest(const Vector3r& direction) const { return first_.support(direction) - second_.support(-direction); }

  /// Adds a point to the polytope. Removes the faces that the point is in front of, and connects the border of the hole
  /// to the point.
  /// @returns false if the numbers are not precise enough for this
  bool grow(const Vector3r& point) {
    std::map<std::pair<int, int>, int> sides;
    std::vector<Face> kept;
    for (const Face& face : faces_) {
      if (face.normal.dot(point) <= face.offset) {
        kept.push_back(face);
        continue;
      }
      for (int i = 0; i < 3; ++i) ++sides[{face.corners[i], face.corners[(i + 1) % 3]}];
    }
    if (kept.size() == faces_.size()) return false;
    faces_ = kept;
    points_.push_back(point);
    for (const auto& [side, count] : sides) {
      if (sides.count({side.second, side.first})) continue;
      if (!add({side.first, side.second, int(points_.size()) - 1})) return false;
    }
    return true;
  }

  /// Returns whether each side of a face has exactly one opposite side, and no point is in front of a face.
  bool isClosedAndConvex() const {
    std::map<std::pair<int, int>, int> sides;
    for (const Face& face : faces_) {
      for (int i = 0; i < 3; ++i) ++sides[{face.corners[i], face.corners[(i + 1) % 3]}];
      for (const Vector3r& point : points_) {
        if (face.normal.dot(point) > face.offset + rounding()) return false;
      }
    }
    return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
      return side.second == 1 && sides.count({side.first.second, side.first.first});
    });
  }

  Real rounding() const { return 1e-11L * (1 + scale_); }

 private:
  Real flat() const { return 1e-12L * scale_; }

  bool add(const std::array<int, 3>& corners) {
    const Vector3r &a = points_[corners[0]], &b = points_[corners[1]], &c = points_[corners[2]];
    const Vector3r normal = (b - a).cross(c - a);
    if (normal.norm() <= 1e-26L * scale_ * scale_) return false;
    const Vector3r unit = normal.normalized();
    faces_.push_back({corners, unit, unit.dot(a)});
    return true;
  }

  const Convex& first_;
  const Convex& second_;
  Real scale_;
  std::vector<Vector3r> points_;
  std::vector<Face> faces_;
};

/// Returns orthonormal axes. Each attempt rotates them farther, because axes parallel to sides of a shape can fail.
std::array<Vector3r, 3> axesOf(int attempt) {
  const Vector3r x = Vector3r(1, 0.31L * attempt, -0.17L * attempt).normalized();
  const Vector3r y = x.cross(Vector3r(0.13L * attempt, 0.29L * attempt, 1)).normalized();
  return {x, y, x.cross(y)};
}

Interval coreDepth(const Convex& first, const Convex& second, Real enough) {
  Real upper = std::numeric_limits<Real>::infinity();
  for (int attempt = 0; attempt < 4; ++attempt) {  // tries other axes if the growth stops
    Polytope polytope(first, second);
    if (!polytope.begin(axesOf(attempt))) return {};
    Real lower = 0;
    for (int step = 0; step < kMaxSteps; ++step) {
      const Face face = polytope.shallowest();
      lower = std::max<Real>(0, face.offset - polytope.rounding());
      if (lower > enough) break;
      const Vector3r point = polytope.farthest(face.normal);
      upper = std::min(upper, face.normal.dot(point));
      if (upper <= 0) return {};
      if (upper - lower <= kTolerance || !polytope.grow(point)) break;
    }
    if (polytope.isClosedAndConvex()) return {double(lower), double(std::max(lower, upper))};
  }
  return {0.0, double(upper)};
}

}  // namespace

Interval depthOf(const Convex& first, const Convex& second, double enough) {
  const Real radii = first.radius() + second.radius();
  const CoreDistance core = coreDistance(first, second);
  if (core.lower > 0 && core.upper > 1e-10L) {
    return {double(std::max<Real>(0, radii - core.upper)), double(std::max<Real>(0, radii - core.lower))};
  }
  if (radii > enough) return {double(radii), std::numeric_limits<double>::infinity()};
  const Interval depth = coreDepth(first, second, enough - radii);
  const Real known = depth.lower > 0 ? radii + depth.lower : std::max<Real>(0, radii - core.upper);
  return {double(known), double(depth.upper + radii)};
}

}  // namespace test
}  // namespace hgrid
