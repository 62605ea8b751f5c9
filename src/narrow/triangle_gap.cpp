// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/triangle_gap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/infinity.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kTriangleRounding = 4e-15;  // relative to the coordinates: an upper bound of the rounding errors

double limited(double share) { return share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share; }

struct Points {
  Vector on_first = Vector::Zero(), on_second = Vector::Zero();
};

/// Returns the nearest points of two segments (Ericson 2005, section 5.1.9). The formula with cross products is
/// accurate for nearly parallel segments too.
Points nearestOfSegments(const Vector& p, const Vector& d, const Vector& q, const Vector& e) {
  const Vector between = q - p, normal = d.cross(e);
  const double squared = normal.squaredNorm(), ee = e.squaredNorm();
  double s = squared > 0.0 ? limited(between.cross(e).dot(normal) / squared) : 0.0;
  double t = (s * d - between).dot(e);
  if (t > 0.0 && t < ee) {
    t /= ee;
  } else {
    t = t > 0.0 ? 1.0 : 0.0;
    const double dd = d.squaredNorm();
    s = dd > 0.0 ? limited((between + t * e).dot(d) / dd) : 0.0;
  }
  return {p + s * d, q + t * e};
}

/// A triangle with its edges.
struct Prepared {
  explicit Prepared(const Triangle& triangle)
      : corners(triangle), edges{triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]} {}

  const Triangle& corners;
  std::array<Vector, 3> edges;
};

/// Returns the projection of a point onto the plane of a triangle, if the projection is inside the triangle.
///
/// It is a mix of the corners, so it is a point of the triangle also if rounding makes the normal of a thin triangle
/// useless.
std::optional<Vector> projected(const Prepared& triangle, const Vector& point) {
  const Vector &side = triangle.edges[0], &next = triangle.edges[1], rest = point - triangle.corners[0];
  const double squared = side.squaredNorm();
  if (!(squared > 0.0)) return std::nullopt;
  const double along = next.dot(side) / squared;
  const Vector across = next - along * side;
  const double squared_across = across.squaredNorm();
  if (!(squared_across > 0.0)) return std::nullopt;
  const double third = rest.dot(across) / squared_across;
  const double second = rest.dot(side) / squared - third * (1.0 + along);
  if (!(third >= 0.0 && second >= 0.0 && second + third <= 1.0)) return std::nullopt;
  return triangle.corners[0] + (second + third) * side + third * next;
}

/// Returns true only if another triangle is on one side of the plane of a triangle, and at least `enough` [m] from it.
/// This quick test proves that most triangles that do not touch are apart.
/// @param doubt  [m^3] bound of the rounding errors of a distance from the plane, times the length of the normal
bool isBeyondPlane(const Prepared& triangle, const Triangle& other, double enough, double doubt) {
  const Vector normal = triangle.edges[0].cross(triangle.edges[1]);
  const auto height = [&](std::size_t i) { return normal.dot(other[i] - triangle.corners[0]); };
  const double heights[] = {height(0), height(1), height(2)};  // times the length of the normal
  const double low = std::min({heights[0], heights[1], heights[2]}),
               high = std::max({heights[0], heights[1], heights[2]}), apart = std::max(low, -high) - doubt;
  return apart > 0.0 && apart * apart >= enough * enough * normal.squaredNorm();
}

/// The nearest points that were found so far.
struct Best {
  double squared = kInfinity;
  Points points;

  void offer(const Vector& on_first, const Vector& on_second) {
    const double offered = (on_second - on_first).squaredNorm();
    if (!(offered < squared)) return;
    squared = offered;
    points = {on_first, on_second};
  }
};

