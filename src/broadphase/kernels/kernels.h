// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>

// The inner loops of the hgrid, compiled once per instruction set from the one text in kernels_body.h. Nothing in
// this folder includes Eigen or the standard library's templates: an inline copy of theirs that was compiled for a
// newer processor could be picked by the linker for everybody.

namespace hgrid {

enum class Isa : int;

namespace kernels {

constexpr float kMostFloat = 3.402823466e+38f;  ///< the largest finite one

/// Floats are compared with them as they are in Aabb: min x y z, max x y z.
struct Box {
  float min[3], max[3];
};

struct Pair {
  std::uint32_t first, second;
};

/// Maps coordinates to cells: on each axis, number = trunc(clamp(v * inverse - origin, 0, last)). Each of these
/// steps is monotone in v, whatever it rounds, so intervals that overlap have cell numbers that overlap; a window
/// that fits badly costs time, never a pair.
struct Grid {
  float inverse[3];   ///< [1/m] one over the edge of a cell
  float origin[3];    ///< [cells] of the window's lower corner
  float last[3];      ///< number of the last cell
  std::int32_t row;   ///< cells of a row, which lies along axes[0]
  std::int32_t slab;  ///< cells of a slab: rows along axes[1] times row; slabs follow each other along axes[2]
  std::int32_t
      steps[4];          ///< from a cell to the next along x, y, z: 1, row and slab in some order; the last is not used
  std::int32_t axes[3];  ///< 0: x, 1: y, 2: z, in some order
};

/// Boxes as a structure of arrays. Every array can be read 16 places beyond its last box.
struct Columns {
  const float* bounds;  ///< six arrays, `stride` apart: min x y z, max x y z of each box
  std::size_t stride;
};

/// One level of a region of a layer: boxes in the order of their cells. A row of cells is one range of positions.
struct Level : Columns {
  Grid grid;
  float reach[3];       ///< [m] at least the longest side of its boxes, per axis
  float mean_sides[3];  ///< [m] of its boxes, when the cells were planned
  Box around;           ///< all its boxes are within; of no boxes: min > max
  const std::uint32_t* id;     ///< at each position
  const std::uint32_t* start;  ///< of a cell: position of its first box; that of the next cell ends it
  std::uint32_t begin, end;    ///< positions of this level's boxes
};

/// Bounds of levels, or of tiers below: box i of a tier contains boxes kFan * i .. kFan * i + kFan - 1 of the tier below.
struct Tier : Columns {
  static constexpr std::uint32_t kFan = 16;
  std::uint32_t count;
};

/// Levels to search, and a hierarchy of their bounds.
struct LevelSet {
  const Level* levels;
  std::uint32_t count;
  const Tier* tiers;  ///< the first bounds the levels, each other one the tier before it
  int tier_count;     ///< 0: there are no bounds, and every level is searched
};

/// A segment; everything within `around` of it counts.
struct Line {
  double from[3], step[3];  ///< the segment ends at from + step
  double around;
};

/// Where kernels write what they find: they write at `next` and advance it. While fewer than 16 places are left before
/// `limit`, they call `grow`, which makes room.
template <class Found>
struct Sink {
  Found* next;
  Found* limit;
  void* owner;
  void (*grow)(Sink*);
  bool full;  ///< `grow` sets it when nothing more is wanted; a search for pairs then ends soon
};
using PairSink = Sink<Pair>;
using PositionSink = Sink<std::uint32_t>;

/// A part of space with levels of its own. A box belongs to the region that its minimum corner is in.
struct Region {
  float low[3], high[3];              ///< low <= corner < high, per axis; infinite where nothing ends the region
  std::uint32_t first_level, levels;  ///< counted through all regions
};

/// A node of a tree that divides space into regions (a k-d tree, Ericson 2005, 7.3.7).
struct Branch {
  float split;                 ///< corners below it are in the one part, all others in the other part
  std::int32_t axis;           ///< -1: a leaf, which is the region with the number `below`
  std::uint32_t below, above;  ///< numbers of the branches of the two parts
};

/// A sorting of boxes into cells: what the first of two passes of counting needs and gives.
struct Keying {
  const Box* boxes;                  ///< by id
  const std::uint32_t* order;        ///< ids in the order to go through
  std::size_t begin, end;            ///< positions in `order`
  std::size_t readable;              ///< size of `order`; ids up to there may be fetched ahead
  Box* copies;                       ///< out: the boxes by position; may be null
  std::uint32_t* cells;              ///< out: cell by position, counted through all levels
  std::uint32_t* counts;             ///< in and out: boxes per cell
  const Grid* grids;                 ///< per level
  const float* sides;                ///< largest side of each level's boxes; ascending, the last is not looked at
  const std::uint32_t* first_cells;  ///< per level
  int levels;
  float* sizes;              ///< out: 4 floats per level: largest extent on each axis, unspecified
  float lower[4], upper[4];  ///< out: least and greatest minimum corner
  // Only if there are several regions, whose levels follow each other:
  const Region* regions;
  const Branch* branches;  ///< the first is the root
  float* corners;          ///< out: 8 floats per level: least and greatest minimum corner, each in four
};

struct Kernels {
  /// Whether all boxes are finite, with min <= max.
  bool (*sound)(const Box* boxes, std::size_t count);
  /// First pass of counting (Ericson 2005, 7.1.4): the cell of each box.
  void (*key)(Keying* keying);
  /// The same for boxes in several regions.
  void (*keyRegions)(Keying* keying);
  /// Overlapping pairs of one level, each box of positions begin .. end - 1 with those after it.
  void (*pairsWithin)(const Level* level, std::uint32_t begin, std::uint32_t end, PairSink* sink);
  /// Overlapping pairs of the asking level's positions begin .. end - 1 with all boxes of the asked level.
  void (*pairsAcross)(const Level* asking, std::uint32_t begin, std::uint32_t end, const Level* asked, PairSink* sink);
  /// Numbers of the levels whose bounds overlap `box`, ascending.
  void (*reaching)(const LevelSet* set, const Box* box, PositionSink* sink);
  /// Positions of the boxes that overlap `box`, ascending within each level.
  void (*overlapping)(const LevelSet* set, const Box* box, PositionSink* sink);
  /// Positions of boxes near the line: all that come within `around` of it, and a few more.
  void (*along)(const LevelSet* set, const Line* line, PositionSink* sink);
};

/// The loops for an instruction set that isSupported().
const Kernels& of(Isa isa);

const Kernels& portableKernels();
const Kernels& sse2Kernels();
const Kernels& avx2Kernels();
const Kernels& avx512Kernels();
const Kernels& neonKernels();

}  // namespace kernels
}  // namespace hgrid
