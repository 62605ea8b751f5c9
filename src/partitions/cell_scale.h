// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"
#include "partitions/query_shape.h"

namespace hgrid {
namespace book {

/// The indices of a cell on the three axes.
struct Cell {
  std::int64_t x = 0, y = 0, z = 0;
  bool operator==(const Cell& other) const { return x == other.x && y == other.y && z == other.z; }
};

/// Hashes a cell (section 7.1.3). It also serves as the hash function of a std::unordered_map.
///
/// Differs from the book: the numbers are unsigned, because the overflow of signed numbers is undefined. The table size
/// is a power of two, which uses only the lowest bits. So one more product mixes the bits.
struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    // The first three constants are the book's. The upper half of the last product is mixed best.
    const std::uint64_t hash = static_cast<std::uint64_t>(cell.x) * 0x8da6b343u +
                               static_cast<std::uint64_t>(cell.y) * 0xd8163841u +
                               static_cast<std::uint64_t>(cell.z) * 0xcb1ab31fu;
    return static_cast<std::size_t>(hash * 0x9e3779b97f4a7c15u >> 32);
  }
};

/// The cells from `low` to `high` on each axis, both included. There are none if low > high on an axis.
struct CellRange {
  Cell low, high;

  /// Number of cells. It is a double, because it may exceed every integer type.
  double count() const {
    const auto along = [](std::int64_t from, std::int64_t to) {
      return std::max(0.0, double(to) - double(from) + 1.0);
    };
    return along(low.x, high.x) * along(low.y, high.y) * along(low.z, high.z);
  }
  bool contains(const Cell& cell) const {
    return low.x <= cell.x && cell.x <= high.x && low.y <= cell.y && cell.y <= high.y && low.z <= cell.z &&
           cell.z <= high.z;
  }
  bool operator==(const CellRange& other) const { return low == other.low && high == other.high; }
  /// Calls visit(cell) for each cell. The x coordinate changes fastest.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (std::int64_t z = low.z; z <= high.z; ++z) {
      for (std::int64_t y = low.y; y <= high.y; ++y) {
        for (std::int64_t x = low.x; x <= high.x; ++x) visit(Cell{x, y, z});
      }
    }
  }
};

/// Maps coordinates to cells of equal size (section 7.1).
///
/// The index of a cell rounds down and is clamped to -2^52 .. 2^52. So the outermost cells extend to infinity. The
/// index never decreases if the coordinate increases. Therefore two boxes that overlap share the cell of each common
/// point, no matter how the index is rounded.
class CellScale {
 public:
  explicit CellScale(double edge = 1.0) : edge_(edge), inverse_(1.0 / edge) {}

  double edge() const { return edge_; }
  /// The index of a coordinate [m] on its axis.
  std::int64_t indexOf(double coordinate) const {
    // Not a plain cast: -0.1 belongs to cell -1. The clamp comes first, because the conversion of a number that is out
    // of range is undefined.
    return static_cast<std::int64_t>(std::clamp(std::floor(coordinate * inverse_), -kLimit, kLimit));
  }
  /// The cell that contains a point.
  Cell cellOf(const Eigen::Vector3f& point) const {
    return {indexOf(double(point.x())), indexOf(double(point.y())), indexOf(double(point.z()))};
  }
  /// The cells that a box overlaps.
  CellRange cellsOf(const Aabb& box) const { return {cellOf(box.min), cellOf(box.max)}; }
  /// The region of a cell [m], for drawings.
  Aabb regionOf(const Cell& cell) const {
    const auto edge = static_cast<float>(edge_);
    const Eigen::Vector3f low = edge * Eigen::Vector3f(float(cell.x), float(cell.y), float(cell.z));
    return {low, low + Eigen::Vector3f::Constant(edge)};
  }
  /// The cell in which a pair is reported if two overlapping boxes share several cells. It contains the minimum corner
  /// of their common volume. So it is one of the shared cells, and finding it needs no memory of earlier pairs.
  Cell reportingCell(const Aabb& a, const Aabb& b) const { return cellOf(a.min.cwiseMax(b.min).eval()); }

