// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/sphere_cover.h"

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {
namespace {

constexpr double kMostAlong = 8.0;      // spheres along the longest axis
constexpr double kMostSpheres = 12.0;   // spheres in all, roughly
constexpr double kLeastSpacing = 1e-6;  // [m] of spheres, for a box without size
constexpr double kNoRow = 1e-3;         // a rest of a row that is shorter than this share of a sphere gets no sphere
constexpr double kCoverGrown = 1.0 + 1e-6;  // makes up for the rounding of the radius

}  // namespace

SphereCover coverOf(const TiltedBox<float>& box) {
  std::uint32_t order[] = {0, 1, 2};
  std::sort(order, order + 3, [&](std::uint32_t a, std::uint32_t b) { return box.half[a] > box.half[b]; });
  const double longest = box.half[order[0]], middle = box.half[order[1]], shortest = box.half[order[2]];
  SphereCover cover{{order[0], order[1]}, {1, 1}, {0.0f, 0.0f}, box.half[order[0]], box.half[order[0]]};
  if (box.is_ball) return cover;
  cover.whole = roundedUp(std::sqrt(longest * longest + middle * middle + shortest * shortest));
  const double spacing =
      std::max({shortest, longest / kMostAlong, std::sqrt(longest * middle / kMostSpheres), kLeastSpacing});
  double half[2] = {longest, middle};
  for (int i = 0; i < 2; ++i) {
    cover.count[i] = static_cast<std::uint32_t>(std::ceil(half[i] / spacing - kNoRow));
    cover.count[i] = std::max(cover.count[i], 1u);
    half[i] /= cover.count[i];
    cover.step[i] = static_cast<float>(2.0 * half[i]);
  }
  cover.radius = roundedUp(std::sqrt(half[0] * half[0] + half[1] * half[1] + shortest * shortest) * kCoverGrown);
  return cover;
}

}  // namespace hgrid
