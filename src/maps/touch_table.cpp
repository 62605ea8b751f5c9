// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/maps/touch_table.h"

#include <algorithm>
#include <cmath>

#include "maps/branch_free.h"
#include "maps/brick.h"
#include "maps/static_grid_bricks.h"

namespace hgrid {
namespace {

// Elements from this value on are of empty bricks; the rest is the distance in bricks.
constexpr std::uint32_t kEmpty = std::uint32_t{1} << 31;
constexpr std::uint32_t kFull = 0;                           // element of a brick whose cells are all occupied
constexpr std::uint32_t kNoCells = 1;                        // index into cells_ of an empty set
constexpr std::size_t kMostElements = std::size_t{1} << 24;  // 64 MiB; a larger map has no table
constexpr int kMostBricks = 6;      // along an axis; the map answers for spheres that may overlap more
constexpr int kFarthest = 5;        // distances in bricks are counted up to this one; it also stands for larger ones
constexpr std::size_t kAhead = 16;  // spheres whose elements are fetched before the first of them is answered

/// Sets each value of `to` to the largest of the value in `from` and its two neighbors along an axis.
void spread(const std::array<std::int32_t, 3>& counts, int axis, const std::vector<std::uint8_t>& from,
            std::vector<std::uint8_t>& to) {
  const auto across = static_cast<std::size_t>(counts[0]);
  if (axis == 0) {
    for (std::size_t row = 0; row < from.size(); row += across) {
      for (std::size_t i = row + 1; i + 1 < row + across; ++i) to[i] = std::max({from[i - 1], from[i], from[i + 1]});
      const std::size_t last = row + across - 1;
      to[row] = std::max(from[row], from[std::min(row + 1, last)]);
      to[last] = std::max(from[last], from[std::max(row + 1, last) - 1]);
    }
    return;
  }
  // The neighbors are one row or one layer of rows away.
  const std::size_t step = axis == 1 ? across : across * static_cast<std::size_t>(counts[1]);
  const std::size_t length = step * static_cast<std::size_t>(counts[static_cast<std::size_t>(axis)]);
  for (std::size_t begin = 0; begin < from.size(); begin += length) {
    for (std::size_t at = begin; at < begin + length; at += step) {
      const std::uint8_t* const here = &from[at];
      const std::uint8_t* const before = at > begin ? here - step : here;
      const std::uint8_t* const after = at + step < begin + length ? here + step : here;
      for (std::size_t i = 0; i < step; ++i) to[at + i] = std::max({before[i], here[i], after[i]});
    }
  }
}

/// Where a sphere is along one axis, relative to a brick.
struct Along {
  double at;           // [finest edges] center of the sphere, from the corner of the brick
  std::uint64_t near;  // cells of the brick that are within the reach of the sphere along this axis

  /// Returns the square of the distance [finest edges^2] of a cell along an axis.
  double squaredGap(unsigned cell, int axis) const {
    const double low = cellAlong(cell, axis), gap = greaterOf(greaterOf(low - at, at - (low + 1.0)), 0.0);
    return gap * gap;
  }
};

}  // namespace

/// The bricks that a sphere overlaps, clipped to the array.
struct TouchTable::Span {
  Eigen::Vector3d center;  // [finest edges] from the origin of the map
  double near_squared;     // [finest edges^2] square of the distance up to which a cell touches the sphere
  double reach;            // [finest edges] cells farther away along an axis are not looked at; a little larger
  // Bricks of the array. An axis on which the sphere misses the array has first > last. `middle` is the brick of the
  // array that is nearest to the center.
  std::array<std::int32_t, 3> first, last, middle;
  std::size_t element;  // index of the element of `middle`
};

TouchTable::TouchTable(const StaticGrid& grid) : grid_(grid) {
  if (grid.size() == 0) return;
  std::size_t size = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto brickOf = [&](double corner) { return std::floor(std::round(corner / grid.finestEdge()) / 4.0); };
    const double low = brickOf(grid.bounds().min()[static_cast<Eigen::Index>(axis)]);
    const double high = brickOf(grid.bounds().max()[static_cast<Eigen::Index>(axis)]);  // of the first cell after it
    corner_[axis] = 4 * static_cast<std::int32_t>(low);
    counts_[axis] = static_cast<std::int32_t>(high - low) + 1;
    size *= static_cast<std::size_t>(counts_[axis]);
  }
  if (size > kMostElements) return;
  elements_.assign(size, kEmpty);
  cells_ = {~std::uint64_t{0}, 0};  // kFull, kNoCells
  fill(grid.bricks_->start);
  writeDistances();
}

