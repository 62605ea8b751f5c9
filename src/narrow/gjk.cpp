// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/gjk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "geometry/double_double.h"

namespace hgrid {
namespace {

template <class Real>
using VectorOf = Eigen::Matrix<Real, 3, 1>;
using Vector = VectorOf<double>;

constexpr int kMostSteps = 300;          // largest number of iterations; a few dozen are usual
constexpr double kTolerance = 1e-10;     // [m] accepted difference between the bounds of the distance
constexpr double kStraight = 5e-13;      // the same, relative to the distance: the normal, which is off by at most the
                                         // square root of twice this, is then accurate to 1e-6 rad
constexpr double kStepRounding = 2e-15;  // relative to the sizes of the cores: the rounding errors of one step

constexpr double kNoise = 5e-16;         // relative to the sizes of the cores: error of the difference of two bounds
constexpr double kFinest = 1e-16;        // relative to the sizes of the cores: accepted difference with more digits
constexpr double kLeastSquare = 1e-200;  // squares of lengths that are smaller lose digits: they count as 0

/// The precision of a search.
template <class Real>
struct Precision;
template <>
struct Precision<double> {
  static constexpr double kFlat = 1e-28;  // squared sine of an angle; directions with a smaller angle count as parallel
  static constexpr double kNothing = 1e-15;  // relative to the sizes of the cores; smaller distances count as 0
};
template <>
struct Precision<DoubleDouble> {
  static constexpr double kFlat = 1e-58;
  static constexpr double kNothing = 1e-30;
};

/// One vertex of the simplex: the difference of a point of the first core and a point of the second core.
template <class Real>
struct Vertex {
  VectorOf<Real> difference = VectorOf<Real>::Zero(), on_first = VectorOf<Real>::Zero(),
                 on_second = VectorOf<Real>::Zero();
};

/// A face of a simplex, given by some of its vertices, and the weights of one point of the face.
template <class Real>
struct Face {
  std::array<int, 4> corners{};
  std::array<Real, 4> weights{};
  int size = 0;
};

/// A simplex of up to four differences, and its face with the point nearest to zero.
template <class Real>
class Simplex {
 public:
  using Corner = Vertex<Real>;
  using Part = VectorOf<Real> Corner::*;

  int size() const { return size_; }
  void add(const Corner& vertex) { vertices_[static_cast<std::size_t>(size_++)] = vertex; }

  VectorOf<Real> mix(Part part) const { return mix(nearest_, part); }

  /// Reduces the simplex to its face with the point nearest to zero, which may be the whole simplex. This face always
  /// has the newest vertex: a face without it has no point that is nearer than the previous nearest point.
  void reduce() {
    const int others = size_ - 1;
    Real shortest = std::numeric_limits<double>::infinity();
    Face<Real> best;
    for (int choice = 0; choice < 1 << others; ++choice) {
      Face<Real> face;
      face.corners[0] = others;
      face.size = 1;
      for (int i = 0; i < others; ++i) {
        if (choice >> i & 1) face.corners[static_cast<std::size_t>(face.size++)] = i;
      }
      if (!projectZero(face)) continue;
      const Real length = mix(face, &Corner::difference).squaredNorm();
      if (length < shortest) {
        shortest = length;
        best = face;
      }
    }
    std::array<Corner, 4> kept;
    for (int i = 0; i < best.size; ++i) kept[static_cast<std::size_t>(i)] = corner(best, i);
    vertices_ = kept;
    size_ = nearest_.size = best.size;
    nearest_.weights = best.weights;
    nearest_.corners = {0, 1, 2, 3};
  }

 private:
  const Corner& corner(const Face<Real>& face, int i) const {
    return vertices_[static_cast<std::size_t>(face.corners[static_cast<std::size_t>(i)])];
  }
  VectorOf<Real> mix(const Face<Real>& face, Part part) const {
    VectorOf<Real> sum = VectorOf<Real>::Zero();
    for (int i = 0; i < face.size; ++i) sum += face.weights[static_cast<std::size_t>(i)] * (corner(face, i).*part);
    return sum;
  }

  /// Computes the weights of the projection of zero on the line, plane or space through the corners of a face.
  ///
  /// It makes the sides orthogonal one after the other, since normal equations would square the error for thin faces.
  /// @returns whether the projection lies inside the face
  bool projectZero(Face<Real>& face) const {
    using Vector = VectorOf<Real>;
    std::array<Vector, 3> side{Vector::Zero(), Vector::Zero(), Vector::Zero()};
    std::array<std::array<Real, 3>, 3> along{};  // [k][i]: component of side i along the orthogonal side k
    std::array<Real, 3> step{};
    Vector rest = corner(face, 0).difference;
    const auto sides = static_cast<std::size_t>(face.size - 1);
    for (std::size_t i = 0; i < sides; ++i) {
      const Vector whole = corner(face, static_cast<int>(i) + 1).difference - corner(face, 0).difference;
      side[i] = whole;
      for (std::size_t k = 0; k < i; ++k) {
        along[k][i] = side[k].dot(side[i]) / side[k].squaredNorm();
        side[i] -= along[k][i] * side[k];
      }
      const Real squared = side[i].squaredNorm();
      if (!(squared > Real(Precision<Real>::kFlat) * whole.squaredNorm()))
        return false;  // a face with fewer corners gives the same point
      step[i] = -side[i].dot(rest) / squared;
      rest += step[i] * side[i];
    }
    Real first = 1.0;
    for (std::size_t i = sides; i-- > 0;) {
      for (std::size_t k = i + 1; k < sides; ++k) step[i] -= along[i][k] * step[k];
      if (!(step[i] >= Real(0.0))) return false;
      face.weights[i + 1] = step[i];
      first -= step[i];
    }
    face.weights[0] = first;
    return first >= Real(0.0);
  }

