// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The algorithm, in the words of one thin layer of vector operations: the including file has defined a type Simd (see
// simd_portable.h for what each operation means) in its own unnamed namespace. No include guard: one text, several
// instruction sets.

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

constexpr int kBlock = 16;  // boxes that look around together; the same for every instruction set

inline std::int32_t cellOf(float value, const Grid& grid, int axis) {
  float cell = value * grid.inverse[axis] - grid.origin[axis];
  cell = cell > 0.0f ? cell : 0.0f;
  cell = cell < grid.last[axis] ? cell : grid.last[axis];
  return static_cast<std::int32_t>(cell);
}

/// cellOf() of 16 values, each moved down by `reach` before. A box of the level that overlaps one with minimum v
/// has its own minimum at v - reach or above, and rounding is monotone, so also its cell.
inline void cellsOf(const float* values, float reach, const Grid& grid, int axis, std::int32_t* cells) {
  const float inverse = grid.inverse[axis], origin = grid.origin[axis], last = grid.last[axis];
  for (int k = 0; k < kBlock; ++k) {
    float cell = (values[k] - reach) * inverse - origin;
    cell = cell > 0.0f ? cell : 0.0f;
    cell = cell < last ? cell : last;
    cells[k] = static_cast<std::int32_t>(cell);
  }
}

/// A sink while a kernel writes to it: kept out of memory, since for all that a compiler knows what is written could
/// change where to write next.
template <class Found>
class Output {
 public:
  explicit Output(Sink<Found>* sink) : sink_(sink), next_(sink->next), limit_(sink->limit) {}
  Found* room() {
    if (__builtin_expect(limit_ - next_ < kBlock, 0)) grow();
    return next_;
  }
  void wrote(Found* end) { next_ = end; }
  void close() { sink_->next = next_; }

 private:
  void __attribute__((noinline)) grow() {
    sink_->next = next_;
    sink_->grow(sink_);
    next_ = sink_->next;
    limit_ = sink_->limit;
  }
  Sink<Found>* sink_;
  Found *next_, *limit_;
};

/// Tests box i of `asking` against `left` positions of `asked` from `begin` on.
inline void meetRange(const Level& asking, std::uint32_t i, const Level& asked, std::uint32_t begin, std::uint32_t left,
                      Output<Pair>& found) {
  const Simd::Box box = Simd::boxAt(asking, i);
  const Simd::Id id = Simd::idAt(asking, i);
  for (;;) {  // nearly always once, so that not even an empty range is worth a question before
    const std::uint32_t hits = Simd::overlaps(box, asked, begin, left);
    found.wrote(Simd::storePairs(found.room(), id, asked.id + begin, hits));
    if (left <= Simd::kWidth) return;
    left -= Simd::kWidth;
    begin += Simd::kWidth;
  }
}

/// For each bit k: box first + k against the cells x_low[k] .. x_high[k] of the row that begins with cell
/// row[k] + offset.
/// Going through bits instead of boxes spares the processor most wrong guesses: whether a box reaches into the next
/// row is a coin toss, how many of sixteen do is not.
inline void meetRows(const Level& asking, std::uint32_t first, std::uint32_t bits, const Level& asked,
                     const std::int32_t* row, std::int32_t offset, const std::int32_t* x_low,
                     const std::int32_t* x_high, Output<Pair>& found) {
  while (bits != 0) {
    const int k = Simd::lowestBit(bits);
    bits &= bits - 1;
    const std::uint32_t begin = asked.start[row[k] + offset + x_low[k]];
    const std::uint32_t end = asked.start[row[k] + offset + x_high[k] + 1];
    if (begin < end) meetRange(asking, first + static_cast<std::uint32_t>(k), asked, begin, end - begin, found);
  }
}

inline std::uint32_t bitsBelow(std::uint32_t count) { return count >= kBlock ? 0xffffu : (1u << count) - 1u; }