/// Writes the occupied cells of a brick, or of all bricks inside a larger one.
void TouchTable::fill(const Brick& brick) {
  const Bricks& bricks = *grid_.bricks_;
  const auto elementAt = [&](const std::array<std::int32_t, 3>& corner) -> std::uint32_t& {
    std::array<std::int32_t, 3> at;
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] = (corner[axis] - corner_[axis]) / 4;
    return elements_[static_cast<std::size_t>((at[2] * counts_[1] + at[1]) * counts_[0] + at[0])];
  };
  std::uint64_t left = bricks.cellsOf(brick);
  if (brick.level == 0) {
    elementAt(brick.corner) = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back(left);
    return;
  }
  for (; left != 0; left &= left - 1) {
    const unsigned cell = firstCell(left);
    if ((bricks.fullOf(brick) >> cell & 1u) == 0) {
      fill(bricks.below(brick, cell));
      continue;
    }
    // The cell is a cube of whole bricks, all of whose cells are occupied.
    const std::int32_t edge = std::int32_t{1} << 2 * brick.level;
    std::array<std::int32_t, 3> low;
    for (int axis = 0; axis < 3; ++axis) {
      low[static_cast<std::size_t>(axis)] = brick.corner[static_cast<std::size_t>(axis)] + cellAlong(cell, axis) * edge;
    }
    for (std::int32_t z = low[2]; z < low[2] + edge; z += 4) {
      for (std::int32_t y = low[1]; y < low[1] + edge; y += 4) std::fill_n(&elementAt({low[0], y, z}), edge / 4, kFull);
    }
  }
}

/// Writes into the element of each empty brick the distance to the nearest brick with voxels: the largest of the
/// distances along x, y and z, in bricks, at most kFarthest.
void TouchTable::writeDistances() {
  std::vector<std::uint8_t> nearness(elements_.size()), along_x(elements_.size()), along_xy(elements_.size());
  for (std::size_t i = 0; i < elements_.size(); ++i) nearness[i] = elements_[i] < kEmpty ? kFarthest : 0;
  for (int step = 1; step < kFarthest; ++step) {
    std::vector<std::uint8_t>& along_xyz = along_x;  // reuses the memory
    spread(counts_, 0, nearness, along_x);
    spread(counts_, 1, along_x, along_xy);
    spread(counts_, 2, along_xy, along_xyz);
    for (std::size_t i = 0; i < nearness.size(); ++i) {
      if (nearness[i] == 0 && along_xyz[i] > 0) nearness[i] = static_cast<std::uint8_t>(along_xyz[i] - 1);
    }
  }
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    if (elements_[i] >= kEmpty) elements_[i] = kEmpty + static_cast<std::uint32_t>(kFarthest - nearness[i]);
  }
}

std::size_t TouchTable::bytes() const { return sizeof(*this) + 4 * elements_.capacity() + 8 * cells_.capacity(); }

/// Finds the bricks that a sphere overlaps. @returns false if the map must answer
bool TouchTable::spanOf(const Sphere& sphere, Span& span) const {
  const double edge = grid_.finestEdge();
  const Sphere in_keys{sphere.center / edge, sphere.radius / edge};
  const double near = touchingDistance(in_keys);
  span.center = in_keys.center;
  span.near_squared = near * near;
  span.reach = near + 1e-9 + 1e-12 * (span.center.cwiseAbs().maxCoeff() + near);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = span.center[static_cast<Eigen::Index>(axis)] - corner_[axis];
    const double first = 0.25 * (at - span.reach), last = 0.25 * (at + span.reach);
    if (!(last - first < kMostBricks - 1)) return false;  // also if a number is NaN or infinite
    const double end = counts_[axis];
    span.first[axis] = static_cast<std::int32_t>(std::min(std::max(first, 0.0), end));
    span.last[axis] = last < 0.0 ? -1 : static_cast<std::int32_t>(std::min(last, end - 1.0));
    span.middle[axis] = static_cast<std::int32_t>(std::min(std::max(0.25 * at, 0.0), end - 1.0));
  }
  span.element = static_cast<std::size_t>((span.middle[2] * counts_[1] + span.middle[1]) * counts_[0] + span.middle[0]);
  return true;
}