  std::array<Corner, 4> vertices_;
  Face<Real> nearest_;
  int size_ = 0;
};

/// The extreme differences of two placed cores.
template <class Real>
class Differences {
 public:
  Differences(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second)
      : first_(first),
        second_(second),
        rotation_(first_from_second.linear().template cast<Real>()),
        back_(rotation_.transpose()),
        shift_(first_from_second.translation().template cast<Real>()) {}

  /// Returns the extreme difference in direction -v.
  Vertex<Real> farthestAgainst(const VectorOf<Real>& v) const {
    Vertex<Real> vertex;
    vertex.on_first = first_.supportIn<Real>(-v);
    vertex.on_second = shift_ + rotation_ * second_.supportIn<Real>(back_ * v);
    vertex.difference = vertex.on_first - vertex.on_second;
    return vertex;
  }
  const VectorOf<Real>& shift() const { return shift_; }

 private:
  const ConvexCore &first_, &second_;
  const Eigen::Matrix<Real, 3, 3> rotation_, back_;
  const VectorOf<Real> shift_;
};

/// A search for the gap of two cores. Its bounds do not count rounding errors.
template <class Real>
struct GapSearch {
  Real lower = 0.0, upper = std::numeric_limits<double>::infinity();
  VectorOf<Real> on_first = VectorOf<Real>::Zero(), on_second = VectorOf<Real>::Zero();
  VectorOf<Real> shortest = VectorOf<Real>::Zero();  // from the second point to the first
  VectorOf<Real> against = VectorOf<Real>::Zero();   // the direction that proves `lower`
  std::array<VectorOf<Real>, 4> directions;          // the last directions whose extreme differences were computed
  std::size_t count = 0;                             // number of these directions, also of those that were overwritten

  /// Runs until isEnough(lower, upper) or until the bounds no longer improve.
  /// @param size  [m] sum of the reaches of the cores and of their distance
  template <class IsEnough>
  void run(const Differences<Real>& differences, Simplex<Real>& simplex, double size, const IsEnough& isEnough) {
    using std::sqrt;
    using Corner = Vertex<Real>;
    for (int step = 0; step < kMostSteps; ++step) {
      const VectorOf<Real> v = simplex.mix(&Corner::difference);
      const Real length = sqrt(v.squaredNorm());
      if (!(length < upper)) return;  // these numbers cannot give a smaller upper bound
      upper = length;
      shortest = v;
      on_first = simplex.mix(&Corner::on_first);
      on_second = simplex.mix(&Corner::on_second);
      if (length <= Real(Precision<Real>::kNothing * size)) {
        lower = 0.0;
        return;
      }
      directions[count++ % directions.size()] = v;
      const Corner next = differences.farthestAgainst(v);
      // `next` is the extreme difference in direction -v. No difference is nearer to zero than the plane through `next`
      // that is perpendicular to v.
      const Real proved = next.difference.dot(v) / length;
      if (proved > lower) {
        lower = proved;
        against = v;
      }
      if (isEnough(lower, upper) || simplex.size() == 4) return;
      simplex.add(next);
      simplex.reduce();
    }
  }

