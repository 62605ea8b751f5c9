// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/overlap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "geometry/infinity.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kAccepted = 1e-10;      // [m] accepted difference between the bounds of the depth
constexpr double kFlat = 1e-13;          // relative to the sizes of the cores: a thinner difference of cores is flat
constexpr double kSideRounding = 1e-12;  // relative to the same: rounding errors of the sides of a face
constexpr double kSeen = 1e-15;          // relative to the same: a corner this far above a face is above it
constexpr std::size_t kMostFaces = 2 * kMostOverlapCorners;  // of a polytope with so many corners

/// A face of the polytope. Its corners are counterclockwise, seen from outside.
struct OverlapFace {
  std::array<std::uint16_t, 3> corner{};
  Vector normal = Vector::Zero();  // unit vector that points outward
  double height = 0.0;             // [m] along the normal, the lowest corner is this far from zero
};

/// A polytope inside the difference of two cores. It grows where zero is nearest to its surface, until its surface is
/// there the surface of the difference.
///
/// In each direction, the cores overlap by the extent of their difference. So each direction that is tried gives an
/// upper bound of the depth. The distance of zero from the surface of the polytope is a lower bound.
class Polytope {
 public:
  Polytope(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second)
      : first_(first),
        second_(second),
        first_from_second_(first_from_second),
        size_(first.reach() + second.reach() + first_from_second.translation().norm()) {}

  Overlap grow() {
    const double rounding = gapRounding(size_), accepted = std::max(kAccepted, 2.0 * rounding) - 2.0 * rounding;
    double lower = kInfinity;
    for (bool grows = begin(); grows;) {
      const std::size_t lowest = lowestFace();
      lower = faces_[lowest].height;
      grows = best_.depth - lower > accepted && add(support(faces_[lowest].normal), lowest);
    }
    if (best_.depth - lower > accepted) tryNeighbors();
    best_.depth = std::max(0.0, best_.depth);
    best_.at_least = std::clamp(lower - rounding, 0.0, best_.depth);
    best_.depth += rounding;
    return best_;
  }

 private:
  /// Tries directions around the best one, nearer and nearer. Along the rim of a cone or a cylinder, thin faces of the
  /// polytope have bad directions, so the upper bound may be far above the lower one.
  void tryNeighbors() {
    constexpr double kFirstStep = 0.1, kLastStep = 1e-9;  // [rad]
    double x = 1.0, y = 0.0;                              // of a unit vector that turns by the angle of 3, 4, 5
    for (double step = kFirstStep; step > kLastStep;) {
      const double before = best_.depth;
      const Vector middle = best_.normal, side = middle.unitOrthogonal(), other = middle.cross(side);
      for (int i = 0; i < 7; ++i) {  // about once around, and never twice the same
        support((middle + step * (x * side + y * other)).normalized());
        const double turned = 0.6 * x - 0.8 * y;
        y = 0.8 * x + 0.6 * y;
        x = turned;
      }
      if (!(best_.depth < before)) step *= 0.5;
    }
  }

  /// Returns the point of the difference that is farthest in a direction. Uses it for the upper bound.
  /// @param direction  unit vector
  Vector support(const Vector& direction) {
    const Vector on_first = first_.support(direction);
    const Vector back = first_from_second_.linear().transpose() * -direction;
    const Vector point = on_first - first_from_second_ * second_.support(back);
    const double depth = direction.dot(point);
    if (depth < best_.depth) {
      best_.depth = depth;
      best_.normal = direction;
    }
    return point;
  }

  /// Returns the extreme point along a line that is farther from the first corner.
  Vector farther(const Vector& direction) {
    const Vector ahead = support(direction), behind = support(-direction);
    return direction.dot(ahead - corners_[0]) >= direction.dot(corners_[0] - behind) ? ahead : behind;
  }

  /// Adds the extreme point along one of some lines that is farthest from the first corner.
  /// @returns its distance along the line [m]
  double addFarthest(std::initializer_list<Vector> directions) {
    double farthest = -1.0;
    for (const Vector& direction : directions) {
      const Vector point = farther(direction);
      const double distance = std::abs(direction.dot(point - corners_[0]));
      if (!(distance > farthest)) continue;
      farthest = distance;
      corners_[count_] = point;
    }
    ++count_;
    return farthest;
  }

