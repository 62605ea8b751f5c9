// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/shape_levels.h"

#include <algorithm>
#include <cmath>

#include "geometry/rounding.h"

namespace hgrid {
namespace {

constexpr double kFactors[] = {1.0, 1.5, 2.5, 4.0, 8.0, 30.0};  // edges of a cell across the rows, in longest sides
constexpr double kLeastFactor = 0.25;                           // least edge of a cell along the rows, in longest sides
constexpr double kMostCubes = 0.7;  // if more of the boxes are long on all axes, no levels are planned
constexpr double kFew = 0.05;       // rare shapes: each has at most this fraction of the boxes

/// Estimates the cost [ns] to find the pairs of level `number` with all other levels, if the level had these cells.
double costWithOthers(const ShapeLevels& levels, std::size_t number, const Cells& cells) {
  double cost = 0.0;
  for (std::size_t other = 0; other < levels.count; ++other) {
    if (other == number) continue;
    const Census &one = levels.censuses[number], &two = levels.censuses[other];
    double asked = costOfAsking(two, one, cells);
    if (std::isfinite(levels.cells[other].cost)) {
      asked = std::min(asked, costOfAsking(one, two, levels.cells[other]));
    }
    cost += asked;
  }
  return cost;
}

/// Selects the cells of level `number` that cost least, while the other levels keep theirs.
void selectCells(ShapeLevels& levels, std::size_t number, const Window& window) {
  const Census& census = levels.censuses[number];
  Cells best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t x = 0; x < 3; ++x) {
    const AxisOrder axes = rowsAlong(x);
    const auto edge = [&](std::size_t axis, double factor) {
      return factor * std::max(census.largest[axis], kLeastLength);
    };
    for (const double factor_y : kFactors) {
      for (const double factor_z : kFactors) {
        const Cells cells = cellsOf(census, window, axes, edge(axes[1], factor_y), edge(axes[2], factor_z),
                                    kLeastFactor * census.largest[x]);
        if (!(cells.cost < least)) continue;
        const double cost = cells.cost + costWithOthers(levels, number, cells);
        if (cost < least) {
          best = cells;
          least = cost;
        }
      }
    }
  }
  if (!std::isfinite(least)) {
    // The boxes are so sparse that all these edges give too many cells. Then the number of rows determines the edges.
    const double edge =
        2.0 * std::max({window.length(1), window.length(2), kLeastLength}) / std::sqrt(window.mostCells(census.boxes));
    best = cellsOf(census, window, rowsAlong(0), edge, edge, kLeastFactor * census.largest[0]);
  }
  levels.cells[number] = best;
}

/// Selects the cells of all levels, one level after the other. Repeats this, because the best cells of a level depend
/// on those of the other levels. Then computes the cost of the levels.
void selectAllCells(ShapeLevels& levels, const Window& window) {
  constexpr int kRepeats = 2;
  levels.cells.fill(Cells{});
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    for (std::size_t level = 0; level < levels.count; ++level) selectCells(levels, level, window);
  }
  levels.cost = 0.0;
  for (std::size_t level = 0; level < levels.count; ++level) {
    levels.cost += levels.cells[level].cost + 0.5 * costWithOthers(levels, level, levels.cells[level]);
  }
}

/// Returns whether the boxes of a shape are about equally long on the axes on which they are long. Otherwise the
/// longest of them would make a search visit too many cells for each of the others.
bool isUniform(const Census& census, std::size_t shape) {
  constexpr double kMostOfMean = 3.0;
  for (std::size_t i = 0; i < 3; ++i) {
    if ((shape >> i & 1u) != 0 && census.largest[i] > kMostOfMean * census.mean(i)) return false;
  }
  return true;
}

}  // namespace

std::size_t shapeOf(const std::array<float, 3>& sides) {
  const float longest = *std::max_element(sides.begin(), sides.end());
  std::size_t shape = 0;
  for (std::size_t i = 0; i < 3; ++i) shape |= (sides[i] * kernels::kLongRatio >= longest ? std::size_t{1} : 0) << i;
  return shape;
}

ShapeLevels shapeLevelsOf(const ShapeCensuses& shapes, const Window& window) {
  ShapeLevels levels;
  double boxes = 0.0;
  for (const Census& shape : shapes) boxes += shape.boxes;
  if (shapes.back().boxes > kMostCubes * boxes) return levels;
  const auto isFrequent = [&](std::size_t shape) { return shapes[shape].boxes > kFew * boxes; };
  Census others;
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    if (!isFrequent(shape)) {
      others.add(shapes[shape]);
    } else if (!isUniform(shapes[shape], shape)) {
      return {};
    } else {
      levels.of_shape[shape] = static_cast<std::uint8_t>(levels.count);
      levels.censuses[levels.count++] = shapes[shape];
    }
  }
  if (others.boxes > 0.0) levels.censuses[levels.count++] = others;
  selectAllCells(levels, window);
  if (others.boxes == 0.0) {  // boxes may turn and get a rare shape later; their level then has one cell
    Cells& one = levels.cells[levels.count++];
    one.count.fill(1.0);
    for (std::size_t i = 0; i < 3; ++i) one.edge[i] = 1.0 + 2.0 * window.length(i);  // longer than the window
  }
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    if (!isFrequent(shape)) levels.of_shape[shape] = static_cast<std::uint8_t>(levels.count - 1);
  }
  return levels;
}

}  // namespace hgrid
