// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/distance_lattice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/near_cells.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kMostAlong = 61.0;       // cells along the longest side of the box around the mesh
constexpr double kLeastCell = 1e-12;      // [m] of a cell, for a mesh without size
constexpr double kLeastEdgeShare = 1e-9;  // relative to the coordinates of a mesh: an edge is at least this
constexpr double kBeside = 1e-3;          // [edges] cells that are this near to a triangle are tested, too
constexpr double kGrown = 1.0 + 1e-6;     // cells are tested against triangles as if they were larger by this factor
constexpr int kFarthestEdges = 20;        // [edges] larger distances are stored as this one
constexpr float kSteps = 8.0f;            // bounds are stored in steps of edge / kSteps
constexpr std::uint16_t kMost = 4 * kFarthestEdges * kFarthestEdges;  // [half edges^2] the largest squared distance

/// Returns whether a triangle may touch a box around the origin. Separating axis test (Ericson 2005, section 5.2.9).
bool mayTouchBox(const Triangle& triangle, const Vector& half) {
  const auto isSeparated = [&](const Vector& axis) {
    const double a = axis.dot(triangle[0]), b = axis.dot(triangle[1]), c = axis.dot(triangle[2]);
    const double reach = axis.cwiseAbs().dot(half);
    return std::min({a, b, c}) > reach || std::max({a, b, c}) < -reach;
  };
  const Vector edges[] = {triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]};
  if (isSeparated(edges[0].cross(edges[1]))) return false;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (isSeparated(Vector::Unit(k))) return false;
    for (const Vector& edge : edges) {
      if (isSeparated(Vector::Unit(k).cross(edge))) return false;
    }
  }
  return true;
}

}  // namespace

/// The cells while the lattice is made, x first, then y, then z. No triangle is in the outermost ones.
class DistanceLattice::Cells {
 public:
  explicit Cells(const std::array<int, 3>& counts)
      : counts_(counts),
        steps_{1, counts[0], counts[0] * counts[1]},
        touched_(static_cast<std::size_t>(steps_[2]) * static_cast<std::size_t>(counts[2])) {}

  /// Marks the cells that a triangle may touch. @param triangle  in edges, relative to the corner of the first cell
  void mark(const Triangle& triangle) {
    const Vector low = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
    const Vector high = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
    Numbers first, end;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      first[axis] = std::clamp(static_cast<int>(std::floor(low[k] - kBeside)), 0, counts_[axis] - 1);
      end[axis] = std::clamp(static_cast<int>(std::floor(high[k] + kBeside)), 0, counts_[axis] - 1) + 1;
    }
    mark(triangle, first, end);
  }

  /// Returns for each cell the squared distance [half edges^2] from its center to the nearest cell that is not free.
  std::vector<std::uint16_t> squaredDistances() const {
    const std::vector<std::uint8_t> free = freeCells();
    std::vector<std::uint16_t> values(free.size());
    for (std::size_t i = 0; i < free.size(); ++i) values[i] = free[i] != 0 ? kMost : std::uint16_t{0};
    for (std::size_t axis = 0; axis < 3; ++axis) values = spread(values, axis);
    return values;
  }

 private:
  using Numbers = std::array<int, 3>;  // a number for each axis

  /// Marks those of a box of cells that a triangle may touch. Halves the box until it is a single cell.
  void mark(const Triangle& triangle, const Numbers& first, const Numbers& end) {
    Vector center, half;
    std::size_t longest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      center[k] = 0.5 * (first[axis] + end[axis]);
      half[k] = 0.5 * kGrown * (end[axis] - first[axis]);
      if (end[axis] - first[axis] > end[longest] - first[longest]) longest = axis;
    }
    if (!mayTouchBox({triangle[0] - center, triangle[1] - center, triangle[2] - center}, half)) return;
    const int middle = (first[longest] + end[longest]) / 2;
    if (middle == first[longest]) {
      touched_[index(first[0], first[1], first[2])] = 1;
      return;
    }
    Numbers lower_end = end, upper_first = first;
    lower_end[longest] = upper_first[longest] = middle;
    mark(triangle, first, lower_end);
    mark(triangle, upper_first, end);
  }

  std::size_t index(int x, int y, int z) const { return static_cast<std::size_t>(z * steps_[2] + y * steps_[1] + x); }

  /// Returns for each cell whether it is free. Begins with the first cell and goes from neighbor to neighbor.
  std::vector<std::uint8_t> freeCells() const {
    std::vector<std::uint8_t> free(touched_.size());
    if (touched_[0] != 0) return free;
    std::vector<Numbers> waiting{{0, 0, 0}};
    free[0] = 1;
    while (!waiting.empty()) {
      const Numbers cell = waiting.back();
      waiting.pop_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          Numbers next = cell;
          next[axis] += step;
          if (next[axis] < 0 || next[axis] >= counts_[axis]) continue;
          const std::size_t number = index(next[0], next[1], next[2]);
          if (touched_[number] != 0 || free[number] != 0) continue;
          free[number] = 1;
          waiting.push_back(next);
        }
      }
    }
    return free;
  }

  /// Returns for each cell the minimum of value + squared gap over the cells on a line along an axis.
  std::vector<std::uint16_t> spread(const std::vector<std::uint16_t>& values, std::size_t axis) const {
    std::vector<std::uint16_t> result(values);
    const int count = counts_[axis], step = steps_[axis];
    const auto all = static_cast<int>(values.size());
    for (int away = 1; away < std::min(count, kFarthestEdges + 1); ++away) {
      const std::uint16_t gap = gapSquared(away);
      // The cells of a slab follow each other without a gap; the first and last `away` layers have no partner.
      for (int slab = 0; slab < all; slab += count * step) {
        const int pairs = (count - away) * step, shift = away * step;
        const std::uint16_t *low = values.data() + slab, *high = low + shift;
        std::uint16_t *low_result = result.data() + slab, *high_result = low_result + shift;
        for (int i = 0; i < pairs; ++i) {
          low_result[i] = std::min(low_result[i], static_cast<std::uint16_t>(high[i] + gap));
          high_result[i] = std::min(high_result[i], static_cast<std::uint16_t>(low[i] + gap));
        }
      }
    }
    return result;
  }

  const Numbers counts_, steps_;  // number of cells along each axis, and distance of neighbors in a list
  std::vector<std::uint8_t> touched_;
};

