// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/geometry/voxel.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

using Real = long double;  // more precise than the code under test

/// Appends random voxels inside a cube. Each of its eight child cubes is left out, added as a whole, or divided
/// further.
inline void divide(const Voxel& cube, Random& random, double kept, double divided, int least,
                   std::vector<Voxel>& voxels) {
  for (unsigned child = 0; child < 8; ++child) {
    const auto level = static_cast<std::uint8_t>(cube.level - 1);
    const auto half = [&](std::uint16_t key, unsigned axis) {
      return static_cast<std::uint16_t>(key + ((child >> axis & 1u) << level));
    };
    const Voxel part{half(cube.x, 0), half(cube.y, 1), half(cube.z, 2), level};
    const double lot = random.uniform(0.0, 1.0);
    if (lot < kept || (lot < kept + divided && level == least)) {
      voxels.push_back(part);
    } else if (lot < kept + divided) {
      divide(part, random, kept, divided, least, voxels);
    }
  }
}

/// The voxels of a map.
struct Map {
  std::string name;
  double edge;  // [m] of a voxel of level 0
  std::vector<Voxel> voxels;
};

/// Returns the voxels in Morton order, each once.
inline std::vector<Voxel> inOrder(std::vector<Voxel> voxels) {
  std::sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

/// Returns voxels of level 0 at random keys from `low` to below `high` along each axis.
inline std::vector<Voxel> scattered(Random& random, std::size_t count, std::uint64_t low, std::uint64_t high) {
  std::vector<Voxel> voxels;
  const auto key = [&] {
    return static_cast<std::uint16_t>(low + static_cast<std::uint64_t>(random.below(static_cast<int>(high - low))));
  };
  for (std::size_t i = 0; i < count; ++i) voxels.push_back({key(), key(), key(), 0});
  return inOrder(std::move(voxels));
}

/// Returns maps of many kinds.
inline std::vector<Map> maps() {
  std::vector<Map> maps{{"empty", 0.1, {}},
                        {"one voxel is all", 0.05, {{0, 0, 0, 16}}},
                        {"half of all", 0.05, {{32768, 0, 0, 15}, {32768, 32768, 0, 15}}},
                        {"first and last", 0.001, {{0, 0, 0, 0}, {65535, 65535, 65535, 0}}}};
  Random random(3);
  maps.push_back({"near the origin", 0.05, scattered(random, 400, 32768 - 12, 32768 + 12)});
  maps.push_back({"dense", 0.3, scattered(random, 3000, 32768 - 8, 32768 + 8)});
  maps.push_back({"far apart", 100.0, scattered(random, 300, 0, 65536)});
  maps.push_back({"millimeters", 0.001, scattered(random, 300, 60000, 60200)});
  for (int i = 0; i < 6; ++i) {
    Map map{"divided " + std::to_string(i), i % 2 == 0 ? 0.05 : 0.1, {}};
    const auto level = static_cast<std::uint8_t>(4 + i);
    divide({static_cast<std::uint16_t>(32768), static_cast<std::uint16_t>(32768 - (1u << level)), 32768, level}, random,
           0.1, 0.35, i % 3, map.voxels);
    maps.push_back(map);
  }
  Map floor{"floor", 0.05, {}};
  for (std::uint16_t x = 0; x < 40; ++x) {
    for (std::uint16_t y = 0; y < 40; ++y) {
      floor.voxels.push_back(
          {static_cast<std::uint16_t>(32768 - 20 + x), static_cast<std::uint16_t>(32768 - 20 + y), 32767, 0});
    }
  }
  floor.voxels = inOrder(floor.voxels);
  maps.push_back(floor);
  return maps;
}

/// Returns the name of a map as a part of the name of a test.
inline std::string testName(const Map& map) {
  std::string name = map.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

/// Returns a random position in the map, on the border of a voxel, or far away.
inline Eigen::Vector3d somewhere(const Map& map, Random& random) {
  if (map.voxels.empty() || random.chance(0.05)) {
    return {random.uniform(-1e4, 1e4), random.uniform(-1e4, 1e4), random.uniform(-1e4, 1e4)};
  }
  const Voxel& voxel = map.voxels[static_cast<std::size_t>(random.below(static_cast<int>(map.voxels.size())))];
  const Eigen::Vector3d min = minCorner(voxel, map.edge), max = maxCorner(voxel, map.edge);
  if (random.chance(0.3)) return random.chance(0.5) ? min : max;  // on the border of a voxel
  const double around = std::ldexp(map.edge, random.below(6));
  Eigen::Vector3d point;
  for (int axis = 0; axis < 3; ++axis) point[axis] = random.uniform(min[axis] - around, max[axis] + around);
  return point;
}

/// Returns a random length [m], for example a radius; 0 in one of five calls.
inline double length(const Map& map, Random& random) {
  return random.chance(0.2) ? 0.0 : std::ldexp(map.edge, random.below(8)) * random.uniform(0.0, 1.0);
}

/// Returns the distance [m] of a voxel from a box.
inline Real distanceOf(const Map& map, const Voxel& voxel, const Eigen::AlignedBox3d& box) {
  Real sum = 0;
  const Eigen::Vector3d min = minCorner(voxel, map.edge), max = maxCorner(voxel, map.edge);
  for (int axis = 0; axis < 3; ++axis) {
    const Real gap =
        std::max({Real(0), Real(min[axis]) - Real(box.max()[axis]), Real(box.min()[axis]) - Real(max[axis])});
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

/// Returns a bound [m] of the rounding errors in a distance from the box.
/// @param around  [m] radius or limit of the query
inline double slack(const Eigen::AlignedBox3d& box, double around) {
  return 1e-9 * (box.min().cwiseAbs().maxCoeff() + box.max().cwiseAbs().maxCoeff() + around + 1.0);
}

}  // namespace test
}  // namespace hgrid
