// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Boxes along a line.
// Part of kernels_body.h, which says what Simd is.
#pragma once

#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/levels_body.h"
#include "broadphase/kernels/line_filter_body.h"
#include "broadphase/kernels/output_body.h"

namespace hgrid {
namespace kernels {
namespace {

/// Cells of an axis, as lowest and minus highest: what is common to two spans has the greater of both numbers.
using Span = Simd::Two;

constexpr double kEndless = 1e300;  // [cells]

/// A line on one axis of a level, all in cells. A box of cell c can be met only while the line is within
/// c - below .. c + 1 + above; the outermost cells hold all that is beyond them, too.
struct Track {
  double from, step, below, above, last;

  /// The cells whose boxes a line can meet that is between two numbers. Not yet rounded down.
  Span cellsBetween(double low, double high) const { return Simd::twoOf(low - above, -(high + below)); }
  Span within(Span cells) const { return Simd::least(cells, Simd::twoOf(last, 0.0)); }
  Span whole() const {
    const double to = from + step;
    const Span cells = step > 0.0 ? cellsBetween(from, to) : cellsBetween(to, from);
    return within(Simd::greatest(cells, Simd::twoOf(0.0, -last)));
  }
};

inline Track trackOf(const Line& line, const Level& level, int axis) {
  const double inverse = static_cast<double>(level.grid.inverse[axis]);
  const double origin = static_cast<double>(level.grid.origin[axis]);
  Track track;
  track.last = static_cast<double>(level.grid.last[axis]);
  track.from = line.from[axis] * inverse - origin;
  track.step = line.step[axis] * inverse;
  // The boxes' cells were rounded in float, what is computed here in double.
  const double rounded =
      1e-6 * (magnitude(origin) + track.last + 1.0) + 1e-9 * (magnitude(track.step) + magnitude(track.from));
  track.below = line.around * inverse + rounded;
  track.above = track.below + static_cast<double>(level.reach[axis]) * inverse;
  return track;
}

/// The cells of one axis while the line passes a cell of another.
class Crossing {
 public:
  Crossing(const Track& on, const Track& passing) : on_(on), last_(passing.last) {
    // What hardly moves on the other axis stays in a cell of this axis on its whole length.
    const double slope = magnitude(passing.step) > 1e-3 ? on.step / passing.step : 0.0;
    const double enter = on.from - slope * (passing.from + passing.below);
    const double leave = on.from - slope * (passing.from - 1.0 - passing.above);
    per_cell_ = Simd::twoOf(slope, -slope);
    if (slope > 0.0) {
      zero_ = on.cellsBetween(enter, leave);
      before_ = Simd::twoOf(-kEndless, 0.0);
      after_ = Simd::twoOf(0.0, -kEndless);
    } else {
      zero_ = slope < 0.0 ? on.cellsBetween(leave, enter) : Simd::twoOf(-kEndless, -kEndless);
      before_ = Simd::twoOf(0.0, -kEndless);
      after_ = Simd::twoOf(-kEndless, 0.0);
    }
  }

  /// Those of `cells` that are met while the line passes this one.
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
  Span zero_, per_cell_;  // at cell 0, and from each to the next
  Span before_, after_;   // what the outermost cells add
};

/// Positions of a row of cells that a line passes.
struct Passage {
  std::uint32_t begin, end;
};

void __attribute__((noinline)) searchPassages(const Level& level, const LineFilter& line, const Passage* passages,
                                              int count, Output<std::uint32_t>& out) {
  const LineFilter filter = line;  // what a compiler sees that nobody else can write to stays in registers
  Output<std::uint32_t> found = out;
  for (int i = 0; i < count; ++i) {
    for (std::uint32_t j = passages[i].begin; j < passages[i].end; j += Simd::kWidth) {
      found.wrote(Simd::storePositions(found.room(), j, onLine(filter, level, j, passages[i].end - j)));
    }
  }
  out = found;
}

/// Row by row: of each slab of cells that the line crosses, the rows that it crosses there, and of each row the cells.
/// Each part is computed from the line itself, not from the part before, so that roundings do not add up (unlike the
/// walk from cell to cell of Ericson 2005, 7.4.2). Rows are searched a few at a time, so that the processor reads one
/// while it still computes another.
void searchLevel(const Level& level, const Line& line, const LineFilter& filter, Output<std::uint32_t>& found) {
  constexpr int kPassages = 32;
  const Level l = level;
  const Grid& grid = l.grid;
  const Track x = trackOf(line, l, grid.axes[0]), y = trackOf(line, l, grid.axes[1]),
              z = trackOf(line, l, grid.axes[2]);
  const Crossing x_in_slab(x, z), y_in_slab(y, z), x_in_row(x, y);
  const Span x_whole = x.whole(), y_whole = y.whole();
  Passage passages[kPassages];
  int count = 0;
  std::int32_t slabs[2], rows[2], cells[2];  // lowest, minus highest
  Simd::store(z.whole(), slabs);
  for (std::int32_t slab = slabs[0]; slab <= -slabs[1]; ++slab) {
    const Span x_here = x_in_slab.within(slab, x_whole);
    Simd::store(y_in_slab.within(slab, y_whole), rows);
    const std::uint32_t* const first = l.start + slab * grid.slab;
    for (std::int32_t row = rows[0]; row <= -rows[1]; ++row) {
      Simd::store(x_in_row.within(row, x_here), cells);
      const std::uint32_t* const start = first + row * grid.row;
      Passage& passage = passages[count];
      passage.begin = start[cells[0]];
      passage.end = start[1 - cells[1]];
      count += passage.begin < passage.end;
      if (count == kPassages) {
        searchPassages(l, filter, passages, count, found);
        count = 0;
      }
    }
  }
  searchPassages(l, filter, passages, count, found);
}

void along(const LevelSet* set, const Line* line, PositionSink* sink) {
  const LineFilter filter = filterOf(*line);
  const Level* const levels = set->levels;
  Output<std::uint32_t> found(sink);
  visitLevels(
      *set,
      [&filter](const Columns& bounds, std::uint32_t j, std::uint32_t count) {
        return onLine(filter, bounds, j, count);
      },
      [&](std::uint32_t number) { searchLevel(levels[number], *line, filter, found); });
  found.close();
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
