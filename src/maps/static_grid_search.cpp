// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Implements the queries of StaticGrid. static_grid.cpp builds it.
#include <algorithm>
#include <cmath>

#include "geometry/infinity.h"
#include "hgrid_proximity/maps/static_grid.h"
#include "maps/branch_free.h"
#include "maps/brick.h"
#include "maps/static_grid_bricks.h"
#include "maps/static_grid_line.h"

namespace hgrid {
namespace {

/// Searches the bricks. All coordinates are in keys: they count finest edges from the origin of the map. So the corners
/// of cells are integers.
class Search {
 public:
  Search(const Bricks& bricks, double finest_edge) : bricks_(bricks), finest_edge_(finest_edge) {}

  Eigen::Vector3d keysAt(const Eigen::Vector3d& point) const { return point / finest_edge_; }
  double meters(double keys) const { return keys * finest_edge_; }
  double keys(double meters) const { return meters / finest_edge_; }

  /// A box in keys, enlarged by a tolerance for rounding errors.
  struct Range {
    Eigen::Array3d min, max;
  };
  static Range rangeAround(const Eigen::Vector3d& min, const Eigen::Vector3d& max, double by) {
    constexpr double kLeast = 1e-9;  // [keys]
    const double rounded = kLeast + roundingSlack(std::max(min.cwiseAbs().maxCoeff(), max.cwiseAbs().maxCoeff()) + by);
    return {min.array() - (by + rounded), max.array() + (by + rounded)};
  }

  /// Calls `look` for the voxels in a brick, in Morton order. `chosen` selects the cells that are visited. Stops if
  /// `look` returns false.
  /// @returns false if `look` returned false
  template <class Chosen, class Look>
  bool visit(const Brick& brick, const Chosen& chosen, const Look& look) const {
    const std::uint64_t full = bricks_.fullOf(brick);
    std::uint64_t cells = bricks_.cellsOf(brick) & chosen(brick, full != 0);
    while (cells != 0) {
      const unsigned cell = firstCell(cells);
      if (full >> cell & 1u) {
        cells &= ~bricks_.cellsOfVoxel(brick, cell);
        if (!look(bricks_.voxelAt(brick, cell))) return false;
      } else {
        cells &= cells - 1;
        if (!visit(bricks_.below(brick, cell), chosen, look)) return false;
      }
    }
    return true;
  }

  /// Selects the cells of a brick that overlap a range.
  static auto inRange(const Range& range) {
    return [range](const Brick& brick, bool) { return cellsWithin(brick, range); };
  }
  /// Selects the cells of a brick that touch a sphere [keys]. If no cell of the brick is a voxel, it selects all cells
  /// that overlap the box of the sphere, because that is faster.
  static auto inSphere(const Sphere& sphere) {
    const double near = touchingDistance(sphere);
    return [range = rangeAround(sphere.center, sphere.center, sphere.radius), sphere, near](const Brick& brick,
                                                                                            bool exactly) {
      return exactly ? cellsTouching(brick, sphere.center, near * near) : cellsWithin(brick, range);
    };
  }

  /// Calls `look` for the voxels within `limit` [keys] of a box [keys]. Visits the cells of each brick in the order of
  /// their distance from the box. `look` returns the new limit.
  template <class Look>
  void near(const Brick& brick, const Eigen::AlignedBox3d& box, double& limit, const Look& look) const {
    struct Cell {
      double distance;
      unsigned number;
    };
    std::array<Cell, 64> cells;
    std::size_t count = 0;
    std::uint64_t left = bricks_.cellsOf(brick) & cellsWithin(brick, rangeAround(box.min(), box.max(), limit));
    const std::uint64_t full = bricks_.fullOf(brick);
    while (left != 0) {
      const unsigned cell = firstCell(left);
      left &= full >> cell & 1u ? ~bricks_.cellsOfVoxel(brick, cell) : left - 1;
      const double distance = distanceTo(
          box, full >> cell & 1u ? keysOf(bricks_.voxelAt(brick, cell)) : cubeOf(bricks_.below(brick, cell)));
      if (distance <= limit) cells[count++] = {distance, cell};
    }
    std::sort(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(count), [](const Cell& a, const Cell& b) {
      return a.distance != b.distance ? a.distance < b.distance : a.number < b.number;
    });
    for (std::size_t i = 0; i < count && cells[i].distance <= limit; ++i) {
      if (full >> cells[i].number & 1u) {
        limit = std::min(limit, look(bricks_.voxelAt(brick, cells[i].number), cells[i].distance));
      } else {
        near(bricks_.below(brick, cells[i].number), box, limit, look);
      }
    }
  }

 private:
  static std::uint64_t cellsWithin(const Brick& brick, const Range& range) {
    const double per_key = 1.0 / static_cast<double>(std::int64_t{1} << 2 * brick.level);
    std::uint64_t cells = ~std::uint64_t{0};
    for (int axis = 0; axis < 3; ++axis) {
      const double corner = brick.corner[static_cast<std::size_t>(axis)];
      cells &= cellsBetween(axis, (range.min[axis] - corner) * per_key, (range.max[axis] - corner) * per_key);
    }
    return cells;
  }