DistanceLattice::DistanceLattice(const std::vector<Triangle>& triangles) {
  Eigen::AlignedBox3d box;
  for (const Triangle& triangle : triangles) {
    for (const Vector& corner : triangle) box.extend(corner);
  }
  // Corners that are far from the origin are rounded, which must be much less than an edge.
  const double farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  edge_ = std::max({box.sizes().maxCoeff() / kMostAlong, kLeastEdgeShare * farthest, kLeastCell});
  std::array<int, 3> counts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    counts[axis] = static_cast<int>(std::ceil(box.sizes()[k] / edge_ + kBeside)) + 2;
    counts_[axis] = static_cast<float>(counts[axis]);
    corner_[k] = box.center()[k] - 0.5 * counts[axis] * edge_;
  }
  Cells cells(counts);
  for (const Triangle& triangle : triangles) {
    Triangle in_edges;
    for (std::size_t i = 0; i < 3; ++i) in_edges[i] = (triangle[i] - corner_) / edge_;
    cells.mark(in_edges);
  }
  for (const std::uint16_t squared : cells.squaredDistances()) {
    bounds_.push_back(static_cast<std::uint8_t>(0.5f * std::sqrt(static_cast<float>(squared)) * kSteps));
  }
}

bool DistanceLattice::isOutside(const Vector& point) const {
  const Vector in_edges = (point - corner_) / edge_;
  std::size_t number = 0;
  for (std::size_t axis = 3; axis-- > 0;) {
    const double at = in_edges[static_cast<Eigen::Index>(axis)], count = static_cast<double>(counts_[axis]);
    if (!(at >= 0.0 && at < count)) return !in_edges.hasNaN();
    number = number * static_cast<std::size_t>(count) + static_cast<std::size_t>(at);
  }
  return bounds_[number] > 0;
}

Four DistanceLattice::lowerBounds(const Four (&points)[3]) const {
  const NearCells cells(points, counts_);
  const auto along_x = static_cast<std::int32_t>(counts_[0]), along_y = static_cast<std::int32_t>(counts_[1]);
  const NearCells::FourInts numbers = (cells.along(2) * along_y + cells.along(1)) * along_x + cells.along(0);
  Four bounds;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    bounds[lane] = static_cast<float>(bounds_[static_cast<std::size_t>(numbers[lane])]);
  }
  return cells.lowerBounds(bounds * (1.0f / kSteps));
}

}  // namespace hgrid
