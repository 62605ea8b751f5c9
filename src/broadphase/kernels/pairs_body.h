// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Finds the pairs of overlapping boxes within one level and between two levels.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"
#include "broadphase/kernels/output_body.h"

namespace hgrid {
namespace kernels {
namespace {

/// Computes the cells, along one axis, of the coordinates (bound - reach) of 16 boxes from `position` on.
///
/// Reason: a box that overlaps a box with minimum v has its own minimum at v - reach or above. Rounding is monotone, so
/// the cell of this box is not below the cell of v - reach.
/// @param side  which bound of the boxes: 0 for the minimum, 3 for the maximum
inline void cellsOf(const Level& level, std::uint32_t position, int side, float reach, const Grid& grid, int axis,
                    std::int32_t* cells) {
  const float* const values = level.bounds + static_cast<std::size_t>(side + axis) * level.stride + position;
  const float inverse = grid.inverse[axis], origin = grid.origin[axis], last = grid.last[axis];
  for (int k = 0; k < kBlock; ++k) {
    float cell = (values[k] - reach) * inverse - origin;
    cell = cell > 0.0f ? cell : 0.0f;
    cell = cell < last ? cell : last;
    cells[k] = static_cast<std::int32_t>(cell);
  }
}

/// Tests box i of `asking` against `left` boxes of `asked` from position `begin` on; `left` is at least 1. This
/// function is always inlined, because calls would take about a tenth of the time of a search.
/// @tparam kRare  whether hits are so rare that a branch around their output is predicted well; if false, the output is
///                stored unconditionally
template <bool kRare = false>
inline __attribute__((always_inline)) void meetRange(const Level& asking, std::uint32_t i, const Level& asked,
                                                     std::uint32_t begin, std::uint32_t left, Output<Pair>& found) {
  const Simd::Box box = Simd::boxAt(asking, i);
  const Simd::Id id = Simd::idAt(asking, i);
  for (;;) {  // mostly one iteration
    const std::uint32_t hits = Simd::overlaps(box, asked, begin, left);
    if (!kRare || __builtin_expect(hits != 0, 0)) {
      found.wrote(Simd::storePairs(found.room(), id, asked.id + begin, hits));
    }
    if (left <= Simd::kWidth) return;
    left -= Simd::kWidth;
    begin += Simd::kWidth;
  }
}

/// For each bit k that is set, tests box first + k against the boxes of one row of cells. The row begins with the cell
/// row[k] + offset. The boxes in the cells x_low[k] .. x_high[k] of the row are tested. A loop over bits causes fewer
/// branch mispredictions than a loop over 16 boxes with a branch for each box.
template <bool kRare>
inline void meetRows(const Level& asking, std::uint32_t first, std::uint32_t bits, const Level& asked,
                     const std::int32_t* row, std::int32_t offset, const std::int32_t* x_low,
                     const std::int32_t* x_high, Output<Pair>& found) {
  while (bits != 0) {
    const int k = Simd::lowestBit(bits);
    bits &= bits - 1;
    const std::uint32_t begin = asked.start[row[k] + offset + x_low[k]];
    const std::uint32_t end = asked.start[row[k] + offset + x_high[k] + 1];
    if (begin < end) meetRange<kRare>(asking, first + static_cast<std::uint32_t>(k), asked, begin, end - begin, found);
  }
}

/// Tests the boxes of a block against their followers: the boxes that follow them in their rows of cells. Box first + k
/// has left[k] followers, the next left[k] boxes.
///
/// In step `ahead`, tests each box against the box `ahead` positions after it, kWidth boxes at once. The positions of
/// these boxes are successive, so they are loaded together. When only few boxes of the block have followers left, tests
/// the followers of one box after the other, kWidth followers at once.
/// @param all  bit k: whether the block has box first + k
template <bool kRare>
inline __attribute__((always_inline)) void meetFollowing(const Level& level, std::uint32_t first, std::uint32_t all,
                                                         const std::int32_t* left, Output<Pair>& found) {
  // In the first kNear steps, few boxes are at most kFewNear, then kFewFar. The values were measured.
  constexpr std::uint32_t kNear = 8;
  constexpr int kFewNear = 2, kFewFar = 11;
  constexpr std::uint32_t kParts = kBlock / Simd::kWidth;
  Simd::Boxes boxes[kParts];
  for (std::uint32_t part = 0; part < kParts; ++part) boxes[part] = Simd::boxesAt(level, first + part * Simd::kWidth);
  for (std::uint32_t ahead = 1;; ++ahead) {
    std::uint32_t open = Simd::atLeast(left, static_cast<std::int32_t>(ahead)) & all;
    if (__builtin_popcount(open) <= (ahead <= kNear ? kFewNear : kFewFar)) {
      for (; open != 0; open &= open - 1) {
        const auto k = static_cast<std::uint32_t>(Simd::lowestBit(open));
        meetRange<kRare>(level, first + k, level, first + k + ahead, static_cast<std::uint32_t>(left[k]) + 1 - ahead,
                         found);
      }
      return;
    }
    for (std::uint32_t part = 0; part < kParts; ++part) {
      const std::uint32_t i = first + part * Simd::kWidth;
      const std::uint32_t hits =
          Simd::overlaps(boxes[part], level, i + ahead, Simd::kWidth) & (open >> (part * Simd::kWidth));
      if (!kRare || __builtin_expect(hits != 0, 0)) {
        found.wrote(Simd::storePairsOfEach(found.room(), level.id + i, level.id + i + ahead, hits));
      }
    }
  }
}

inline std::uint32_t bitsBelow(std::uint32_t count) { return count >= kBlock ? 0xffffu : (1u << count) - 1u; }

/// The cells that the boxes of a block are tested in. A row of cells is given as the index of its first cell.
struct BlockCells {
  std::int32_t x_low[kBlock], x_high[kBlock];      // cells of (minimum - reach) and of the maximum, in a row
  std::int32_t own_row[kBlock], own_span[kBlock];  // row of the minimum corner; number of rows after it, in its slab
  std::int32_t low_row[kBlock], low_span[kBlock];  // the same for (minimum - reach) on y, and the minimum on z
  std::int32_t z_span[kBlock];                     // number of slabs after the own slab

