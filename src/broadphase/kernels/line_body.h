// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Finds the boxes along a line.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/levels_body.h"
#include "broadphase/kernels/line_filter_body.h"
#include "broadphase/kernels/output_body.h"

namespace hgrid {
namespace kernels {
namespace {

/// A range of cells on one axis: the index of the lowest cell, and minus the index of the highest cell. So the
/// component-wise maximum of two spans is the intersection of their ranges.
using Span = Simd::Two;

constexpr double kEndless = 1e300;  // [cells] stands for infinity

/// The coordinate of a line on one axis of a level. All values are in cells. A box that is stored in cell c can touch
/// the line only where the coordinate of the line is within c - below .. c + 1 + above. The outermost cells also hold
/// the boxes outside the window.
struct Track {
  double from, step, below, above, last;

  /// Returns the cells whose boxes a line can touch between the coordinates a and b, in any order. The indices are not
  /// rounded yet. Has no branches, because the sign of a line's direction would be mispredicted.
  Span cellsBetween(double a, double b) const {
    return Simd::plus(Simd::least(Simd::twoOf(a, -a), Simd::twoOf(b, -b)), Simd::twoOf(-above, -below));
  }
  /// Limits a span to the cells that exist: the lowest is at most `last`, the highest at least 0.
  Span within(Span cells) const { return Simd::least(cells, Simd::twoOf(last, 0.0)); }
  /// Returns the cells whose boxes the line can touch anywhere.
  Span whole() const { return within(Simd::greatest(cellsBetween(from, from + step), Simd::twoOf(0.0, -last))); }
};

inline Track trackOf(const Line& line, const Level& level, int axis) {
  const double inverse = static_cast<double>(level.grid.inverse[axis]);
  const double origin = static_cast<double>(level.grid.origin[axis]);
  Track track;
  track.last = static_cast<double>(level.grid.last[axis]);
  track.from = line.from[axis] * inverse - origin;
  track.step = line.step[axis] * inverse;
  // The cells of the boxes were computed in float, the cells of the line are computed in double. Allow for both
  // roundings.
  const double rounded =
      1e-6 * (magnitude(origin) + track.last + 1.0) + 1e-9 * (magnitude(track.step) + magnitude(track.from));
  track.below = line.around * inverse + rounded;
  track.above = track.below + static_cast<double>(level.reach[axis]) * inverse;
  return track;
}

/// Computes which cells of one axis (`on`) the line can touch while it passes a cell of another axis (`passing`).
class Crossing {
 public:
  Crossing(const Track& on, const Track& passing) : on_(on), last_(passing.last) {
    // A line that hardly moves along the axis `passing` may be in one cell of this axis on its whole length. Then the
    // slope is set to 0, and the span is unlimited.
    const double slope = magnitude(passing.step) > 1e-3 ? on.step / passing.step : 0.0;
    const double enter = on.from - slope * (passing.from + passing.below);
    const double leave = on.from - slope * (passing.from - 1.0 - passing.above);
    per_cell_ = Simd::twoOf(slope, -slope);
    // At coordinates near the largest float, `enter` and `leave` may be infinite or NaN. Then the span is unlimited,
    // too.
    const bool limited =
        (slope != 0.0) & (enter < kEndless) & (enter > -kEndless) & (leave < kEndless) & (leave > -kEndless);
    zero_ = limited ? on.cellsBetween(enter, leave) : Simd::twoOf(-kEndless, -kEndless);
    const double endless_if_rising = slope > 0.0 ? kEndless : 0.0, endless_if_not = kEndless - endless_if_rising;
    before_ = Simd::twoOf(-endless_if_rising, -endless_if_not);
    after_ = Simd::twoOf(-endless_if_not, -endless_if_rising);
  }