/// A box lives in the cell of its minimum corner (Ericson 2005, 7.1.6), so what overlaps it has its cell between
/// those of (minimum - reach) and of its maximum. Each box looks at what comes after it in the order of cells: the
/// rest of its own row up to its maximum, then the later rows from the lower bound on.
void pairsWithin(const Level* level, std::uint32_t begin, std::uint32_t end, PairSink* sink) {
  const Level l = *level;
  const Grid& grid = l.grid;
  Output<Pair> found(sink);
  alignas(64) std::int32_t x_low[kBlock], x_high[kBlock], y_low[kBlock], y_own[kBlock], y_high[kBlock], z_own[kBlock],
      z_high[kBlock], own_row[kBlock], low_row[kBlock], own_span[kBlock], low_span[kBlock], z_span[kBlock];
  for (std::uint32_t first = begin; first < end; first += kBlock) {
    const std::uint32_t all = bitsBelow(end - first);
    cellsOf(l.bounds + first, l.reach[0], grid, 0, x_low);
    cellsOf(l.bounds + 3 * l.stride + first, 0.0f, grid, 0, x_high);
    cellsOf(l.bounds + l.stride + first, l.reach[1], grid, 1, y_low);
    cellsOf(l.bounds + l.stride + first, 0.0f, grid, 1, y_own);
    cellsOf(l.bounds + 4 * l.stride + first, 0.0f, grid, 1, y_high);
    cellsOf(l.bounds + 2 * l.stride + first, 0.0f, grid, 2, z_own);
    cellsOf(l.bounds + 5 * l.stride + first, 0.0f, grid, 2, z_high);
    for (int k = 0; k < kBlock; ++k) {
      own_row[k] = z_own[k] * grid.slab + y_own[k] * grid.row;
      low_row[k] = z_own[k] * grid.slab + y_low[k] * grid.row;
      own_span[k] = y_high[k] - y_own[k];
      low_span[k] = y_high[k] - y_low[k];
      z_span[k] = z_high[k] - z_own[k];
    }
    const std::uint32_t stop = end - first < kBlock ? end - first : kBlock;
    for (std::uint32_t k = 0; k < stop; ++k) {
      const std::uint32_t next = first + k + 1, row_end = l.start[own_row[k] + x_high[k] + 1];
      meetRange(l, first + k, l, next, row_end > next ? row_end - next : 0, found);
    }
    for (std::int32_t y = 1;; ++y) {
      const std::uint32_t bits = Simd::atLeast(own_span, y) & all;
      if (bits == 0) break;
      meetRows(l, first, bits, l, own_row, y * grid.row, x_low, x_high, found);
    }
    for (std::int32_t z = 1;; ++z) {
      const std::uint32_t slab_bits = Simd::atLeast(z_span, z) & all;
      if (slab_bits == 0) break;
      for (std::int32_t y = 0;; ++y) {
        const std::uint32_t bits = Simd::atLeast(low_span, y) & slab_bits;
        if (bits == 0) break;
        meetRows(l, first, bits, l, low_row, z * grid.slab + y * grid.row, x_low, x_high, found);
      }
    }
  }
  found.close();
}

/// A box that asks, and positions that it may overlap.
struct Encounter {
  std::uint32_t box, begin, left;
};

/// Encounters of one level with another. They are collected first and held later: by then what they read, which may be
/// far from what the one before has read, has come into the cache.
class Encounters {
 public:
  Encounters(const Level& asking, const Level& asked) : asking_(asking), asked_(asked) {}