  /// Computes the cells of the boxes from position `first` on.
  __attribute__((always_inline)) void compute(const Level& level, std::uint32_t first) {
    const Grid& grid = level.grid;
    const int x = grid.axes[0], y = grid.axes[1], z = grid.axes[2];  // x is the axis of the rows
    alignas(64) std::int32_t y_low[kBlock], y_own[kBlock], y_high[kBlock], z_own[kBlock], z_high[kBlock];
    cellsOf(level, first, 0, level.reach[x], grid, x, x_low);
    cellsOf(level, first, 3, 0.0f, grid, x, x_high);
    cellsOf(level, first, 0, level.reach[y], grid, y, y_low);
    cellsOf(level, first, 0, 0.0f, grid, y, y_own);
    cellsOf(level, first, 3, 0.0f, grid, y, y_high);
    cellsOf(level, first, 0, 0.0f, grid, z, z_own);
    cellsOf(level, first, 3, 0.0f, grid, z, z_high);
    for (int k = 0; k < kBlock; ++k) {
      own_row[k] = z_own[k] * grid.slab + y_own[k] * grid.row;
      low_row[k] = z_own[k] * grid.slab + y_low[k] * grid.row;
      own_span[k] = y_high[k] - y_own[k];
      low_span[k] = y_high[k] - y_low[k];
      z_span[k] = z_high[k] - z_own[k];
    }
  }
  /// Works like compute() if the level has one row. Sets only `x_high` and `own_row`; the others are not needed then.
  __attribute__((always_inline)) void computeInOneRow(const Level& level, std::uint32_t first) {
    const int x = level.grid.axes[0];
    cellsOf(level, first, 3, 0.0f, level.grid, x, x_high);
    for (std::int32_t& row : own_row) row = 0;
  }
};

/// Tests the boxes of a block against the boxes in the rows after their own rows.
template <bool kRare>
inline __attribute__((always_inline)) void meetLaterRows(const Level& level, std::uint32_t first, std::uint32_t all,
                                                         const BlockCells& cells, Output<Pair>& found) {
  const Grid& grid = level.grid;
  for (std::int32_t rows = 1;; ++rows) {
    const std::uint32_t bits = Simd::atLeast(cells.own_span, rows) & all;
    if (bits == 0) break;
    meetRows<kRare>(level, first, bits, level, cells.own_row, rows * grid.row, cells.x_low, cells.x_high, found);
  }
  for (std::int32_t slabs = 1;; ++slabs) {
    const std::uint32_t slab_bits = Simd::atLeast(cells.z_span, slabs) & all;
    if (slab_bits == 0) break;
    for (std::int32_t rows = 0;; ++rows) {
      const std::uint32_t bits = Simd::atLeast(cells.low_span, rows) & slab_bits;
      if (bits == 0) break;
      meetRows<kRare>(level, first, bits, level, cells.low_row, slabs * grid.slab + rows * grid.row, cells.x_low,
                      cells.x_high, found);
    }
  }
}

/// A box is stored in the cell of its minimum corner (Ericson 2005, 7.1.6). So all boxes that overlap a given box are
/// in the cells from the cell of (minimum - reach) to the cell of the maximum of the given box. Each box is tested only
/// against the boxes that follow it in the order of cells. These are the rest of its own row up to its maximum, and
/// then the later rows, each from the cell of (minimum - reach) on.
///
/// Searches block by block, until a block has many hits (if kRare) or none (if not).
/// @returns where the next block begins
template <bool kRare>
std::uint32_t __attribute__((noinline))
searchBlocks(const Level& level, std::uint32_t begin, std::uint32_t end, Output<Pair>& out) {
  constexpr std::uintptr_t kMany = 2 * sizeof(Pair);  // output of a block that has not many hits [bytes]
  const Level l = level;
  const bool is_one_row = l.grid.rows == 1;
  Output<Pair> found = out;  // a local copy, which the compiler can keep in registers
  alignas(64) BlockCells cells;
  alignas(64) std::int32_t left[kBlock];
  std::uint32_t first = begin;
  for (bool same = true; same && first < end && !found.full(); first += kBlock) {
    const std::uintptr_t before = found.address();
    const std::uint32_t all = bitsBelow(end - first);
    if (is_one_row) {
      cells.computeInOneRow(l, first);
    } else {
      cells.compute(l, first);
    }
    // For a withdrawn box, x_high is 0, so it has at most the followers in the first cell. Its maxima are NaN, so it
    // overlaps none of them.
    for (int k = 0; k < kBlock; ++k) {
      left[k] = static_cast<std::int32_t>(l.start[cells.own_row[k] + cells.x_high[k] + 1] - first) - k - 1;
    }
    meetFollowing<kRare>(l, first, all, left, found);
    if (!is_one_row) meetLaterRows<kRare>(l, first, all, cells, found);
    // If the buffer has a new address, the difference means nothing. That only affects the speed.
    const std::uintptr_t wrote = found.address() - before;
    same = kRare ? wrote <= kMany : wrote > 0;
  }
  out = found;
  return first;
}

void pairsWithin(const Level* level, std::uint32_t begin, std::uint32_t end, PairSink* sink) {
  Output<Pair> found(sink);
  const bool is_one_cell = level->grid.row == 1 && level->grid.rows == 1;
  if (is_one_cell && level->end - level->begin <= kBlock) {  // each box may meet each later one
    for (std::uint32_t i = begin; i < end && i + 1 < level->end; ++i) {
      meetRange(*level, i, *level, i + 1, level->end - i - 1, found);
    }
    return found.close();
  }
  for (bool rare = false; begin < end && !found.full(); rare = !rare) {
    begin = rare ? searchBlocks<true>(*level, begin, end, found) : searchBlocks<false>(*level, begin, end, found);
  }
  found.close();
}

/// One box of a level, and a range of positions in another level. The boxes at these positions may overlap the one box.
struct Encounter {
  std::uint32_t box, begin, left;
};

/// Encounters of boxes of one level with boxes of another level. They are collected first and tested later. Meanwhile
/// the processor loads the boxes into the cache, because they may be far apart in memory.
class Encounters {
 public:
  Encounters(const Level& asking, const Level& asked) : asking_(asking), asked_(asked) {}

