// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/distance_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hgrid {
namespace test {
namespace {

const Real kRounding = 100 * std::numeric_limits<Real>::epsilon();  // of one step, relative to the lengths

/// The difference of two points, one from each core.
struct Difference {
  Vector3r v, on_first, on_second;
};

/// Up to four differences, the newest first. The weights of the corners give the point nearest to the origin.
struct Simplex {
  std::array<Difference, 4> corners;
  std::array<Real, 4> weights{};
  int size = 0;

  Vector3r mixed(Vector3r Difference::*part) const {
    Vector3r sum = Vector3r::Zero();
    for (int i = 0; i < size; ++i) sum += weights[i] * (corners[i].*part);
    return sum;
  }
};

/// Computes the weights of the point nearest to the origin in the plane (or line) through the corners. Uses orthogonal
/// steps from the first corner, because squared lengths of nearly parallel sides would lose half of the digits.
/// @returns whether the nearest point lies between the corners
bool nearestBetween(Simplex& simplex) {
  const int sides = simplex.size - 1;
  Vector3r across[3], rest = simplex.corners[0].v;
  Real mixed[3][3], share[3], weight[3];
  for (int i = 0; i < sides; ++i) {
    const Vector3r side = simplex.corners[i + 1].v - simplex.corners[0].v;
    across[i] = side;
    for (int k = 0; k < i; ++k) {
      mixed[k][i] = across[k].dot(across[i]) / across[k].squaredNorm();
      across[i] -= mixed[k][i] * across[k];
    }
    if (across[i].squaredNorm() <= kRounding * kRounding * side.squaredNorm()) {
      return false;  // flat; a face of the simplex is enough
    }
    share[i] = -across[i].dot(rest) / across[i].squaredNorm();
    rest += share[i] * across[i];
  }
  simplex.weights[0] = 1;
  for (int i = sides; i-- > 0;) {
    weight[i] = share[i];
    for (int k = i + 1; k < sides; ++k) weight[i] -= mixed[i][k] * weight[k];
    simplex.weights[i + 1] = weight[i];
    simplex.weights[0] -= weight[i];
  }
  for (int i = 0; i < simplex.size; ++i) {
    if (!(simplex.weights[i] >= 0)) return false;
  }
  return true;
}

/// Returns the face of the simplex that contains its point nearest to the origin. The result can be the simplex itself.
/// Tries only faces that have the newest corner.
Simplex nearestFace(const Simplex& simplex) {
  Simplex best;
  Real shortest = std::numeric_limits<Real>::infinity();
  for (int others = 0; others < 1 << (simplex.size - 1); ++others) {
    Simplex face;
    face.corners[face.size++] = simplex.corners[0];
    for (int i = 1; i < simplex.size; ++i) {
      if (others >> (i - 1) & 1) face.corners[face.size++] = simplex.corners[i];
    }
    if (!nearestBetween(face)) continue;
    const Real length = face.mixed(&Difference::v).squaredNorm();
    if (length >= shortest) continue;
    shortest = length;
    best = face;
  }
  return best;
}

}  // namespace

CoreDistance coreDistance(const Convex& first, const Convex& second, Real tolerance, Real enough) {
  const auto farthestAgainst = [&](const Vector3r& v) {
    const Vector3r a = first.support(-v), b = second.support(v);
    return Difference{a - b, a, b};
  };
  CoreDistance result;
  Simplex simplex;
  simplex.corners[0] = farthestAgainst(first.center() - second.center());
  simplex.weights[0] = 1;
  simplex.size = 1;
  result.upper = std::numeric_limits<Real>::infinity();
  for (int step = 0; step < 500; ++step) {
    const Vector3r v = simplex.mixed(&Difference::v);
    const Real length = v.norm();
    if (length >= result.upper) break;  // the precision allows no further progress
    result.upper = length;
    result.on_first = simplex.mixed(&Difference::on_first);
    result.on_second = simplex.mixed(&Difference::on_second);
    if (length <= kRounding * (1 + first.reach() + second.reach())) {
      result.lower = 0;
      break;
    }
    const Difference next = farthestAgainst(v);
    result.lower = std::max(result.lower, next.v.dot(v) / length);
    if (result.upper - result.lower <= tolerance || result.lower > enough || simplex.size == 4) break;
    for (int i = simplex.size; i > 0; --i) simplex.corners[i] = simplex.corners[i - 1];
    simplex.corners[0] = next;
    ++simplex.size;
    simplex = nearestFace(simplex);
  }
  return result;
}

Interval distanceOf(const Convex& first, const Convex& second) {
  const CoreDistance core = coreDistance(first, second);
  const Real radii = first.radius() + second.radius();
  return {double(std::max<Real>(0, core.lower - radii)), double(std::max<Real>(0, core.upper - radii))};
}

}  // namespace test
}  // namespace hgrid
