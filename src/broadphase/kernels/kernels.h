// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>

// The inner loops of the hgrid, called kernels (kernels_body.h). The same source is compiled once per instruction set.
// The files in this folder include neither Eigen nor templates of the standard library. Inline functions of these would
// be compiled for several instruction sets, and the linker could choose code that the processor does not support.
//
// The "position" of a box is its index in the arrays of its layer (see Layer).

namespace hgrid {

enum class Isa : int;

namespace kernels {

constexpr float kMostFloat = 3.402823466e+38f;  ///< the largest finite float

/// An axis-aligned box [m] with the memory layout of Aabb: min x y z, max x y z.
struct Box {
  float min[3], max[3];
};

/// The ids of two overlapping boxes, with the memory layout of ProxyPair.
struct Pair {
  std::uint32_t first, second;
};

/// Maps coordinates to cells. The window is the part of space that is divided into cells. The outermost cells also hold
/// the boxes outside the window.
///
/// On each axis, the index of the cell that contains coordinate v is trunc(clamp(v * inverse - origin, 0, last)). Each
/// of these steps is monotone in v, in spite of rounding. So if two intervals overlap, their ranges of cells overlap. A
/// window that fits the boxes badly makes a search slower, but the search never misses a pair.
struct Grid {
  float inverse[3];   ///< [1/m] reciprocal of the edge of a cell
  float origin[3];    ///< [cells] lower corner of the window, divided by the edge of a cell
  float last[3];      ///< index of the last cell along the axis; the first cell has the index 0
  std::int32_t row;   ///< number of cells in a row; rows lie along axes[0]
  std::int32_t slab;  ///< number of cells in a slab; a slab consists of rows that follow each other along axes[1]
  /// Difference of the indices of neighboring cells along x, y, z: 1, `row` and `slab` in some order. The last value is
  /// not used.
  std::int32_t steps[4];
  std::int32_t axes[3];  ///< 0 (x), 1 (y) and 2 (z) in some order; slabs follow each other along axes[2]
  std::int32_t rows;     ///< number of rows of all slabs
};

/// Boxes as a structure of arrays. Each array must have room for 16 values after the last box, because kernels may read
/// them.
struct Columns {
  const float* bounds;  ///< [m] six arrays, `stride` floats apart: min x, min y, min z, max x, max y, max z
  std::size_t stride;
};

/// One level of a region of a layer. Its boxes are sorted by cell. So the boxes in a row of cells are one range of
/// positions.
struct Level : Columns {
  Grid grid;
  float reach[3];              ///< [m] per axis: the longest side of the level's boxes, rounded up
  float mean_sides[3];         ///< [m] per axis: mean side of the boxes when the cells were planned
  Box around;                  ///< contains all boxes of the level; min > max if there are none
  const std::uint32_t* id;     ///< id of the box at each position
  const std::uint32_t* start;  ///< per cell: position of its first box; the next entry is the end of its boxes
  std::uint32_t begin, end;    ///< range of positions of the level's boxes
};

/// One tier of a hierarchy of boxes. LevelSet says what the first tier bounds. Box i of any other tier
/// contains boxes kFan * i .. kFan * i + kFan - 1 of the tier below it.
struct Tier : Columns {
  static constexpr std::uint32_t kFan = 16;
  std::uint32_t count;  ///< number of boxes
};

/// Levels to search, and a hierarchy of bounds. The boxes of its first tier are called leaves. They are the bounds of
/// the levels. If there is only one level, they may be the bounds of its successive boxes instead.
struct LevelSet {
  const Level* levels;
  std::uint32_t count;
  const Tier* tiers;  ///< each tier except the first bounds the tier before it
  int tier_count;     ///< number of tiers; if it is 0, every level is searched
  /// 0: leaf i is the bounds of level i. Otherwise there is one level, and leaf i contains the boxes of this level from
  /// position per_leaf * i on, at most per_leaf of them.
  std::uint32_t per_leaf;
};

/// A segment with a radius `around` [m]. A search along it finds the boxes within this distance of the segment.
struct Line {
  double from[3], step[3];  ///< [m] the segment starts at `from` and ends at from + step
  double around;
};

/// A buffer that kernels write their results to. They write at `next` and advance `next`. If fewer than 16 places are
/// left before `limit`, they first call `grow`, and `grow` makes room.
template <class Found>
struct Sink {
  Found* next;
  Found* limit;
  void* owner;  ///< the object that owns the buffer; only `grow` uses it
  void (*grow)(Sink*);
  bool full;  ///< `grow` sets this to true if no more results are needed; a search for pairs then ends soon
};
using PairSink = Sink<Pair>;
using PositionSink = Sink<std::uint32_t>;

/// A part of space with levels of its own. A box belongs to the region that contains its minimum corner.
struct Region {
  float low[3], high[3];      ///< [m] low <= corner < high, per axis; infinite where the region has no border
  std::uint32_t first_level;  ///< index of its first level among the levels of all regions
  std::uint32_t levels;       ///< number of its levels
};

/// A node of the k-d tree that divides space into regions (Ericson 2005, 7.3.7).
struct Branch {
  float split;                 ///< [m] corners with a smaller coordinate are in the part `below`, all others in `above`
  std::int32_t axis;           ///< axis of the split; -1: the node is a leaf, and `below` is the index of a region
  std::uint32_t below, above;  ///< indices of the nodes of the two parts
};

/// The shape of a box is a number: bit i is set if the box is long on axis i, which means that its side there is at
/// least 1 / kLongRatio of its longest side.
constexpr int kShapes = 8;
constexpr float kLongRatio = 4.0f;

/// Input and output of the first pass of a counting sort. The pass finds the cell of each box and counts the boxes of
/// each cell. "By position" means here: in the order of `order`.
struct Keying {
  const Box* boxes;            ///< in: all boxes, by id
  const std::uint32_t* order;  ///< in: ids in the order in which the boxes are visited
  std::size_t begin, end;      ///< in: range of positions in `order` that are visited
  std::size_t readable;        ///< in: size of `order`; ids before it may be prefetched
  Box* copies;                 ///< out: copies of the boxes, by position; null if not needed
  std::uint32_t* cells;        ///< out: for each box the index of its cell, by position
  std::uint32_t* counts;       ///< in and out: number of boxes per cell
  const Grid* grids;           ///< in: the grid of each level
  const float* sides;          ///< in: [m] longest side per level, ascending in a region; the last is not read, and
                               ///< none is if level_of_shape is not null
  const std::uint32_t* first_cells;  ///< in: for each level the index of its first cell
  int levels;                        ///< in: number of levels
  /// in: the level of each of the kShapes shapes; null: the longest side of a box selects its level. keyRegions() does
  /// not use it.
  const std::uint8_t* level_of_shape;
  float* sizes;              ///< in and out: [m] 4 floats per level: longest side on x, y, z; 4th unused
  float lower[4], upper[4];  ///< in and out: [m] bounds of the minimum corners; not used by keyRegions()
  // The following members are only used by keyRegions(). The levels are stored region after region.
  const Region* regions;
  const Branch* branches;  ///< in: the first one is the root
  float* corners;          ///< in and out: [m] 8 floats per level: lower (4) and upper (4) bounds of minimum corners
};

/// The inner loops, compiled for one instruction set.
struct Kernels {
  /// Returns whether all boxes are finite, with min <= max.
  bool (*sound)(const Box* boxes, std::size_t count);
  /// First pass of a counting sort (Ericson 2005, 7.1.4): finds the cell of each box and counts the boxes per cell.
  void (*key)(Keying* keying);
  /// Works like key(), but for a layer with several regions.
  void (*keyRegions)(Keying* keying);
  /// Finds the overlapping pairs of one level. Tests each box at positions begin .. end - 1 against the boxes after it.
  void (*pairsWithin)(const Level* level, std::uint32_t begin, std::uint32_t end, PairSink* sink);
  /// Finds the overlapping pairs of two levels. Tests the boxes of `asking` at positions begin .. end - 1 against all
  /// boxes of `asked`.
  void (*pairsAcross)(const Level* asking, std::uint32_t begin, std::uint32_t end, const Level* asked, PairSink* sink);
  /// Finds the levels whose bounds overlap `box`. Writes their indices in ascending order. per_leaf must be 0.
  void (*reaching)(const LevelSet* set, const Box* box, PositionSink* sink);
  /// Finds the boxes that overlap `box`. Writes their positions, in ascending order within each level.
  void (*overlapping)(const LevelSet* set, const Box* box, PositionSink* sink);
  /// Finds all boxes within the radius `around` of a line, and a few boxes more. Writes their positions.
  void (*along)(const LevelSet* set, const Line* line, PositionSink* sink);
};

/// Returns the inner loops for an instruction set. isSupported(isa) must be true.
const Kernels& of(Isa isa);

const Kernels& portableKernels();
const Kernels& sse2Kernels();
const Kernels& avx2Kernels();
const Kernels& avx512Kernels();
const Kernels& neonKernels();

}  // namespace kernels
}  // namespace hgrid
