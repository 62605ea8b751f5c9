// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "broadphase/kernels/kernels.h"
#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {

/// The boxes that changed one at a time, in the hierarchical grid of Ericson 2005, section 7.2.1: one hash table for
/// the cells of all levels, each box in the cell of its center on the level of its size. Adding, moving and removing a
/// box take constant time. src/partitions/hashed_hgrid.h shows the structure with the words of the book.
///
/// The "place" of a box is a number that stays the same until a box is removed, or changes its level. Then the last box
/// of a level may take the place of another.
///
/// Where sizes differ much, a query that is large beside some boxes takes long. excess() adds up that work. The caller
/// decides when it is worth to keep the boxes in another way.
///
/// Work is bounded for any coordinates. A bucket holds at most kMostInBucket boxes; the caller asks hasRoom(), and if
/// there is none, it keeps the boxes in another way. On each level, a search looks at the cells of the query, or at all
/// boxes if they are fewer.
class LooseBoxes {
 public:
  /// @param finest_edge  [m] boxes that are shorter share the finest level; a power of two
  explicit LooseBoxes(double finest_edge);

  /// Allocates what add() or move() need for this box. The boxes stay as they are.
  void reserve(const Aabb& box);
  /// Returns whether the bucket of a box has room for one more. An empty table has.
  bool hasRoom(const Aabb& box) const;
  /// Adds a box. Call reserve() and hasRoom() before. @returns its place
  std::uint32_t add(ProxyId id, const Aabb& box);
  /// Gives a box new coordinates if it stays on its level and its new bucket has room. @returns whether it did
  bool move(std::uint32_t place, const Aabb& box);
  /// Removes a box. @returns whether another box has taken its place; if so, idAt(place) is that box
  bool remove(std::uint32_t place);
  void clear();

  std::size_t size() const { return size_; }
  ProxyId idAt(std::uint32_t place) const { return entryAt(place).id; }
  const Aabb& boxAt(std::uint32_t place) const { return entryAt(place).box; }
  /// Calls visit(id, place) for each box.
  template <class Visit>
  void visitAll(const Visit& visit) const {
    for (std::uint32_t level = 0; level < kLevels; ++level) {
      for (std::uint32_t index = 0; index < levels_[level].entries.size(); ++index)
        visit(levels_[level].entries[index].id, placeOf(level, index));
    }
  }
  /// Returns how much work searches have done since the table was empty, beyond kFreeWork for each of them. The unit is
  /// the test of one box.
  std::uint64_t excess() const { return excess_.load(std::memory_order_relaxed); }
  /// Returns a box that contains all boxes, and perhaps boxes that were removed.
  kernels::Box around() const;
  std::size_t bytes() const;

  /// Writes the places of all boxes that overlap a box.
  void overlapping(const kernels::Box& query, kernels::PositionSink* sink) const;
  /// Writes the places of all boxes within the radius of a line, and of some boxes near it.
  void along(const kernels::Line& line, kernels::PositionSink* sink) const;

  /// @throws std::logic_error that names the first violated invariant
  void checkInvariants() const;

 private:
  static constexpr std::uint32_t kLevels = 32;  ///< the mask of occupied levels has a bit for each, as in the book
  static constexpr double kCellToSide = 2.0;    ///< edge of a cell, divided by the longest side on its level
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kMostInBucket = 64;
  static constexpr std::uint64_t kFreeWork = 192;

  /// Indices of a cell along x, y and z.
  using Cell = std::array<std::int32_t, 3>;
  struct Entry {
    Aabb box;
    ProxyId id;
    Cell cell;
    std::uint32_t next, previous;  // places of the neighbors in the list of the bucket; kNone at its ends
  };
  struct Level {
    std::vector<Entry> entries;
    double inverse = 0.0;  // [1/m] reciprocal of the edge of a cell
    double longest = 0.0;  // [m] the longest side of its boxes, or a longer one
    kernels::Box around;   // contains its boxes
  };
  struct Bucket {
    std::uint32_t first = kNone, count = 0;
  };

  // A place is the index of a level and the index among its entries.
  static constexpr std::uint32_t kIndexBits = 27, kIndexMask = (1u << kIndexBits) - 1;
  static std::uint32_t placeOf(std::uint32_t level, std::size_t index) {
    return level << kIndexBits | static_cast<std::uint32_t>(index);
  }
  static std::uint32_t levelOf(std::uint32_t place) { return place >> kIndexBits; }
  const Entry& entryAt(std::uint32_t place) const { return levels_[levelOf(place)].entries[place & kIndexMask]; }
  Entry& entryAt(std::uint32_t place) { return levels_[levelOf(place)].entries[place & kIndexMask]; }

  std::uint32_t levelOf(const Aabb& box) const;
  static std::int32_t indexOf(double coordinate, const Level& level);
  static Cell cellOf(const Aabb& box, const Level& level);
  std::uint32_t bucketOf(const Cell& cell, std::uint32_t level) const;
  void link(std::uint32_t place);
  void unlink(std::uint32_t place);
  static void extend(Level& level, const Aabb& box);
  static void reset(Level& level);
  template <class Test>
  void writeAll(std::uint32_t level, const Test& test, kernels::PositionSink* sink) const;
  template <class Test>
  void writeCells(const Cell& low, const Cell& high, std::uint32_t level, const Test& test,
                  kernels::PositionSink* sink) const;

  int finest_;  // level 0 holds boxes shorter than 2^finest_ m
  std::array<Level, kLevels> levels_;
  std::uint32_t occupied_ = 0;   // bit i: level i has boxes
  std::vector<Bucket> buckets_;  // their number is a power of two
  std::size_t size_ = 0;
  mutable std::atomic<std::uint64_t> excess_{0};
};

}  // namespace hgrid
