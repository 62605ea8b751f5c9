// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tools/mesh/polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace hgrid {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

// A polygon is flat if its corners deviate less than this from a plane, as a part of its length.
constexpr double kFlat = 1e-6;

/// Splits one polygon.
class Split {
 public:
  explicit Split(const std::vector<Eigen::Vector3d>& corners) : corners_(corners) {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(), extent = normal;  // of the triangles with the first corner
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector3d to_corner = corners[i] - corners[0];
      const Eigen::Vector3d part = to_corner.cross(corners[(i + 1) % corners.size()] - corners[0]);
      normal += part;
      extent += part.cwiseAbs();
      length_ = std::max(length_, to_corner.norm());
      ring_.push_back(i);
    }
    int axis = 0;
    extent.maxCoeff(&axis);
    const int x = (axis + (normal[axis] < 0 ? 2 : 1)) % 3, y = 3 - axis - x;
    for (const Eigen::Vector3d& corner : corners) flat_.emplace_back(corner[x], corner[y]);
  }

  /// Cuts one corner after another off the polygon in the plane, each with its two neighbors.
  ///
  /// Each cut removes a triangle. So the polygon winds around a point as often as the cut triangles together, those
  /// that turn right counted as -1. If its sides do not cross each other, no triangle turns right, and the triangles
  /// cover the polygon exactly once. Otherwise they cover at least each point around which it winds.
  void cutEars() {
    while (ring_.size() > 3) {
      if (!cutNext([this](std::size_t k) { return isEar(k); }) &&
          !cutNext([this](std::size_t k) { return turn(k) == 0; })) {
        cutThinnest();
      }
    }
    triangles_.push_back(at(1));
  }

  /// Replaces sides between two triangles by the other diagonal of the two, where that moves the surface outward.
  void bulge() {
    bool changed = true;
    for (std::size_t left = corners_.size(); changed && left > 0; --left) {  // rounding could repeat this forever
      changed = false;
      std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> sides;  // triangles by their sides
      for (std::size_t i = 0; i < triangles_.size(); ++i) {
        for (int k = 0; k < 3; ++k) sides[{triangles_[i][k], triangles_[i][(k + 1) % 3]}] = i;
      }
      std::vector<bool> is_new(triangles_.size(), false);  // triangles that `sides` does not describe any more
      for (std::size_t i = 0; i < triangles_.size(); ++i) {
        for (int k = 0; k < 3 && !is_new[i]; ++k) {
          const auto other = sides.find({triangles_[i][(k + 1) % 3], triangles_[i][k]});
          if (other == sides.end() || is_new[other->second]) continue;
          if (flip(triangles_[i], k, triangles_[other->second])) is_new[i] = is_new[other->second] = changed = true;
        }
      }
    }
  }

  /// Whether all corners lie in a plane.
  bool isFlat() const {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (const Triangle& t : triangles_) {
      normal += (corners_[t[1]] - corners_[t[0]]).cross(corners_[t[2]] - corners_[t[0]]);
    }
    normal.normalize();
    return std::all_of(corners_.begin(), corners_.end(), [&](const Eigen::Vector3d& corner) {
      return std::abs(normal.dot(corner - corners_[0])) <= kFlat * length_;
    });
  }

  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  /// Returns the corner with number `k` of the rest of the polygon, between its neighbors.
  Triangle at(std::size_t k) const {
    const std::size_t size = ring_.size();
    return {ring_[(k + size - 1) % size], ring_[k], ring_[(k + 1) % size]};
  }

  /// Whether a, b, c turn left (1), right (-1) or not (0). The differences of coordinates that were floats are exact.
  /// So the result is never the wrong direction, because the rounding of the products keeps their order.
  int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Eigen::Vector2d p = flat_[b] - flat_[a], q = flat_[c] - flat_[a];
    const double left = p.x() * q.y(), right = p.y() * q.x();
    return left > right ? 1 : left < right ? -1 : 0;
  }
  int turn(std::size_t k) const {
    const Triangle t = at(k);
    return turn(t[0], t[1], t[2]);
  }

  /// Whether the corner turns left, and no other place of a corner lies in the triangle with its neighbors. A polygon
  /// whose sides do not cross each other has such a corner, or one that does not turn.
  bool isEar(std::size_t k) const {
    if (turn(k) <= 0) return false;
    const Triangle t = at(k);
    return std::all_of(ring_.begin(), ring_.end(), [&](std::uint32_t other) {
      for (int i = 0; i < 3; ++i) {
        if (flat_[other] == flat_[t[i]] || turn(t[i], t[(i + 1) % 3], other) < 0) return true;
      }
      return false;
    });
  }

  /// Cuts the first corner that `may` be cut, from the one after the corner that was cut last.
  template <class May>
  bool cutNext(const May& may) {
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      const std::size_t k = (next_ + i) % ring_.size();
      if (!may(k)) continue;
      cut(k);
      return true;
    }
    return false;
  }

  void cut(std::size_t k) {
    triangles_.push_back(at(k));
    ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(k));
    next_ = k + 1;
  }

  /// Cuts the corner whose triangle is the thinnest.
  void cutThinnest() {
    std::size_t thinnest = 0;
    for (std::size_t k = 1; k < ring_.size(); ++k) {
      if (width(at(k)) < width(at(thinnest))) thinnest = k;
    }
    cut(thinnest);
  }

  /// Returns the least height of a triangle in the plane.
  double width(const Triangle& t) const {
    const Eigen::Vector2d p = flat_[t[1]] - flat_[t[0]], q = flat_[t[2]] - flat_[t[0]];
    return std::abs(p.x() * q.y() - p.y() * q.x()) / std::max({p.norm(), q.norm(), (p - q).norm()});
  }

  /// Replaces side `k` of a triangle by the other diagonal of the quad that it forms with its neighbor, if the quad is
  /// convex in the plane and the other diagonal is farther outward. @returns whether it did
  bool flip(Triangle& one, int k, Triangle& other) const {
    const std::uint32_t a = one[(k + 1) % 3], b = one[(k + 2) % 3], c = one[k];
    const std::uint32_t d = other[0] != a && other[0] != c   ? other[0]
                            : other[1] != a && other[1] != c ? other[1]
                                                             : other[2];
    if (turn(a, b, c) <= 0 || turn(a, c, d) <= 0 || turn(b, c, d) <= 0 || turn(d, a, b) <= 0) return false;
    const Eigen::Vector3d normal = (corners_[b] - corners_[a]).cross(corners_[c] - corners_[a]);
    if (!(normal.dot(corners_[d] - corners_[a]) > kFlat * length_ * normal.norm())) return false;
    one = {b, d, a}, other = {b, c, d};
    return true;
  }

  const std::vector<Eigen::Vector3d>& corners_;
  std::vector<Eigen::Vector2d> flat_;  // projections of the corners, in an order that turns left
  double length_ = 0.0;                // largest distance from the first corner
  std::vector<std::uint32_t> ring_;    // numbers of the corners that were not cut yet
  std::size_t next_ = 0;               // number in ring_ where the search for an ear begins
  std::vector<Triangle> triangles_;
};

}  // namespace

std::vector<Triangle> splitPolygon(const std::vector<Eigen::Vector3f>& corners) {
  std::vector<Eigen::Vector3d> places;
  for (const Eigen::Vector3f& corner : corners) places.push_back(corner.cast<double>());
  Split split(places);
  split.cutEars();
  if (!split.isFlat()) split.bulge();
  return split.triangles();
}

}  // namespace hgrid