  /// Returns the cells that touch a sphere. Computes the squared distances of the four layers of cells along each axis.
  /// The squared distance of a cell is the sum of three of these values.
  static std::uint64_t cellsTouching(const Brick& brick, const Eigen::Vector3d& center, double most_squared) {
    const double edge = static_cast<double>(std::int64_t{1} << 2 * brick.level);
    std::array<std::array<double, 4>, 3> squared;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = center[static_cast<Eigen::Index>(axis)] - brick.corner[axis];
      for (std::size_t i = 0; i < 4; ++i) {
        const double low = static_cast<double>(i) * edge;
        const double gap = greaterOf(greaterOf(low - at, at - (low + edge)), 0.0);
        squared[axis][i] = gap * gap;
      }
    }
    std::uint64_t cells = 0;
    for (unsigned z = 0; z < 4; ++z) {
      for (unsigned y = 0; y < 4; ++y) {
        const double rest = most_squared - (squared[2][z] + squared[1][y]);
        std::uint64_t row = 0;  // a set of the cells 0, 1, 8 and 9, which form a row along x
        for (const unsigned x : {0u, 1u, 2u, 3u}) {
          row |= static_cast<std::uint64_t>(squared[0][x] <= rest) << ((x & 1) + (x >> 1) * 8);
        }
        cells |= row << ((y & 1) * 2 + (y >> 1) * 16 + (z & 1) * 4 + (z >> 1) * 32);
      }
    }
    return cells;
  }

  static Aabb cubeOf(const Brick& brick) {
    const Eigen::Vector3f min(static_cast<float>(brick.corner[0]), static_cast<float>(brick.corner[1]),
                              static_cast<float>(brick.corner[2]));
    return {min, min + Eigen::Vector3f::Constant(static_cast<float>(std::int64_t{4} << 2 * brick.level))};
  }

  static double distanceTo(const Eigen::AlignedBox3d& box, const Aabb& cube) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double gap = greaterOf(greaterOf(static_cast<double>(cube.min[axis]) - box.max()[axis],
                                             box.min()[axis] - static_cast<double>(cube.max[axis])),
                                   0.0);
      sum += gap * gap;
    }
    return std::sqrt(sum);
  }

  const Bricks& bricks_;
  double finest_edge_;  // [m] edge of a voxel of level 0
};

}  // namespace

std::vector<Voxel> StaticGrid::voxels() const {
  std::vector<Voxel> all;
  all.reserve(size_);
  overlapping(Eigen::AlignedBox3d(Eigen::Vector3d::Constant(-kInfinity), Eigen::Vector3d::Constant(kInfinity)), size_,
              all);
  return all;
}

namespace {

/// Returns a function that stores voxels in `found`. It returns false once there are more than `most` voxels.
auto keepIn(std::vector<Voxel>& found, std::size_t most) {
  found.clear();
  return [&found, most](const Voxel& voxel) {
    if (found.size() == most) return false;
    found.push_back(voxel);
    return true;
  };
}

}  // namespace

bool StaticGrid::overlapping(const Eigen::AlignedBox3d& box, std::size_t most, std::vector<Voxel>& found) const {
  const Search search(*bricks_, finest_edge_);
  const auto range = Search::rangeAround(search.keysAt(box.min()), search.keysAt(box.max()), 0.0);
  return search.visit(bricks_->start, Search::inRange(range), keepIn(found, most));
}

bool StaticGrid::overlapping(const Sphere& sphere, std::size_t most, std::vector<Voxel>& found) const {
  const Search search(*bricks_, finest_edge_);
  const Sphere in_keys{search.keysAt(sphere.center), search.keys(sphere.radius)};
  return search.visit(bricks_->start, Search::inSphere(in_keys), keepIn(found, most));
}

bool StaticGrid::touches(const Sphere& sphere) const {
  const Search search(*bricks_, finest_edge_);
  const Sphere in_keys{search.keysAt(sphere.center), search.keys(sphere.radius)};
  return !search.visit(bricks_->start, Search::inSphere(in_keys), [](const Voxel&) { return false; });
}

std::optional<VoxelTouch> StaticGrid::firstAlong(const Segment& segment, double error) const {
  const Search search(*bricks_, finest_edge_);
  const Segment in_keys{search.keysAt(segment.from), search.keysAt(segment.to), search.keys(segment.radius)};
  LineSearch line(*bricks_, in_keys, search.keys(error));
  VoxelTouch first = line.first();
  if (std::isinf(first.along)) return std::nullopt;
  first.along *= (segment.to - segment.from).norm();
  return first;
}

void StaticGrid::visitNear(const Eigen::AlignedBox3d& box, double limit, const Look& look) const {
  const Search search(*bricks_, finest_edge_);
  const Eigen::AlignedBox3d in_keys(search.keysAt(box.min()), search.keysAt(box.max()));
  const double farthest = std::max(in_keys.min().cwiseAbs().maxCoeff(), in_keys.max().cwiseAbs().maxCoeff());
  const double rounded = roundingSlack(farthest + 1.0);  // voxels within this distance count as touching
  double limit_in_keys = search.keys(limit) + rounded;
  search.near(bricks_->start, in_keys, limit_in_keys, [&](const Voxel& voxel, double distance) {
    return search.keys(look(voxel, distance > rounded ? search.meters(distance) : 0.0)) + rounded;
  });
}

void StaticGrid::nearest(const Eigen::AlignedBox3d& box, std::size_t count, double limit,
                         std::vector<NearVoxel>& found) const {
  found.clear();
  if (count == 0) return;
  const auto nearer = [](const NearVoxel& a, const NearVoxel& b) {
    return a.distance != b.distance ? a.distance < b.distance : mortonOf(a.voxel) < mortonOf(b.voxel);
  };
  visitNear(box, limit, [&](const Voxel& voxel, double distance) {
    if (found.size() == count) found.pop_back();
    const NearVoxel one{voxel, distance};
    found.insert(std::upper_bound(found.begin(), found.end(), one, nearer), one);
    return found.size() < count ? limit : found.back().distance;
  });
}

}  // namespace hgrid