/// Tries all edges with all edges. @returns true if the result is proved: these are the nearest points, or the distance
/// is at least `enough`; then `best` may be infinite
bool tryEdges(const Prepared& a, const Prepared& b, double enough, double doubt, Best& best) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Points nearest = nearestOfSegments(a.corners[i], a.edges[i], b.corners[j], b.edges[j]);
      best.offer(nearest.on_first, nearest.on_second);
      // Both edges lie beyond the planes through the nearest points. So only the third corners can be between them.
      const Vector between = nearest.on_second - nearest.on_first;
      const double squared = between.squaredNorm(),
                   of_a = std::max(0.0, between.dot(a.corners[(i + 2) % 3] - nearest.on_first) + doubt),
                   of_b = std::max(0.0, between.dot(nearest.on_second - b.corners[(j + 2) % 3]) + doubt),
                   apart = squared - of_a - of_b;
      if (apart > 0.0 && apart * apart >= enough * enough * squared) {
        best.squared = kInfinity;
        return true;
      }
      if (of_a == 0.0 && of_b == 0.0) return true;
    }
  }
  return false;
}

/// Tries the corners and edges of `other` with the inside of a triangle.
/// @param offer  receives a point of the triangle and a point of `other`
template <class Offer>
void tryInside(const Prepared& triangle, const Prepared& other, const Best& best, const Offer& offer) {
  const Vector normal = triangle.edges[0].cross(triangle.edges[1]);
  const double squared = normal.squaredNorm();
  std::array<double, 3> heights;  // times the length of the normal
  for (std::size_t i = 0; i < 3; ++i) heights[i] = normal.dot(other.corners[i] - triangle.corners[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const double height = heights[i], next = heights[(i + 1) % 3];
    if (height * height < best.squared * squared) {
      if (const auto point = projected(triangle, other.corners[i])) offer(*point, other.corners[i]);
    }
    if (height * next < 0.0) {  // the edge passes through the plane
      const Vector through = other.corners[i] + height / (height - next) * other.edges[i];
      if (const auto point = projected(triangle, through)) offer(*point, through);
    }
  }
}

/// Returns the width of the space between two triangles along a unit vector [m]; negative if they overlap there.
double thicknessBetween(const Triangle& first, const Triangle& second, const Vector& along) {
  const auto height = [&](const Triangle& triangle, std::size_t i) { return along.dot(triangle[i]); };
  return std::min({height(second, 0), height(second, 1), height(second, 2)}) -
         std::max({height(first, 0), height(first, 1), height(first, 2)});
}

}  // namespace

CoreGap gapOfTriangles(const Triangle& first, const Triangle& second, double size, const GapLimits& limits) {
  const Prepared a(first), b(second);
  const double rounding = kTriangleRounding * size;
  CoreGap gap;
  gap.lower = gap.upper = kInfinity;
  const double of_heights = rounding * size * size;
  if (isBeyondPlane(a, second, limits.enough, of_heights) || isBeyondPlane(b, first, limits.enough, of_heights)) {
    return gap;
  }
  Best best;
  const bool is_proved = tryEdges(a, b, limits.enough, rounding * size, best);
  if (!is_proved) {
    tryInside(a, b, best, [&](const Vector& on_a, const Vector& on_b) { best.offer(on_a, on_b); });
    tryInside(b, a, best, [&](const Vector& on_b, const Vector& on_a) { best.offer(on_a, on_b); });
  }
  gap.upper = std::sqrt(best.squared);
  if (!(gap.upper < kInfinity)) return gap;
  gap.on_first = best.points.on_first;
  gap.on_second = best.points.on_second;
  gap.lower = std::max(0.0, gap.upper - rounding);
  if (gap.upper > 0.0) gap.normal = gap.apart_along = (gap.on_second - gap.on_first) / gap.upper;
  if (gap.upper <= rounding) return gap;  // they cross or touch
  const bool is_clear = gap.lower > limits.touch || gap.upper <= limits.touch;
  if (is_clear && (is_proved || thicknessBetween(first, second, gap.normal) >= gap.upper - rounding)) return gap;
  return gapOf(ConvexCore::hull(first.data(), 3), ConvexCore::hull(second.data(), 3), Pose::Identity(), limits);
}

}  // namespace hgrid