  /// As meetRows() takes them.
  void add(std::uint32_t first, std::uint32_t bits, const std::int32_t* row, std::int32_t offset,
           const std::int32_t* x_low, const std::int32_t* x_high, Output<Pair>& found) {
    if (count_ > kMost - kBlock) hold(found);
    while (bits != 0) {
      const int k = Simd::lowestBit(bits);
      bits &= bits - 1;
      const std::uint32_t begin = asked_.start[row[k] + offset + x_low[k]];
      const std::uint32_t end = asked_.start[row[k] + offset + x_high[k] + 1];
      for (int side = 0; side < 6; ++side) __builtin_prefetch(asked_.bounds + side * asked_.stride + begin);
      encounters_[count_] = {first + static_cast<std::uint32_t>(k), begin, end - begin};
      count_ += begin < end;
    }
  }
  void hold(Output<Pair>& found) {
    for (int i = 0; i < count_; ++i) {
      const Encounter& encounter = encounters_[i];
      meetRange(asking_, encounter.box, asked_, encounter.begin, encounter.left, found);
    }
    count_ = 0;
  }

 private:
  static constexpr int kMost = 256;
  const Level &asking_, &asked_;
  int count_ = 0;
  Encounter encounters_[kMost];
};

/// As above, but all cells from the lower bound on count: the two levels, or layers, have no common order.
void pairsAcross(const Level* asking, std::uint32_t begin, std::uint32_t end, const Level* asked, PairSink* sink) {
  const Level a = *asking, b = *asked;
  const Grid& grid = b.grid;
  Output<Pair> found(sink);
  alignas(64) std::int32_t x_low[kBlock], x_high[kBlock], y_low[kBlock], y_high[kBlock], z_low[kBlock], z_high[kBlock],
      row[kBlock];
  Encounters encounters(a, b);
  for (std::uint32_t first = begin; first < end; first += kBlock) {
    const std::uint32_t all = bitsBelow(end - first);
    cellsOf(a.bounds + first, b.reach[0], grid, 0, x_low);
    cellsOf(a.bounds + 3 * a.stride + first, 0.0f, grid, 0, x_high);
    cellsOf(a.bounds + a.stride + first, b.reach[1], grid, 1, y_low);
    cellsOf(a.bounds + 4 * a.stride + first, 0.0f, grid, 1, y_high);
    cellsOf(a.bounds + 2 * a.stride + first, b.reach[2], grid, 2, z_low);
    cellsOf(a.bounds + 5 * a.stride + first, 0.0f, grid, 2, z_high);
    for (int k = 0; k < kBlock; ++k) {
      row[k] = z_low[k] * grid.slab + y_low[k] * grid.row;
      y_high[k] -= y_low[k];
      z_high[k] -= z_low[k];
    }
    for (std::int32_t z = 0;; ++z) {
      const std::uint32_t slab_bits = Simd::atLeast(z_high, z) & all;
      if (slab_bits == 0) break;
      for (std::int32_t y = 0;; ++y) {
        const std::uint32_t bits = Simd::atLeast(y_high, y) & slab_bits;
        if (bits == 0) break;
        encounters.add(first, bits, row, z * grid.slab + y * grid.row, x_low, x_high, found);
      }
    }
  }
  encounters.hold(found);
  found.close();
}

void overlapping(const Level* level, const Box* box, PositionSink* sink) {
  const Level l = *level;
  const Grid& grid = l.grid;
  std::int32_t low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = cellOf(box->min[axis] - l.reach[axis], grid, axis);
    high[axis] = cellOf(box->max[axis], grid, axis);
  }
  const Simd::Box query = Simd::boxOf(*box);
  Output<std::uint32_t> found(sink);
  for (std::int32_t z = low[2]; z <= high[2]; ++z) {
    for (std::int32_t y = low[1]; y <= high[1]; ++y) {
      const std::int32_t row = z * grid.slab + y * grid.row;
      const std::uint32_t end = l.start[row + high[0] + 1];
      for (std::uint32_t j = l.start[row + low[0]]; j < end; j += Simd::kWidth) {
        found.wrote(Simd::storePositions(found.room(), j, Simd::overlaps(query, l, j, end - j)));
      }
    }
  }
  found.close();
}

