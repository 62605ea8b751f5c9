// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// The sizes of an HGrid's cells.
struct GridScale {
  static constexpr int kLevels = 16;     ///< levels of a grid
  static constexpr double kRatio = 4.0;  ///< edge of a level's cells over that of the next finer level

  double finest_edge = 0.0625;  ///< [m] edge of the smallest cells; 2^-30 .. 2^30, rounded down to a power of two

  /// A scale whose finest cells fit the smallest of the boxes (1 m if there are none).
  static GridScale fitting(const std::vector<Aabb>& boxes);
};

/// A hashed hierarchical grid (after Ericson, Real-Time Collision Detection, 2005, sections 7.1 and 7.2).
///
/// A box lives in one cell of one level: that of its minimum corner, on the finest level where it reaches
/// no farther than into the next cell of each axis. So the boxes that overlap a query have their cells in
/// the query's cells or one before them (7.1.6), whatever the rounding: cell numbers are monotone in the
/// coordinate. A mask of occupied levels says which levels to look at. All pairs at once: each box looks
/// at its own and the coarser levels. The grid has no border: cells are found by hash, their full key is
/// compared. A box too large for the coarsest level, or so far out that its cell number would leave
/// ±2^30 on every level that fits, stands in a list of its own that every query looks through.
///
/// What it finds depends neither on the order of insertion nor on the seed.
class HGrid final : public BroadPhase {
 public:
  /// @param seed  of the hash of the cells; keep it secret where boxes come from strangers
  /// @throws std::invalid_argument if the finest edge is not within 2^-30 .. 2^30.
  explicit HGrid(const GridScale& scale = {}, std::uint64_t seed = 0);

  void insert(ProxyId id, const Aabb& box) override;
  void update(ProxyId id, const Aabb& box) override;
  void remove(ProxyId id) override;
  void clear() override;
  void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  std::size_t size() const override { return size_; }
  void overlappingPairs(std::vector<ProxyPair>& pairs) const override;
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const override;
  void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const override;
  void along(const Segment& segment, std::vector<SegmentHit>& found) const override;
  void checkInvariants() const override;

  /// Bit k is set while level k (0 the finest) holds a box.
  std::uint32_t occupiedLevels() const { return occupied_; }
  /// Boxes on a level; level kLevels counts those too large for every level.
  std::size_t count(int level) const;
  /// [m] Edge of a level's cells.
  double edge(int level) const { return levels_.at(static_cast<std::size_t>(level)).edge; }
  /// Level on which this box would live: 0 .. kLevels - 1, or kLevels if it is too large for all.
  int levelFor(const Aabb& box) const;
  /// Level on which a box lives, as levelFor(); -1 if it is not stored.
  int levelOf(ProxyId id) const { return id < entries_.size() ? entries_[id].level : kAbsent; }

 private:
  using Cell = std::array<std::int32_t, 3>;
  struct CellHash {
    std::uint64_t seed;
    std::size_t operator()(const Cell& cell) const;
  };
  using Members = std::vector<ProxyId>;
  using CellMap = std::unordered_map<Cell, Members, CellHash>;
  struct Level {
    double edge;
    CellMap cells;
    std::size_t count = 0;
  };
  struct Entry {
    Aabb box;
    int level = kAbsent;
    Cell cell{};
    std::uint32_t position = 0;  // in the members of its cell, or in oversize_
  };
  struct Range {
    Cell low, high;
  };
  static constexpr int kAbsent = -1;
  static constexpr int kOversize = GridScale::kLevels;

  bool isStored(ProxyId id) const { return id < entries_.size() && entries_[id].level != kAbsent; }
  void place(ProxyId id, const Aabb& box);
  void withdraw(ProxyId id);
  Members& membersOf(const Entry& entry);
  const Members& membersOf(const Entry& entry) const;
  Range reachOf(const Level& level, const Eigen::Vector3d& min, const Eigen::Vector3d& max) const;
  template <class Visit>
  void visitRange(const Level& level, const Range& range, Visit&& visit) const;
  template <class Visit>
  void visitAll(const Level& level, Visit&& visit) const;
  template <class Visit>
  void visitNear(const Eigen::Vector3d& min, const Eigen::Vector3d& max, std::uint32_t levels, Visit&& visit) const;
  bool slabsAlong(const Level& level, const Segment& segment, std::vector<Range>& slabs) const;

  std::array<Level, GridScale::kLevels> levels_;
  std::vector<Entry> entries_;
  Members oversize_;
  std::uint32_t occupied_ = 0;
  std::size_t size_ = 0;
};

}  // namespace hgrid