  /// Makes the first tetrahedron. Returns false if the difference of the cores is flat; then the upper bound is right.
  bool begin() {
    const double least = kFlat * size_;
    corners_[count_++] = support(Vector::UnitX());
    if (!(addFarthest({Vector::UnitX(), Vector::UnitY(), Vector::UnitZ()}) > least)) return false;
    const Vector along = (corners_[1] - corners_[0]).normalized(), side = along.unitOrthogonal();
    if (!(addFarthest({side, along.cross(side)}) > least)) return false;
    const Vector normal = along.cross(corners_[2] - corners_[0]).normalized();
    if (!(addFarthest({normal}) > least)) return false;
    // The fourth corner must be below the first three, seen from where they are counterclockwise.
    if (normal.dot(corners_[3] - corners_[0]) > 0.0) std::swap(corners_[1], corners_[2]);
    for (const auto& face : {std::array<std::uint16_t, 3>{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}) addFace(face);
    return true;
  }

  std::size_t lowestFace() const {
    const auto lowest =
        std::min_element(faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(face_count_),
                         [](const OverlapFace& a, const OverlapFace& b) { return a.height < b.height; });
    return static_cast<std::size_t>(lowest - faces_.begin());
  }

  void addFace(const std::array<std::uint16_t, 3>& corner) {
    OverlapFace& face = faces_[face_count_++];
    face.corner = corner;
    const Vector &a = corners_[corner[0]], &b = corners_[corner[1]], &c = corners_[corner[2]];
    // The normal of a face that is almost a line is rounding noise. The direction of its middle serves as well: along
    // any direction, no point of the face is nearer to zero than its lowest corner.
    const Vector across = (b - a).cross(c - a);
    const bool is_line = !(across.norm() > kSideRounding * size_ * ((b - a).norm() + (c - a).norm()));
    face.normal = (is_line ? Vector(a + b + c) : across).normalized();
    face.height = std::min({face.normal.dot(a), face.normal.dot(b), face.normal.dot(c)});
  }

  struct Edge {
    std::uint16_t from, to;
  };
  using Edges = std::array<Edge, 3 * kMostFaces>;

  /// Sorts edges of a hole into a loop. Returns false if they are not one loop.
  static bool isLoop(Edges& edges, std::size_t count) {
    for (std::size_t i = 0; i + 1 < count; ++i) {
      std::size_t next = i + 1;
      while (next < count && edges[next].from != edges[i].to) ++next;
      if (next == count) return false;
      std::swap(edges[i + 1], edges[next]);
    }
    return count >= 3 && edges[count - 1].to == edges[0].from;
  }

  /// Replaces a face, and the faces around it that the corner sees, by faces that end in the corner. Returns false, and
  /// changes nothing, if the corner is not above the face, or if there is no room, or if rounding makes a hole that is
  /// not one loop.
  bool add(const Vector& corner, std::size_t face) {
    if (count_ == corners_.size()) return false;
    const double least = kSeen * size_;
    if (!(heightAbove(faces_[face], corner) > least)) return false;
    // A face in whose plane the corner lies is replaced as well. It would remain below a face that points inward.
    std::swap(faces_[face], faces_[face_count_ - 1]);
    return replace(corner, -least) || replace(corner, least);
  }

  double heightAbove(const OverlapFace& face, const Vector& corner) const {
    return face.normal.dot(corner - corners_[face.corner[0]]);
  }

  static bool haveCommonEdge(const OverlapFace& a, const OverlapFace& b) {
    int common = 0;
    for (const std::uint16_t corner : a.corner) common += std::count(b.corner.begin(), b.corner.end(), corner) != 0;
    return common >= 2;
  }

  /// Moves the last face, and those connected with it that the corner is above by more than `least` [m], to the end of
  /// the list. Rounding can make other faces seem to be below the corner; these stay. @returns the number of moved
  /// faces
  std::size_t gatherSeen(const Vector& corner, double least) {
    const auto last = faces_.begin() + static_cast<std::ptrdiff_t>(face_count_ - 1), end = last + 1;
    const auto below = std::partition(faces_.begin(), last,
                                      [&](const OverlapFace& face) { return !(heightAbove(face, corner) > least); });
    auto seen = last;  // the faces from here on are connected
    for (auto from = end; from != seen;) {
      --from;
      seen = std::partition(below, seen, [&](const OverlapFace& face) { return !haveCommonEdge(face, *from); });
    }
    return static_cast<std::size_t>(end - seen);
  }

  /// Replaces the faces that gatherSeen() finds.
  bool replace(const Vector& corner, double least) {
    Edges edges, hole;  // of the seen faces, and those edges of them that belong to no other seen face
    const std::size_t kept = face_count_ - gatherSeen(corner, least);
    std::size_t edge_count = 0, hole_count = 0;
    for (std::size_t i = kept; i < face_count_; ++i) {
      const auto& on_face = faces_[i].corner;
      for (std::size_t k = 0; k < 3; ++k) edges[edge_count++] = {on_face[k], on_face[(k + 1) % 3]};
    }
    const auto end = edges.begin() + static_cast<std::ptrdiff_t>(edge_count);
    for (auto edge = edges.begin(); edge != end; ++edge) {
      const auto isOpposite = [edge](const Edge& other) { return other.from == edge->to && other.to == edge->from; };
      if (std::none_of(edges.begin(), end, isOpposite)) hole[hole_count++] = *edge;
    }
    if (kept + hole_count > faces_.size() || !isLoop(hole, hole_count)) return false;
    face_count_ = kept;
    corners_[count_] = corner;
    for (std::size_t i = 0; i < hole_count; ++i) {
      addFace({hole[i].from, hole[i].to, static_cast<std::uint16_t>(count_)});
    }
    ++count_;
    return true;
  }

  const ConvexCore &first_, &second_;
  const Pose& first_from_second_;
  const double size_;  // [m]
  std::array<Vector, kMostOverlapCorners> corners_;
  std::array<OverlapFace, kMostFaces> faces_;
  std::size_t count_ = 0, face_count_ = 0;
  Overlap best_;
};

}  // namespace

Overlap overlapOf(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second) {
  return Polytope(first, second, first_from_second).grow();
}

}  // namespace hgrid