bool TouchTable::touches(const Span& span) const {
  std::int32_t reach = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (span.first[axis] > span.last[axis]) return false;
    reach = std::max({reach, span.middle[axis] - span.first[axis], span.last[axis] - span.middle[axis]});
  }
  const std::uint32_t middle = elements_[span.element];
  if (middle >= kEmpty && static_cast<std::uint32_t>(reach) < middle - kEmpty) return false;
  Along along[3][kMostBricks];
  // Computes what touchesBrick() needs of the bricks with this coordinate along an axis.
  const auto lookFrom = [&](std::size_t axis, std::int32_t brick) {
    const double at = span.center[static_cast<Eigen::Index>(axis)] - (corner_[axis] + 4.0 * brick);
    along[axis][brick - span.first[axis]] = {at,
                                             cellsBetween(static_cast<int>(axis), at - span.reach, at + span.reach)};
  };
  // Returns whether the sphere touches any voxel of the brick at x, y, z.
  const auto touchesBrick = [&](std::uint32_t element, std::int32_t x, std::int32_t y, std::int32_t z) {
    const Along &in_x = along[0][x - span.first[0]], &in_y = along[1][y - span.first[1]],
                &in_z = along[2][z - span.first[2]];
    std::uint64_t cells = cells_[element < kEmpty ? element : kNoCells] & in_x.near & in_y.near & in_z.near;
    for (; cells != 0; cells &= cells - 1) {
      const unsigned cell = firstCell(cells);
      if (in_x.squaredGap(cell, 0) <= span.near_squared - (in_z.squaredGap(cell, 2) + in_y.squaredGap(cell, 1))) {
        return true;
      }
    }
    return false;
  };
  // Most spheres that touch a voxel touch one in the brick of their center. So this brick is tested before the others
  // are looked at. The loop below tests it again, because leaving it out would need a branch.
  for (std::size_t axis = 0; axis < 3; ++axis) lookFrom(axis, span.middle[axis]);
  if (touchesBrick(middle, span.middle[0], span.middle[1], span.middle[2])) return true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::int32_t brick = span.first[axis]; brick <= span.last[axis]; ++brick) {
      if (brick != span.middle[axis]) lookFrom(axis, brick);
    }
  }
  for (std::int32_t z = span.first[2]; z <= span.last[2]; ++z) {
    for (std::int32_t y = span.first[1]; y <= span.last[1]; ++y) {
      const std::uint32_t* const row = &elements_[static_cast<std::size_t>((z * counts_[1] + y) * counts_[0])];
      for (std::int32_t x = span.first[0]; x <= span.last[0]; ++x) {
        if (touchesBrick(row[x], x, y, z)) return true;
      }
    }
  }
  return false;
}

bool TouchTable::touches(const Sphere& sphere) const {
  Span span;
  return hasTable() && spanOf(sphere, span) ? touches(span) : grid_.touches(sphere);
}

void TouchTable::touches(const std::vector<Sphere>& spheres, std::vector<std::uint8_t>& touched) const {
  touched.resize(spheres.size());
  Span spans[kAhead];
  bool is_small[kAhead];
  for (std::size_t begin = 0; begin < spheres.size(); begin += kAhead) {
    const std::size_t count = std::min(kAhead, spheres.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      is_small[i] = hasTable() && spanOf(spheres[begin + i], spans[i]);
      if (is_small[i]) __builtin_prefetch(&elements_[spans[i].element]);
    }
    for (std::size_t i = 0; i < count; ++i) {
      touched[begin + i] = (is_small[i] ? touches(spans[i]) : grid_.touches(spheres[begin + i])) ? 1 : 0;
    }
  }
}

}  // namespace hgrid