/// What decides quickly that a box is off a line: on each of the three axes that are normal to the line and to a
/// side of the box, the distance of the centres against the half-widths (Ericson 2005, 4.4: separating axes), in float
/// with room for its rounding.
struct LineFilter {
  Simd::Lanes way[3], twice_from[3], width[3], slack[3];  // width: |way|, a little more
};

inline double magnitude(double value) { return value < 0.0 ? -value : value; }

inline LineFilter filterOf(const Line& line) {
  double length = 0.0, farthest = line.around;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = magnitude(line.way[axis]), from = magnitude(line.from[axis]);
    length = way > length ? way : length;
    farthest = from + way > farthest ? from + way : farthest;
  }
  const double scale = length > 1e-30 ? 1.0 / length : 0.0;
  LineFilter filter;
  double width[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double way = line.way[axis] * scale;
    width[axis] = magnitude(way) * 1.00001;
    filter.way[axis] = Simd::lanesOf(static_cast<float>(way));
    filter.width[axis] = Simd::lanesOf(static_cast<float>(width[axis]));
    filter.twice_from[axis] = Simd::lanesOf(static_cast<float>(2.0 * line.from[axis]));
  }
  for (int i = 0; i < 3; ++i) {
    const double across = width[(i + 1) % 3] + width[(i + 2) % 3];
    // Where sums of coordinates may not be floats any more nothing is off the line.
    const bool sane = farthest < 1e30;
    filter.slack[i] =
        Simd::lanesOf(sane ? static_cast<float>((2.0 * line.around + 2e-5 * farthest) * across) : __builtin_inff());
  }
  return filter;
}

/// Bits of boxes whose centres are farther from the line, along the axis normal to it and to coordinate i, than their
/// half-widths reach. The other coordinates are j and k.
inline std::uint32_t offAxis(const LineFilter& filter, int i, int j, int k, const Simd::Lanes& away_j,
                             const Simd::Lanes& away_k, const Simd::Lanes& size_j, const Simd::Lanes& size_k) {
  const Simd::Lanes apart = Simd::minus(Simd::times(filter.way[j], away_k), Simd::times(filter.way[k], away_j));
  const Simd::Lanes reach = Simd::plus(
      Simd::plus(Simd::times(size_j, filter.width[k]), Simd::times(size_k, filter.width[j])), filter.slack[i]);
  return Simd::greater(Simd::size(apart), reach);
}

/// Bit k: the box at position j + k is off the line.
inline std::uint32_t offLine(const LineFilter& filter, const Level& level, std::uint32_t j) {
  const float* bounds = level.bounds + j;
  const std::size_t stride = level.stride;
  const Simd::Lanes x0 = Simd::lanesAt(bounds), x1 = Simd::lanesAt(bounds + 3 * stride);
  const Simd::Lanes y0 = Simd::lanesAt(bounds + stride), y1 = Simd::lanesAt(bounds + 4 * stride);
  const Simd::Lanes z0 = Simd::lanesAt(bounds + 2 * stride), z1 = Simd::lanesAt(bounds + 5 * stride);
  const Simd::Lanes x = Simd::minus(Simd::plus(x0, x1), filter.twice_from[0]), w = Simd::minus(x1, x0);
  const Simd::Lanes y = Simd::minus(Simd::plus(y0, y1), filter.twice_from[1]), d = Simd::minus(y1, y0);
  const Simd::Lanes z = Simd::minus(Simd::plus(z0, z1), filter.twice_from[2]), h = Simd::minus(z1, z0);
  return offAxis(filter, 2, 0, 1, x, y, w, d) | offAxis(filter, 0, 1, 2, y, z, d, h) |
         offAxis(filter, 1, 2, 0, z, x, h, w);
}

/// Where a line is on an axis.
struct Extent {
  double min, max;
};

inline float floatBelow(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest - static_cast<float>(magnitude(static_cast<double>(nearest))) * 1.2e-7f - 1e-37f;
}
inline float floatAbove(double value) { return -floatBelow(-value); }

