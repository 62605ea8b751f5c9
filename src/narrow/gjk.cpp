// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/gjk.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr int kMostSteps = 300;       // largest number of iterations; a few dozen are usual
constexpr double kTolerance = 1e-10;  // [m] accepted difference between the bounds of the distance
constexpr double kFlat = 1e-28;       // squared sine of an angle; directions with a smaller angle count as parallel
constexpr double kNothing = 1e-15;    // relative to the sizes of the cores; smaller distances count as 0

/// One vertex of the simplex: the difference of a point of the first core and a point of the second core.
struct Vertex {
  Vector difference = Vector::Zero(), on_first = Vector::Zero(), on_second = Vector::Zero();
};

/// A face of a simplex, given by some of its vertices, and the weights of one point of the face.
struct Face {
  std::array<int, 4> corners{};
  std::array<double, 4> weights{};
  int size = 0;
};

/// A simplex of up to four differences, and its face with the point nearest to zero.
class Simplex {
 public:
  int size() const { return size_; }
  void add(const Vertex& vertex) { vertices_[static_cast<std::size_t>(size_++)] = vertex; }

  Vector mix(Vector Vertex::*part) const { return mix(nearest_, part); }

  /// Reduces the simplex to its face with the point nearest to zero, which may be the whole simplex. This face always
  /// has the newest vertex: a face without it has no point that is nearer than the previous nearest point.
  void reduce() {
    const int others = size_ - 1;
    double shortest = std::numeric_limits<double>::infinity();
    Face best;
    for (int choice = 0; choice < 1 << others; ++choice) {
      Face face;
      face.corners[0] = others;
      face.size = 1;
      for (int i = 0; i < others; ++i) {
        if (choice >> i & 1) face.corners[static_cast<std::size_t>(face.size++)] = i;
      }
      if (!projectZero(face)) continue;
      const double length = mix(face, &Vertex::difference).squaredNorm();
      if (length < shortest) {
        shortest = length;
        best = face;
      }
    }
    std::array<Vertex, 4> kept;
    for (int i = 0; i < best.size; ++i) kept[static_cast<std::size_t>(i)] = corner(best, i);
    vertices_ = kept;
    size_ = nearest_.size = best.size;
    nearest_.weights = best.weights;
    nearest_.corners = {0, 1, 2, 3};
  }

 private:
  const Vertex& corner(const Face& face, int i) const {
    return vertices_[static_cast<std::size_t>(face.corners[static_cast<std::size_t>(i)])];
  }
  Vector mix(const Face& face, Vector Vertex::*part) const {
    Vector sum = Vector::Zero();
    for (int i = 0; i < face.size; ++i) sum += face.weights[static_cast<std::size_t>(i)] * (corner(face, i).*part);
    return sum;
  }

  /// Computes the weights of the projection of zero on the line, plane or space through the corners of a face.
  ///
  /// It makes the sides orthogonal one after the other, since normal equations would square the error for thin faces.
  /// @returns whether the projection lies inside the face
  bool projectZero(Face& face) const {
    std::array<Vector, 3> side{Vector::Zero(), Vector::Zero(), Vector::Zero()};
    std::array<std::array<double, 3>, 3> along{};  // [k][i]: component of side i along the orthogonal side k
    std::array<double, 3> step{};
    Vector rest = corner(face, 0).difference;
    const auto sides = static_cast<std::size_t>(face.size - 1);
    for (std::size_t i = 0; i < sides; ++i) {
      const Vector whole = corner(face, static_cast<int>(i) + 1).difference - corner(face, 0).difference;
      side[i] = whole;
      for (std::size_t k = 0; k < i; ++k) {
        along[k][i] = side[k].dot(side[i]) / side[k].squaredNorm();
        side[i] -= along[k][i] * side[k];
      }
      const double squared = side[i].squaredNorm();
      if (!(squared > kFlat * whole.squaredNorm())) return false;  // a face with fewer corners gives the same point
      step[i] = -side[i].dot(rest) / squared;
      rest += step[i] * side[i];
    }
    double first = 1.0;
    for (std::size_t i = sides; i-- > 0;) {
      for (std::size_t k = i + 1; k < sides; ++k) step[i] -= along[i][k] * step[k];
      if (!(step[i] >= 0.0)) return false;
      face.weights[i + 1] = step[i];
      first -= step[i];
    }
    face.weights[0] = first;
    return first >= 0.0;
  }

  std::array<Vertex, 4> vertices_;
  Face nearest_;
  int size_ = 0;
};

}  // namespace

ConvexCore ConvexCore::hull(const Eigen::Vector3d* points, std::size_t count) {
  ConvexCore core(Kind::hull, Eigen::Vector3d::Zero());
  core.points_ = points;
  core.count_ = count;
  for (std::size_t i = 0; i < count; ++i) core.reach_ = std::max(core.reach_, points[i].norm());
  return core;
}

Eigen::Vector3d ConvexCore::support(const Eigen::Vector3d& direction) const {
  switch (kind_) {
    case Kind::box:
      return {std::copysign(half_.x(), direction.x()), std::copysign(half_.y(), direction.y()),
              std::copysign(half_.z(), direction.z())};
    case Kind::cylinder:
    case Kind::cone: {
      const double across = std::hypot(direction.x(), direction.y());
      const Vector rim(across > 0.0 ? half_.x() * direction.x() / across : half_.x(),
                       across > 0.0 ? half_.x() * direction.y() / across : 0.0, -half_.z());
      if (kind_ == Kind::cylinder) return {rim.x(), rim.y(), std::copysign(half_.z(), direction.z())};
      return direction.z() * 2.0 * half_.z() > half_.x() * across ? Vector(0.0, 0.0, half_.z()) : rim;
    }
    case Kind::hull:
      break;
  }
  std::size_t best = 0;
  double farthest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i) {
    const double along = direction.dot(points_[i]);
    if (along > farthest) {
      farthest = along;
      best = i;
    }
  }
  return points_[best];
}

CoreGap gapOf(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second, double enough) {
  const Eigen::Matrix3d rotation = first_from_second.linear();
  const Vector shift = first_from_second.translation();
  const auto farthestAgainst = [&](const Vector& v) {
    Vertex vertex;
    vertex.on_first = first.support(-v);
    vertex.on_second = shift + rotation * second.support(rotation.transpose() * v);
    vertex.difference = vertex.on_first - vertex.on_second;
    return vertex;
  };
  const double size = first.reach() + second.reach() + shift.norm();
  const double tolerance = std::max(kTolerance, 1e-15 * size);
  CoreGap gap;
  Simplex simplex;
  simplex.add(farthestAgainst(-shift));
  simplex.reduce();
  for (int step = 0; step < kMostSteps; ++step) {
    const Vector v = simplex.mix(&Vertex::difference);
    const double length = v.norm();
    if (!(length < gap.upper)) break;  // doubles cannot give a smaller upper bound
    gap.upper = length;
    gap.on_first = simplex.mix(&Vertex::on_first);
    gap.on_second = simplex.mix(&Vertex::on_second);
    if (length <= kNothing * size) {
      gap.lower = 0.0;
      break;
    }
    const Vertex next = farthestAgainst(v);
    // `next` is the extreme difference in direction -v. No difference is nearer to zero than the plane through `next`
    // that is perpendicular to v.
    gap.lower = std::max(gap.lower, next.difference.dot(v) / length);
    if (gap.upper - gap.lower <= tolerance || gap.lower > enough || simplex.size() == 4) break;
    simplex.add(next);
    simplex.reduce();
  }
  return gap;
}

}  // namespace hgrid