  /// Returns the result, with bounds that count rounding errors.
  /// @param rounding     [m] bound of these errors
  /// @param is_straight  whether the nearest points give the normal
  CoreGap gap(double rounding, bool is_straight) const {
    CoreGap result;
    result.upper = static_cast<double>(upper);
    result.lower = std::max(0.0, std::min(static_cast<double>(lower), result.upper) - rounding);
    result.on_first = on_first.template cast<double>();
    result.on_second = on_second.template cast<double>();
    if (result.lower > 0.0) {
      const Vector way = (-shortest / upper).template cast<double>();
      result.apart_along = against == shortest ? way : Vector(-against.template cast<double>().normalized());
      if (is_straight) result.normal = way;
    }
    return result;
  }
};

}  // namespace

ConvexCore ConvexCore::hull(const Eigen::Vector3d* points, std::size_t count) {
  ConvexCore core(Kind::hull, Eigen::Vector3d::Zero());
  core.points_ = points;
  core.count_ = count;
  for (std::size_t i = 0; i < count; ++i) core.reach_ = std::max(core.reach_, points[i].norm());
  return core;
}

template <class Real>
Eigen::Matrix<Real, 3, 1> ConvexCore::supportIn(const Eigen::Matrix<Real, 3, 1>& direction) const {
  using std::sqrt;
  const auto signedAs = [](double length, const Real& sign) { return sign < Real(0.0) ? Real(-length) : Real(length); };
  switch (kind_) {
    case Kind::box:
      return {signedAs(half_.x(), direction.x()), signedAs(half_.y(), direction.y()),
              signedAs(half_.z(), direction.z())};
    case Kind::cylinder:
    case Kind::cone: {
      const Real squared = direction.x() * direction.x() + direction.y() * direction.y();
      const bool is_along = !(squared > Real(kLeastSquare));  // then each point of the rim is as far, but for nothing
      const Real across = is_along ? Real(0.0) : sqrt(squared), radius = half_.x();
      const VectorOf<Real> rim(is_along ? radius : radius * direction.x() / across,
                               is_along ? Real(0.0) : radius * direction.y() / across, Real(-half_.z()));
      if (kind_ == Kind::cylinder) return {rim.x(), rim.y(), signedAs(half_.z(), direction.z())};
      if (direction.z() * Real(2.0 * half_.z()) > radius * across) return {Real(0.0), Real(0.0), Real(half_.z())};
      return rim;
    }
    case Kind::hull:
      break;
  }
  std::size_t best = 0;
  Real farthest = -std::numeric_limits<double>::infinity();
  // More digits are computed only of points that may be the farthest.
  const Vector rounded = direction.template cast<double>();
  const double doubt = std::is_same<Real, double>::value ? 0.0 : kStepRounding * reach_ * rounded.norm();
  double rounded_farthest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count_; ++i) {
    if (!std::is_same<Real, double>::value) {
      const double along = rounded.dot(points_[i]);
      if (along < rounded_farthest - doubt) continue;
      rounded_farthest = std::max(rounded_farthest, along);
    }
    const Real along = direction.dot(points_[i].template cast<Real>());
    if (along > farthest) {
      farthest = along;
      best = i;
    }
  }
  return points_[best].template cast<Real>();
}

template Vector ConvexCore::supportIn(const Vector& direction) const;

CoreGap gapOf(const ConvexCore& first, const ConvexCore& second, const Pose& first_from_second,
              const GapLimits& limits) {
  const double size = first.reach() + second.reach() + first_from_second.translation().norm();
  const bool are_boxes = first.isBox() && second.isBox();
  const double rounding = gapRounding(size), error = kStepRounding * size, noise = kNoise * size;
  const double accepted = std::max(kTolerance, 2.0 * rounding);
  const auto isStraight = [&](double lower, double upper) { return upper - lower <= kStraight * upper - noise; };
  // Whether the bounds are accurate, and say whether the gap is larger than `touch`.
  const auto isAccurate = [&](double lower, double upper) {
    const bool is_decided = lower - error > limits.touch || upper + error <= limits.touch;
    return upper <= error || (is_decided && upper - lower + 2.0 * error <= accepted);
  };
  const auto isSettled = [&](double lower, double upper) {
    if (lower - rounding > limits.enough || upper <= error) return true;
    if (!isAccurate(lower, upper)) return false;
    return isStraight(lower, upper) || !limits.needs_normal || (!are_boxes && upper <= limits.touch);
  };
  GapSearch<double> search;
  Simplex<double> simplex;
  const Differences<double> differences(first, second, first_from_second);
  simplex.add(differences.farthestAgainst(-differences.shift()));
  simplex.reduce();
  search.run(differences, simplex, size, isSettled);
  if (isSettled(search.lower, search.upper) || !(search.upper < std::numeric_limits<double>::infinity())) {
    return search.gap(rounding, isStraight(search.lower, search.upper));
  }
  GapSearch<DoubleDouble> finer;
  Simplex<DoubleDouble> finer_simplex;
  const Differences<DoubleDouble> exact(first, second, first_from_second);
  for (std::size_t i = search.count - std::min(search.count, std::size_t{3}); i < search.count; ++i) {
    const Vector& direction = search.directions[i % search.directions.size()];
    finer_simplex.add(exact.farthestAgainst(direction.cast<DoubleDouble>()));
    finer_simplex.reduce();
  }
  const auto isFinelyStraight = [&](const DoubleDouble& lower, const DoubleDouble& upper) {
    const double least = static_cast<double>(upper), width = static_cast<double>(upper - lower);
    // Rounding turns the direction by this, which moves a plane through the farthest point of a core.
    const double turned = Precision<DoubleDouble>::kNothing * size * (size / least);
    return least <= rounding || width <= std::max(kStraight * least, turned);
  };
  finer.run(exact, finer_simplex, size, [&](const DoubleDouble& lower, const DoubleDouble& upper) {
    if (static_cast<double>(lower) - rounding > limits.enough) return true;
    if (!(static_cast<double>(upper - lower) <= kFinest * size)) return false;
    return isFinelyStraight(lower, upper) || !limits.needs_normal;
  });
  return finer.gap(rounding, isFinelyStraight(finer.lower, finer.upper));
}

}  // namespace hgrid
