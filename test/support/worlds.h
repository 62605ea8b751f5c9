// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "test/support/oracle.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// Kinds of random worlds. For each kind, there was a grid with a bug that only worlds of this kind revealed.
enum class Family {
  uniform,      ///< boxes of similar size in a hall
  clustered,    ///< boxes in three clusters
  lattice,      ///< corners of boxes are on cell borders, or one or two units in the last place beside them
  size_ratio,   ///< sizes of boxes over six powers of ten
  negative,     ///< all coordinates are negative, where truncation and floor differ
  far,          ///< a million meters away, where neighboring floats differ by 1/16 m
  empty,        ///< no two boxes touch, or there is at most one box
  same_place,   ///< all boxes are around the same point
  thin_plates,  ///< flat, long boxes that cross each other
  points,       ///< boxes of size 0, several of them at the same point
  around_zero,  ///< boxes that contain zero and extend little beyond it, down to denormal numbers
};
constexpr int kFamilies = 11;

inline const char* name(Family family) {
  static constexpr const char* kNames[] = {"uniform", "clustered",  "lattice",     "size_ratio", "negative",   "far",
                                           "empty",   "same_place", "thin_plates", "points",     "around_zero"};
  return kNames[static_cast<int>(family)];
}

inline Aabb boxAround(const Eigen::Vector3d& center, const Eigen::Vector3d& size) {
  Aabb box;
  for (int k = 0; k < 3; ++k) {
    box.min[k] = float(center[k] - 0.5 * size[k]);
    box.max[k] = std::max(box.min[k], float(center[k] + 0.5 * size[k]));
  }
  return box;
}

inline Eigen::Vector3d randomVector(Random& random, double low, double high) {
  const double x = random.uniform(low, high), y = random.uniform(low, high);  // separate calls, to fix their order
  return {x, y, random.uniform(low, high)};
}

/// Returns a rod, or sometimes a plate, along random axes.
inline Aabb thinBoxAround(const Eigen::Vector3d& center, Random& random) {
  Eigen::Vector3d size = randomVector(random, 0.05, 0.2);
  size[random.below(3)] = random.uniform(5.0, 15.0);
  if (random.chance(0.02)) size[random.below(3)] = random.uniform(1.0, 4.0);
  return boxAround(center, size);
}

inline Aabb latticeBox(Random& random, float cell) {
  Aabb box;
  for (int k = 0; k < 3; ++k) {
    const float low = cell * float(random.between(-4, 4)), high = low + cell * float(random.between(0, 2));
    box.min[k] = stepped(low, random.between(-2, 2));
    box.max[k] = std::max(box.min[k], stepped(high, random.between(-2, 2)));
  }
  return box;
}

/// Returns 2 to 500 random boxes of the family, more often few than many. Worlds of the family `empty` may have no box.
inline std::vector<Aabb> worldOf(Family family, unsigned seed) {
  Random random(seed);
  const double few = random.uniform(0, 1);
  int count = 2 + int(498 * few * few * few);
  if (family == Family::same_place) count = std::min(count, 60);
  if (family == Family::empty && random.chance(0.2)) count = random.below(2);
  const float cell = std::ldexp(1.f, random.between(-8, 8));
  const double crowd = std::cbrt(double(count));  // scales the room: even few boxes have neighbors
  const Eigen::Vector3d heap = randomVector(random, -1e3, 1e3), away(1e6, -1e6, 1e6);
  std::vector<Aabb> boxes;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center = randomVector(random, -0.3 * crowd, 0.3 * crowd),
                          size = randomVector(random, 0.05, 0.7);
    const auto log_size = [&] { return random.logUniform(1e-4, 1e2); };
    switch (family) {
      case Family::uniform:
        boxes.push_back(boxAround(center, size));
        break;
      case Family::clustered:
        boxes.push_back(boxAround((i % 3) * 40.0 * Eigen::Vector3d::Ones() + 0.3 * center, 0.6 * size));
        break;
      case Family::lattice:
        boxes.push_back(latticeBox(random, cell));
        break;
      case Family::size_ratio: {
        const double x = log_size(), y = log_size();
        boxes.push_back(boxAround(10.0 * center, {x, y, log_size()}));
        break;
      }
      case Family::negative:
        boxes.push_back(boxAround(center - Eigen::Vector3d::Constant(crowd), size));
        break;
      case Family::far:
        boxes.push_back(boxAround(away + center, size));
        break;
      case Family::empty: {
        const Eigen::Vector3d place(i % 8, (i / 8) % 8, i / 64);
        boxes.push_back(boxAround(2.0 * place, size));
        break;
      }
      case Family::same_place:
        boxes.push_back(boxAround(heap, i % 2 ? size : Eigen::Vector3d(0.5, 0.5, 0.5)));
        break;
      case Family::thin_plates: {
        Eigen::Vector3d plate = crowd * randomVector(random, 0.1, 0.5);
        plate[random.below(3)] = random.chance(0.5) ? 0.0 : 1e-4;
        boxes.push_back(boxAround(center, plate));
        break;
      }
      case Family::points: {
        Aabb point;
        for (int k = 0; k < 3; ++k) point.min[k] = point.max[k] = cell * float(random.between(-1, int(crowd) / 2));
        boxes.push_back(point);
        break;
      }
      case Family::around_zero: {
        Aabb box;
        for (int k = 0; k < 3; ++k) {
          box.min[k] = random.chance(0.2) ? -0.f : -float(random.logUniform(1e-44, 1.0));
          box.max[k] = random.chance(0.2) ? 0.f : float(random.logUniform(1e-44, 1.0));
          if (random.chance(0.3)) box.min[k] = box.max[k] = random.chance(0.5) ? box.min[k] : box.max[k];
        }
        boxes.push_back(box);
        break;
      }
    }
  }
  return boxes;
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Returns all pairs of boxes that have a point in common. Checks all pairs.
inline Pairs allOverlaps(const std::vector<Aabb>& boxes) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      if (oracleOverlap(boxes[i], boxes[j])) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

/// Returns cubes with edges of 1 m, whose centers follow each other in steps of 0.4 m on each axis.
inline std::vector<Aabb> diagonalOfBoxes(std::size_t count) {
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    boxes.push_back(boxAround(0.4 * double(i) * Eigen::Vector3d::Ones(), {1, 1, 1}));
  }
  return boxes;
}

}  // namespace test
}  // namespace hgrid