/// The box around a line.
inline Box boxAround(const Line& line) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = line.from[axis], to = from + line.way[axis];
    box.min[axis] = floatBelow((from < to ? from : to) - line.around);
    box.max[axis] = floatAbove((from < to ? to : from) + line.around);
  }
  return box;
}

/// A line on one axis of a level, all in cells. A box of cell c can be met only while the line is within
/// c - below .. c + 1 + above; the outermost cells hold all that is beyond them, too.
struct Track {
  double from, way, below, above;
  std::int32_t last;

  Extent whole() const { return way > 0.0 ? Extent{from, from + way} : Extent{from + way, from}; }
  std::int32_t lowest(Extent extent) const { return clamped(extent.min - above); }
  std::int32_t highest(Extent extent) const { return clamped(extent.max + below); }

 private:
  std::int32_t clamped(double cell) const {
    cell = cell > 0.0 ? cell : 0.0;
    const double most = last;
    return static_cast<std::int32_t>(cell < most ? cell : most);
  }
};

inline Track trackOf(const Line& line, const Level& level, int axis) {
  const double inverse = static_cast<double>(level.grid.inverse[axis]);
  const double origin = static_cast<double>(level.grid.origin[axis]), last = static_cast<double>(level.grid.last[axis]);
  Track track;
  track.from = line.from[axis] * inverse - origin;
  track.way = line.way[axis] * inverse;
  // The boxes' cells were rounded in float, what is computed here in double.
  const double rounded =
      1e-6 * (magnitude(origin) + last + 1.0) + 1e-9 * (magnitude(track.way) + magnitude(track.from));
  track.below = line.around * inverse + rounded;
  track.above = track.below + static_cast<double>(level.reach[axis]) * inverse;
  track.last = static_cast<std::int32_t>(level.grid.last[axis]);
  return track;
}

/// Where a line is on one axis while it passes a cell of another.
class Crossing {
 public:
  Crossing(const Track& on, const Track& passing)
      : from_(on.from),
        passing_(passing),
        // What hardly moves on the other axis passes a cell all its way.
        slope_(magnitude(passing.way) > 1e-3 ? on.way / passing.way : 0.0),
        unbounded_(slope_ > 0.0 ? 1e300 : -1e300) {}

  Extent within(std::int32_t cell, Extent extent) const {
    if (slope_ == 0.0) return extent;
    const double enter = from_ + slope_ * (cell - passing_.below - passing_.from);
    const double leave = from_ + slope_ * (cell + 1.0 + passing_.above - passing_.from);
    const double a = cell == 0 ? -unbounded_ : enter, b = cell == passing_.last ? unbounded_ : leave;
    const double min = a < b ? a : b, max = a < b ? b : a;
    return {min > extent.min ? min : extent.min, max < extent.max ? max : extent.max};
  }

 private:
  double from_;
  const Track& passing_;
  double slope_, unbounded_;
};

/// Positions of a row of cells that a line passes.
struct Passage {
  std::uint32_t begin, end;
};

inline void searchPassages(const Level& level, const Simd::Box& box, const LineFilter& filter, const Passage* passages,
                           int count, Output<std::uint32_t>& found) {
  for (int i = 0; i < count; ++i) {
    for (std::uint32_t j = passages[i].begin; j < passages[i].end; j += Simd::kWidth) {
      const std::uint32_t hits = Simd::overlaps(box, level, j, passages[i].end - j) & ~offLine(filter, level, j);
      found.wrote(Simd::storePositions(found.room(), j, hits));
    }
  }
}