  /// Adds the encounters of several boxes with one row of cells each. The parameters are those of meetRows().
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
  /// Tests the collected encounters and removes them.
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

/// Works like pairsWithin(), but on each axis all cells from the cell of (minimum - reach) on are searched. The reason:
/// the boxes of two levels or layers have no common order.
void pairsAcross(const Level* asking, std::uint32_t begin, std::uint32_t end, const Level* asked, PairSink* sink) {
  const Level a = *asking, b = *asked;
  const Grid& grid = b.grid;
  const int x = grid.axes[0], y = grid.axes[1], z = grid.axes[2];
  Output<Pair> found(sink);
  alignas(64) std::int32_t x_low[kBlock], x_high[kBlock], y_low[kBlock], y_high[kBlock], z_low[kBlock], z_high[kBlock],
      row[kBlock];
  Encounters encounters(a, b);
  for (std::uint32_t first = begin; first < end && !found.full(); first += kBlock) {
    const std::uint32_t all = bitsBelow(end - first);
    cellsOf(a, first, 0, b.reach[x], grid, x, x_low);
    cellsOf(a, first, 3, 0.0f, grid, x, x_high);
    cellsOf(a, first, 0, b.reach[y], grid, y, y_low);
    cellsOf(a, first, 3, 0.0f, grid, y, y_high);
    cellsOf(a, first, 0, b.reach[z], grid, z, z_low);
    cellsOf(a, first, 3, 0.0f, grid, z, z_high);
    for (int k = 0; k < kBlock; ++k) {
      row[k] = z_low[k] * grid.slab + y_low[k] * grid.row;
      y_high[k] -= y_low[k];
      z_high[k] -= z_low[k];
    }
    for (std::int32_t slabs = 0;; ++slabs) {
      const std::uint32_t slab_bits = Simd::atLeast(z_high, slabs) & all;
      if (slab_bits == 0) break;
      for (std::int32_t rows = 0;; ++rows) {
        const std::uint32_t bits = Simd::atLeast(y_high, rows) & slab_bits;
        if (bits == 0) break;
        encounters.add(first, bits, row, slabs * grid.slab + rows * grid.row, x_low, x_high, found);
      }
    }
  }
  encounters.hold(found);
  found.close();
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
