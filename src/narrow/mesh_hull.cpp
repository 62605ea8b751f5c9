// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/mesh_hull.h"

#include <algorithm>

#include "narrow/gjk.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

// The search ends after so many directions. Hulls that none of them separates usually overlap.
constexpr int kMostDirections = 3;
// The search also ends if two hulls overlap along a direction by more than this part of the radius of the smaller one.
constexpr double kDeep = 0.8;
// [half of the diagonal of the box around the points] A point that is outside the hull of the corners found so far by
// less than this is not a corner.
constexpr double kInside = 1e-7;
// [radius] Bound of the errors of a hull: kInside, where half of the diagonal is at most 1.8 times the radius, and at
// most eight roundings to float of a coordinate along a direction.
constexpr double kCornerRounding = 1e-6;
// [center_size_ of both hulls + length of the way] Bound of the rounding errors of the way between the centers.
constexpr double kWayRounding = 1e-12;

// Makes up for the rounding of coordinates along directions to float.
constexpr double kRaised = 1.0 + 1e-6;

bool isLess(const Vector& a, const Vector& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Returns the points that are not in the convex hull of the others (Clarkson 1994, "More output-sensitive geometric
/// algorithms").
/// @param rounding  [m] points that are outside by less than this may be missing
std::vector<Vector> cornersOf(const std::vector<Vector>& points, double rounding) {
  std::vector<Vector> corners;
  std::vector<bool> is_corner(points.size());
  const auto add = [&](std::size_t i) {
    corners.push_back(points[i]);
    is_corner[i] = true;
  };
  add(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    while (!is_corner[i]) {
      const CoreGap gap = gapOf(ConvexCore::hull(&points[i], 1), ConvexCore::hull(corners.data(), corners.size()),
                                Pose::Identity(), {rounding, rounding});
      if (gap.upper <= rounding) break;
      const Vector outward = gap.on_first - gap.on_second;
      std::size_t farthest = i;
      for (std::size_t k = 0; k < points.size(); ++k) {
        if (outward.dot(points[k] - points[farthest]) > 0.0) farthest = k;
      }
      add(is_corner[farthest] ? i : farthest);  // it can only be a known corner by rounding
    }
  }
  return corners;
}

/// Returns whether a child of a node is another node.
bool hasNodesBelow(const BoxNode& node) {
  return std::any_of(node.child, node.child + node.count, [](std::int32_t child) { return child >= 0; });
}

/// Adds the corners of all triangles below a node.
void addPoints(const BoxTree& tree, const std::vector<Triangle>& triangles, std::size_t number,
               std::vector<Vector>& points) {
  const BoxNode& node = tree.nodes[number];
  for (std::int32_t i = 0; i < node.count; ++i) {
    if (node.child[i] >= 0) {
      addPoints(tree, triangles, static_cast<std::size_t>(node.child[i]), points);
    } else {
      const Triangle& triangle = triangles[static_cast<std::size_t>(~node.child[i])];
      points.insert(points.end(), triangle.begin(), triangle.end());
    }
  }
}

}  // namespace

/// A direction in floats.
struct MeshHull::FloatDirection {
  explicit FloatDirection(const Vector& direction)
      : x(allFour(static_cast<float>(direction.x()))),
        y(allFour(static_cast<float>(direction.y()))),
        z(allFour(static_cast<float>(direction.z()))) {}
  /// Returns the coordinates of four corners along the direction.
  Four operator()(const Block& block) const { return block.x * x + block.y * y + block.z * z; }
  Four x, y, z;
};

MeshHull::MeshHull(std::vector<Vector> points) {
  std::sort(points.begin(), points.end(), isLess);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.empty() || points.size() > kMostPoints) return;
  Vector low = points.front(), high = points.front();
  for (const Vector& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  center_ = 0.5 * (low + high);
  center_size_ = center_.lpNorm<1>();
  const std::vector<Vector> corners = cornersOf(points, kInside * 0.5 * (high - low).norm());
  count_ = corners.size();
  blocks_.resize((count_ + 3) / 4);
  for (std::size_t i = 0; i < 4 * blocks_.size(); ++i) {
    const Vector corner = corners[std::min(i, count_ - 1)] - center_;
    Block& block = blocks_[i / 4];
    block.x[i % 4] = static_cast<float>(corner.x());
    block.y[i % 4] = static_cast<float>(corner.y());
    block.z[i % 4] = static_cast<float>(corner.z());
    radius_ = std::max(radius_, corner.norm());
  }
}

bool MeshHull::isApart(const MeshHull& other, const Pose& this_from_other, double reach) const {
  if (blocks_.empty() || other.blocks_.empty()) return false;
  const auto& turn = this_from_other.linear();
  const Vector way = this_from_other * other.center_ - center_;
  const double length = way.norm(), rounding = kCornerRounding * (radius_ + other.radius_) +
                                               kWayRounding * (center_size_ + other.center_size_ + length);
  const double least = (reach + rounding) * kRaised, deepest = kDeep * std::min(radius_, other.radius_);
  if (!(length > least)) return false;
  Vector direction = way / length;
  for (int step = 0; step < kMostDirections; ++step) {
    const Vector back = turn.transpose() * -direction;  // in the frame of the other hull
    const float own = mostAlong(direction), others = other.mostAlong(back);
    const double gap = direction.dot(way) - static_cast<double>(own) - static_cast<double>(others);
    if (gap > least) return true;
    if (gap < -deepest) return false;
    const Vector between = way + turn * other.cornerAt(back, others) - cornerAt(direction, own);
    const double squared = between.squaredNorm();
    if (!(squared > least * least)) return false;
    // Along the direction, the two corners overlap. Along its reflection at the plane perpendicular to `between`, they
    // are apart. So this is the next direction.
    direction -= (2.0 * direction.dot(between) / squared) * between;
  }
  return false;
}

/// Returns the largest coordinate of a corner along a direction, relative to center_ [m].
float MeshHull::mostAlong(const Vector& direction) const {
  const FloatDirection along(direction);
  // The processor can compute two maxima at the same time, but not two steps of one maximum.
  Four most = along(blocks_.back()), other_most = most;
  for (std::size_t i = 0; i + 1 < blocks_.size(); i += 2) {
    most = greatest(along(blocks_[i]), most);
    other_most = greatest(along(blocks_[i + 1]), other_most);
  }
  most = greatest(most, other_most);
  return std::max({most[0], most[1], most[2], most[3]});
}

/// Returns the corner with this coordinate along a direction, relative to center_ [m]. @param most  from mostAlong()
Vector MeshHull::cornerAt(const Vector& direction, float most) const {
  const FloatDirection along(direction);
  const auto reaches = [&](const Block& block) {
    return bitsOf(reinterpret_cast<FourCounts>(along(block) >= allFour(most)));
  };
  std::size_t number = 0;
  while (number + 1 < blocks_.size() && reaches(blocks_[number]) == 0) ++number;
  const Block& block = blocks_[number];
  const unsigned bits = reaches(block);
  std::size_t lane = 0;
  while (lane < 3 && (bits >> lane & 1u) == 0) ++lane;
  return {static_cast<double>(block.x[lane]), static_cast<double>(block.y[lane]), static_cast<double>(block.z[lane])};
}

std::vector<MeshHull> hullsOf(const BoxTree& tree, const std::vector<Triangle>& triangles) {
  std::vector<MeshHull> hulls;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    std::vector<Vector> points;
    const bool holds_root = i == 0;
    if (!holds_root && hasNodesBelow(tree.nodes[i])) addPoints(tree, triangles, i, points);
    hulls.emplace_back(std::move(points));
  }
  return hulls;
}

}  // namespace hgrid