  /// Calls visit(range) for ranges of cells. Together they contain every cell of `grid` that the shape touches. No cell
  /// is in two ranges. A part of the shape beyond `grid` counts as in the outermost cells of `grid`.
  ///
  /// A segment gets one range per layer of cells along its longest axis. So a long diagonal does not visit all cells
  /// within its bounds. Differs from section 7.4.2: there is no walk from cell to cell. Rounding could
  /// make such a walk miss a cell at a corner, and the segment may be thick.
  /// @returns false if there are more than `limit` cells. The search is then incomplete: some ranges were visited,
  ///   and the caller has to go through all occupied cells instead.
  template <class Visit>
  bool visitRanges(const QueryShape& shape, const CellRange& grid, double limit, Visit&& visit) const {
    CellRange whole = clamped(cellsOf(shape.bounds()), grid);
    if (shape.kind() != QueryShape::Kind::segment) {
      if (whole.count() > limit) return false;
      visit(whole);
      return true;
    }
    const int axis = shape.longAxis();
    const std::int64_t first = axis == 0 ? whole.low.x : axis == 1 ? whole.low.y : whole.low.z;
    const std::int64_t last = axis == 0 ? whole.high.x : axis == 1 ? whole.high.y : whole.high.z;
    if (double(last) - double(first) > limit) return false;
    double cells = 0.0;
    for (std::int64_t layer = first; layer <= last; ++layer) {
      CellRange range = clamped(cellsOf(shape.slice(axis, lowOf(layer), highOf(layer))), whole);
      std::int64_t& low = axis == 0 ? range.low.x : axis == 1 ? range.low.y : range.low.z;
      std::int64_t& high = axis == 0 ? range.high.x : axis == 1 ? range.high.y : range.high.z;
      low = high = layer;
      cells += range.count();
      if (cells > limit) return false;
      visit(range);
    }
    return true;
  }

  /// All cells of an unbounded grid, for visitRanges().
  static CellRange everywhere() {
    constexpr auto kFar = static_cast<std::int64_t>(kLimit);
    return {{-kFar, -kFar, -kFar}, {kFar, kFar, kFar}};
  }

 private:
  static constexpr double kLimit = 0x1p52;

  static CellRange clamped(const CellRange& range, const CellRange& to) {
    const auto within = [](std::int64_t value, std::int64_t low, std::int64_t high) {
      return std::min(std::max(value, low), high);
    };
    return {{within(range.low.x, to.low.x, to.high.x), within(range.low.y, to.low.y, to.high.y),
             within(range.low.z, to.low.z, to.high.z)},
            {within(range.high.x, to.low.x, to.high.x), within(range.high.y, to.low.y, to.high.y),
             within(range.high.z, to.low.z, to.high.z)}};
  }
  // The bounds [m] of the coordinates in a layer of cells, rounded outward. The outermost layers extend to infinity.
  double lowOf(std::int64_t layer) const {
    const double low = double(layer) * edge_;
    return layer <= -static_cast<std::int64_t>(kLimit) ? -HUGE_VAL : low - roundingSlack(std::abs(low) + edge_);
  }
  double highOf(std::int64_t layer) const {
    const double high = double(layer + 1) * edge_;
    return layer >= static_cast<std::int64_t>(kLimit) ? HUGE_VAL : high + roundingSlack(std::abs(high) + edge_);
  }

  double edge_, inverse_;
};

/// How the cell size is computed from the boxes (section 7.1.1).
///
/// Differs from the book: the book's cell encloses the largest object in any orientation. Here one very large box must
/// not determine the size of all cells, so 1 of 20 boxes may be longer than a cell. The boxes are axis-aligned, so
/// their longest sides count and not their diagonals.
enum class CellRule {
  objects,  ///< 19 of 20 boxes are no longer than a cell, so they are in at most 8 cells each
  density,  ///< the rule for ray tracing: about as many cells as boxes, n^(1/3) per axis if the boxes fill space
};

/// Length [m] of a box's longest side, computed in double.
inline double longestSideInDouble(const Aabb& box) {
  return (box.max.cast<double>() - box.min.cast<double>()).maxCoeff();
}

/// Returns the edge of a cell [m] for these boxes, 1 if there are none. If 19 of 20 boxes are points, both rules use
/// the density.
double cellEdgeFor(const std::vector<Aabb>& boxes, CellRule rule);

}  // namespace book
}  // namespace hgrid
