// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/maps/building.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {
namespace {

using Cell = Eigen::Vector3i;

constexpr double kSeen = 0.97;   // fraction of the cells of a surface that are occupied
constexpr double kRough = 0.10;  // fraction of a surface that has a second layer

/// Moves bit 3 * i of the argument to bit i of the result. This is the inverse of spreadByThree().
int everyThird(std::uint64_t bits) {
  std::uint64_t key = bits & 0x249249249249;
  key = (key | key >> 2) & 0x0c30c30c30c3;
  key = (key | key >> 4) & 0x00f00f00f00f;
  key = (key | key >> 8) & 0x0000ff0000ff;
  return static_cast<int>((key | key >> 16) & 0xffff);
}
Cell cellOf(std::uint64_t code) { return {everyThird(code), everyThird(code >> 1), everyThird(code >> 2)}; }

/// Two rooms, one above the other, in a cube of 128 x 128 x 128 cells. Each cell is stored as one bit, in Morton order.
class Cube {
 public:
  explicit Cube(std::uint64_t number) : random_(number), corner_(cellOf(number) * kSide) {
    for (const int bottom : {0, kSide / 2}) addRoom(bottom);
  }

  void appendLeaves(std::vector<Voxel>& leaves) const { appendLeaves(0, kLevel, leaves); }

 private:
  static constexpr int kLevel = 7, kSide = 1 << kLevel;

  void addRoom(int bottom) {
    const int top = bottom + kSide / 2;
    surface({0, 0, bottom}, {kSide, kSide, bottom + 1}, 2);
    for (const int axis : {0, 1}) {
      Cell end(kSide, kSide, top);
      end[axis] = 1;
      surface({0, 0, bottom}, end, axis);
      Cell door(0, 0, bottom + 1), door_end(2, 2, bottom + 42);
      door[1 - axis] = between(10, kSide - 30);
      door_end[1 - axis] = door[1 - axis] + 18;
      fill(door, door_end, 0.0);
    }
    for (int i = 0; i < 12; ++i) addBox(bottom + 1, i % 4 == 0);
    for (int i = 0; i < 2; ++i) addBall(bottom);
  }

  void addBox(int bottom, bool solid) {
    const Cell size(between(6, 32), between(6, 32), between(6, 32));
    const Cell from(between(4, kSide - size.x()), between(4, kSide - size.y()), bottom);
    const Cell one = Cell::Ones();
    fill(from, from + size, solid ? 1.0 : kSeen);
    if (!solid) fill(from + one, from + size - one, 0.0);
  }

  void addBall(int bottom) {
    const int radius = between(4, 12);
    const Cell center(between(radius, kSide - radius), between(radius, kSide - radius),
                      bottom + between(radius, kSide / 2 - radius));
    const Cell half = Cell::Constant(radius), end = center + half;
    forEach(center - half, end, [&](const Cell& cell) {
      const int from_shell = (cell - center).squaredNorm() - radius * (radius - 1);
      if (std::abs(from_shell) < radius) set(cell, kSeen);
    });
  }

  /// Adds a layer of cells. At random places, adds a second layer on top of it, in the direction of `axis`.
  void surface(Cell from, Cell end, int axis) {
    fill(from, end, kSeen);
    ++from[axis], ++end[axis];
    forEach(from, end, [&](const Cell& cell) {
      if (random_.uniform(0.0, 1.0) < kRough) set(cell, kSeen);
    });
  }

  /// Sets each cell with probability `chance`, and clears the other cells.
  void fill(const Cell& from, const Cell& end, double chance) {
    forEach(from, end, [&](const Cell& cell) { set(cell, chance); });
  }

  template <class Do>
  static void forEach(const Cell& from, const Cell& end, const Do& act) {
    for (int z = from.z(); z < end.z(); ++z) {
      for (int y = from.y(); y < end.y(); ++y) {
        for (int x = from.x(); x < end.x(); ++x) act(Cell(x, y, z));
      }
    }
  }

  /// Sets the cell with probability `chance`; otherwise clears the cell.
  void set(const Cell& cell, double chance) {
    const std::uint64_t code = mortonOf({static_cast<std::uint16_t>(cell.x()), static_cast<std::uint16_t>(cell.y()),
                                         static_cast<std::uint16_t>(cell.z()), 0});
    const std::uint64_t bit = std::uint64_t{1} << code % 64;
    std::uint64_t& word = bits_[code / 64];
    word = random_.uniform(0.0, 1.0) < chance ? word | bit : word & ~bit;
  }

  /// Appends the occupied leaves of the octree node that has this level and begins at this Morton code.
  void appendLeaves(std::uint64_t code, int level, std::vector<Voxel>& leaves) const {
    if (level == 2 && bits_[code / 64] == 0) return;
    if (level == 0) {
      if (bits_[code / 64] >> code % 64 & 1u) leaves.push_back(voxelAt(code, 0));
      return;
    }
    const std::size_t before = leaves.size();
    for (std::uint64_t child = 0; child < 8; ++child) {
      appendLeaves(code + (child << 3 * (level - 1)), level - 1, leaves);
    }
    const auto is_child = [&](const Voxel& voxel) { return voxel.level == level - 1; };
    if (leaves.size() != before + 8 || !std::all_of(leaves.end() - 8, leaves.end(), is_child)) return;
    leaves.resize(before);
    leaves.push_back(voxelAt(code, level));
  }

  Voxel voxelAt(std::uint64_t code, int level) const {
    const Cell keys = corner_ + cellOf(code) + Cell::Constant(Voxel::kOriginKey);
    return {static_cast<std::uint16_t>(keys.x()), static_cast<std::uint16_t>(keys.y()),
            static_cast<std::uint16_t>(keys.z()), static_cast<std::uint8_t>(level)};
  }

  int between(int first, int last) {
    return first + static_cast<int>(random_.below(static_cast<std::uint64_t>(last - first + 1)));
  }

  Random random_;
  Cell corner_;
  std::vector<std::uint64_t> bits_ = std::vector<std::uint64_t>(kSide * kSide * kSide / 64);
};

}  // namespace

std::vector<Voxel> buildingOf(std::size_t leaves) {
  std::vector<Voxel> all;
  for (std::uint64_t cube = 0; all.size() < leaves; ++cube) Cube(cube).appendLeaves(all);
  all.resize(leaves);
  return all;
}

}  // namespace bench
}  // namespace hgrid
