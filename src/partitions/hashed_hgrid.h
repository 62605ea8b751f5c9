// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "partitions/cell_scale.h"
#include "partitions/id_set.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// The hierarchical grid of the book: all levels in one hash table (Ericson, Real-Time Collision Detection, 2005,
/// section 7.2.1).
///
/// The cells of each level are twice as long as those of the level below. A box is on the lowest level whose cells are
/// at least four times as long as its longest side, in the cell that contains its center. So center and size alone
/// say where a box is, and a box is in one cell only. A bucket of the table is a linked list of the boxes of all cells
/// that the hash maps to it; no key is compared. A mask tells which levels hold boxes, and a search skips all others.
///
/// The words of the book, and where they are here:
///
/// | book | here |
/// | --- | --- |
/// | `HGrid` | HashedHGrid |
/// | `occupiedLevelsMask`, `objectsAtLevel` | occupied_levels_, on_level_ |
/// | `objectBucket`, `NUM_BUCKETS` | object_bucket_ and its size |
/// | `timeStamp`, `tick` | `time_stamps` (Stamps) |
/// | `Object` with `pNextObject`, `bucket`, `level` | Object |
/// | `pos`, `radius` of an object | center of the box; half of its longest side |
/// | `SPHERE_TO_CELL_RATIO`, `CELL_TO_CELL_RATIO` | kSizeToCell, and the power of 2 in scaleOf() |
/// | `MIN_CELL_SIZE`, `HGRID_MAX_LEVELS` | finest_, kMostLevels |
/// | `ComputeHashBucketIndex` | bucketOf() |
/// | `AddObjectToHGrid`, `RemoveObjectFromHGrid` | added(), removed() |
/// | `CheckObjAgainstGrid` | candidates() for one object, findPairs() for all |
/// | `pCallbackFunc` | `visit` of visitLevel() |
///
/// Differs from the listing:
/// - Boxes in place of spheres, and three dimensions. The level is added to the hash of the cell.
/// - The index of a cell rounds down everywhere. The listing truncates toward zero when it inserts.
/// - The finest cells follow from the smallest box, and the number of buckets from the number of boxes. A box that is
///   too long for the coarsest level is in a list.
/// - Lists are linked in both directions, so removal takes constant time, which the book recommends.
/// - A search looks as far beyond the query as half of the longest side that a box of the level can have; the listing
///   looks twice as far. In place of the constant EPSILON, bounds are rounded outward: a small constant added to a
///   large coordinate may not change it.
/// - **Large queries.** The listing visits each cell that the query covers. On a level of small cells, these can be far
///   more than there are boxes. Here each level has a list of its boxes. A search goes through this list if it would
///   otherwise visit more cells than the list has boxes.
/// - The search for all pairs finds each pair once: a box looks at its own level and at all coarser ones, as the book
///   says, and of two boxes on the same level the one with the smaller id reports the pair.
/// - A search stamps buckets anew on each level, and leaves out the boxes of other levels in them, because it must know
///   the level of each box that it meets. It looks at each bit of the mask, and does not end at the highest one.
/// - Stamps have 64 bits and are kept per thread, so several threads can search (stamps.h).
/// - A box that moves within its bucket stays in its list.
/// - Segments go through each level by layers of cells, see CellScale::visitRanges() (section 7.4.2).
class HashedHGrid final : public Partition {
 public:
  HashedHGrid() : Partition("HashedHGrid") {}

 private:
  static constexpr int kMostLevels = 32;           // one bit each in occupied_levels_
  static constexpr double kSizeToCell = 0.25;      // longest side of a box, at most, as a part of its cell's edge
  static constexpr ProxyId kNobody = 0xffffffffu;  // ends a list

  /// What the grid knows of one box.
  struct Object {
    ProxyId next = kNobody, previous = kNobody;  // neighbors in the list of the bucket
    std::uint32_t bucket = 0;
    int level = kMostLevels;  // kMostLevels: the box is in no cell, but in oversized_
    std::uint32_t place = 0;  // index of the box in on_level_[level]
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  void findPairs(PairSink& sink) const override;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  /// The cells of a level.
  CellScale scaleOf(int level) const { return CellScale(finest_ * static_cast<double>(std::uint64_t{1} << level)); }
  /// The longest side [m] of a box on this level.
  double mostSideOn(int level) const { return kSizeToCell * scaleOf(level).edge(); }
  /// The lowest level whose boxes may be as long as this box; kMostLevels if there is none.
  int levelFor(const Aabb& box) const;
  /// The cell that contains the center of a box.
  static Cell cellOf(const Aabb& box, const CellScale& scale);
  std::uint32_t bucketOf(const Cell& cell, int level) const;
  template <class Visit>
  void visitLevel(const QueryShape& shape, int level, Visit&& visit) const;

  double finest_ = 1.0;                                     // [m] edge of the cells of level 0
  std::uint32_t occupied_levels_ = 0;                       // bit i: level i holds boxes
  std::array<std::vector<ProxyId>, kMostLevels> on_level_;  // the boxes of each level, in no order
  std::vector<ProxyId> object_bucket_;                      // first box of each bucket; the number is a power of two
  std::vector<Object> objects_;                             // by id
  IdSet oversized_;                                         // the boxes that are too long for every level
};

}  // namespace book
}  // namespace hgrid