/// Row by row: of each slab of cells that the line crosses, the rows that it crosses there, and of each row the cells.
/// Each part is computed from the line itself, not from the part before, so that roundings do not add up (unlike the
/// walk from cell to cell of Ericson 2005, 7.4.2). Rows are searched a few at a time, so that the processor reads one
/// while it still computes another.
void along(const Level* level, const Line* line, PositionSink* sink) {
  constexpr int kPassages = 32;
  const Level l = *level;
  const Grid& grid = l.grid;
  if (l.begin == l.end) return;
  Output<std::uint32_t> found(sink);
  const LineFilter filter = filterOf(*line);
  const Simd::Box box = Simd::boxOf(boxAround(*line));
  const Track x = trackOf(*line, l, 0), y = trackOf(*line, l, 1), z = trackOf(*line, l, 2);
  const Crossing x_in_slab(x, z), y_in_slab(y, z), x_in_row(x, y);
  Passage passages[kPassages];
  int count = 0;
  const std::int32_t z_highest = z.highest(z.whole());
  for (std::int32_t slab = z.lowest(z.whole()); slab <= z_highest; ++slab) {
    const Extent x_here = x_in_slab.within(slab, x.whole()), y_here = y_in_slab.within(slab, y.whole());
    const std::int32_t y_highest = y.highest(y_here);
    for (std::int32_t row = y.lowest(y_here); row <= y_highest; ++row) {
      const Extent passed = x_in_row.within(row, x_here);
      const std::uint32_t* const start = l.start + slab * grid.slab + row * grid.row;
      Passage& passage = passages[count];
      passage.begin = start[x.lowest(passed)];
      passage.end = start[x.highest(passed) + 1];
      count += passage.begin < passage.end;
      if (count == kPassages) {
        searchPassages(l, box, filter, passages, count, found);
        count = 0;
      }
    }
  }
  searchPassages(l, box, filter, passages, count, found);
  found.close();
}

bool sound(const Box* boxes, std::size_t count) {
  bool sound = true;
  for (std::size_t i = 0; i < count; ++i) sound = sound & Simd::isSound(boxes[i]);
  return sound;
}

/// The boxes are visited in the order that they had last time, which is nearly that of their cells: counts and
/// copies are written almost in sequence, and the one random access, to the boxes by id, is fetched ahead.
void key(Keying* keying) {
  constexpr std::size_t kAhead = 32;
  constexpr int kMostLevels = 17;
  Keying& k = *keying;
  Simd::Quad largest[kMostLevels], lower = Simd::quadOf(k.lower), upper = Simd::quadOf(k.upper);
  for (int level = 0; level < k.levels; ++level) largest[level] = Simd::quadOf(k.sizes + 4 * level);
  for (std::size_t i = k.begin; i < k.end; ++i) {
    const char* ahead = reinterpret_cast<const char*>(k.boxes + k.order[i + kAhead < k.readable ? i + kAhead : i]);
    __builtin_prefetch(ahead);
    __builtin_prefetch(ahead + sizeof(Box) - 1);
    const Box& box = k.boxes[k.order[i]];
    if (k.copies != nullptr) k.copies[i] = box;
    const Simd::Quad min = Simd::minimaOf(box), size = Simd::minus(Simd::maximaOf(box), min);
    lower = Simd::least(lower, min);
    upper = Simd::greatest(upper, min);
    int level = 0;
    if (k.levels > 1) {
      const float side = Simd::greatestOfThree(size);
      while (level + 1 < k.levels && side > k.sides[level]) ++level;
    }
    largest[level] = Simd::greatest(largest[level], size);
    const Grid& grid = k.grids[level];
    std::int32_t cell[4];
    Simd::cellsOf(min, grid, cell);
    const std::uint32_t number =
        k.first_cells[level] + static_cast<std::uint32_t>(cell[2] * grid.slab + cell[1] * grid.row + cell[0]);
    k.cells[i] = number;
    ++k.counts[number];
  }
  for (int level = 0; level < k.levels; ++level) Simd::store(largest[level], k.sizes + 4 * level);
  Simd::store(lower, k.lower);
  Simd::store(upper, k.upper);
}

constexpr Kernels kKernels = {sound, key, pairsWithin, pairsAcross, overlapping, along};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