  /// Returns the part of `cells` that the line can touch while it passes the cell with index `passed` of the other
  /// axis.
  Span within(std::int32_t passed, Span cells) const {
    const double cell = passed;
    Span met = Simd::plus(zero_, Simd::times(per_cell_, Simd::twoOf(cell, cell)));
    if (cell == 0.0) met = Simd::plus(met, before_);
    if (cell == last_) met = Simd::plus(met, after_);
    return on_.within(Simd::greatest(met, cells));
  }

 private:
  const Track& on_;
  double last_;
  Span zero_, per_cell_;  // the span in cell 0, and its change from each cell to the next
  Span before_, after_;   // added in the first cell and in the last cell, because these cells extend to infinity
};

/// Writes the positions of the boxes in the ranges that may touch the line.
void __attribute__((noinline)) searchRanges(const Level& level, const LineFilter& line, const PositionRange* ranges,
                                            int count, Output<std::uint32_t>& out) {
  const LineFilter filter = line;  // a local copy, which the compiler can keep in registers
  Output<std::uint32_t> found = out;
  for (int i = 0; i < count; ++i) {
    for (std::uint32_t j = ranges[i].begin; j < ranges[i].end; j += Simd::kWidth) {
      found.wrote(Simd::storePositions(found.room(), j, onLine(filter, level, j, ranges[i].end - j)));
    }
  }
  out = found;
}

/// Finds the boxes of one level that may touch a line. Goes through the slabs of cells that the line crosses. In each
/// slab, goes through the rows that the line crosses there, and finds the cells of each row.
///
/// The cells are computed from the line itself, not from the cells before. So rounding errors do not add up. They would
/// add up in a walk from cell to cell (Ericson 2005, 7.4.2). Several rows are searched together, so that the processor
/// can load one row while it computes another.
void searchLevel(const Level& level, const Line& line, const LineFilter& filter, Output<std::uint32_t>& found) {
  constexpr int kRanges = 32;
  const Level l = level;
  const Grid& grid = l.grid;
  const Track x = trackOf(line, l, grid.axes[0]), y = trackOf(line, l, grid.axes[1]),
              z = trackOf(line, l, grid.axes[2]);
  const Crossing x_in_slab(x, z), y_in_slab(y, z), x_in_row(x, y);
  const Span x_whole = x.whole(), y_whole = y.whole();
  PositionRange ranges[kRanges];
  int count = 0;
  std::int32_t slabs[2], rows[2], cells[2];  // as in Span: index of the lowest, minus the index of the highest
  Simd::store(z.whole(), slabs);
  for (std::int32_t slab = slabs[0]; slab <= -slabs[1]; ++slab) {
    const Span x_here = x_in_slab.within(slab, x_whole);
    Simd::store(y_in_slab.within(slab, y_whole), rows);
    const std::uint32_t* const first = l.start + slab * grid.slab;
    for (std::int32_t row = rows[0]; row <= -rows[1]; ++row) {
      Simd::store(x_in_row.within(row, x_here), cells);
      const std::uint32_t* const start = first + row * grid.row;
      PositionRange& range = ranges[count];
      range.begin = start[cells[0]];
      range.end = start[1 - cells[1]];
      count += range.begin < range.end;
      if (count == kRanges) {
        searchRanges(l, filter, ranges, count, found);
        count = 0;
      }
    }
  }
  searchRanges(l, filter, ranges, count, found);
}

void along(const LevelSet* set, const Line* line, PositionSink* sink) {
  const LineFilter filter = filterOf(*line);
  const Level* const levels = set->levels;
  Output<std::uint32_t> found(sink);
  visitLeaves(
      *set,
      [&filter](const Columns& bounds, std::uint32_t j, std::uint32_t count) {
        return onLine(filter, bounds, j, count);
      },
      [&](std::uint32_t number) {
        if (set->per_leaf == 0) return searchLevel(levels[number], *line, filter, found);
        const PositionRange range = rangeOf(*set, number);
        searchRanges(*levels, filter, &range, 1, found);
      });
  found.close();
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
