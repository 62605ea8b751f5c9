// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/broadphase/isa.h"

namespace hgrid {

/// The box sizes of an HGrid's levels.
struct GridScale {
  static constexpr int kLevels = 16;     ///< number of levels, without the extra level for boxes that fit none of them
  static constexpr double kRatio = 4.0;  ///< longest box side of a level / longest box side of the next finer level

  double finest_edge = 0.0625;  ///< [m] longest side of a box on the finest level; 2^-30 .. 2^30

  /// Returns the scale whose finest level fits the smallest of the boxes (1 m if there are no boxes).
  static GridScale fitting(const std::vector<Aabb>& boxes);
};

/// A hierarchical grid (after Ericson, Real-Time Collision Detection, 2005, sections 7.1 and 7.2).
///
/// Each box is stored in one cell of one level: its longest side selects the level, its minimum corner selects the
/// cell. If many boxes are thin, the axes on which a box is long may select its level instead. The reach of a level is
/// the longest side of its boxes. A box of the level that overlaps a given box begins, on each axis, at most one reach
/// before it. The search for pairs tests every box against its own level, and every two levels against each other.
///
/// - Boxes are sorted by cell and stored as a structure of arrays. The boxes in a row of cells are one range of array
///   indices, so SIMD instructions test several boxes at a time. Rows mostly lie along the axis on which the world is
///   longest. The inner loops are compiled once per instruction set.
/// - Levels with few boxes share one grid. A cost model computes the cell size from the boxes.
/// - Where boxes are spread unevenly, a k-d tree (section 7.3.7) divides space into regions of about even density, and
///   each region has its own cells. So the cost depends on the boxes and their pairs, not on the empty space.
/// - If each box overlaps only few others along one axis, and the boxes are few or close together across this axis, all
///   boxes share one row of cells along it, as in a sweep (section 7.5). Queries then use a tree of the bounds of
///   successive boxes.
/// - A box outside the range of the cells is stored in the nearest outermost cell, so the world has no border.
/// - Boxes that move are sorted again when they move. Boxes that rest keep their places in the arrays. The grid stores
///   the pairs of resting boxes, and does not search for them again.
/// - Fixed boxes are stored in a separate layer. The grid does not search for pairs of two fixed boxes.
///
/// Results depend neither on the order of insertion, nor on the instruction set, nor on the number of threads.
/// The same calls in the same order also return the pairs in the same order.
class HGrid final : public BroadPhase {
 public:
  /// @throws std::invalid_argument if the finest edge is not within 2^-30 .. 2^30.
  explicit HGrid(const GridScale& scale = {});
  ~HGrid() override;
  /// Takes over the content of another grid, which may then only be destroyed or assigned to.
  HGrid(HGrid&&) noexcept;
  /// Takes over the content of another grid, which may then only be destroyed or assigned to.
  HGrid& operator=(HGrid&&) noexcept;

  /// Sets the instruction set of the inner loops; initially bestIsa().
  /// @throws std::invalid_argument if this processor or build does not support it.
  void setIsa(Isa isa);
  /// Returns the instruction set of the inner loops.
  Isa isa() const;
  /// Sets how many threads a bulk update or a search for pairs may use, including the calling thread. The range is
  /// 1 .. 64, initially 1.
  /// @throws std::invalid_argument if the number is outside this range.
  void setThreads(int threads);
  /// Returns how many threads work. If the system could not create all of them, it is less than setThreads() asked for.
  int threads() const;

  void insert(ProxyId id, const Aabb& box) override;
  void update(ProxyId id, const Aabb& box) override;
  void remove(ProxyId id) override;
  void clear() override;
  void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void setFixed(const std::vector<ProxyId>& ids) override;
  void setOverlapFilter(const OverlapFilter& filter) override;
  /// Also bounds the number of pairs of resting boxes that the grid keeps.
  void setPairBound(const PairBound& bound) override;

  std::size_t size() const override;
  void overlappingPairs(std::vector<ProxyPair>& pairs) const override;
  bool boundedPairs(std::vector<ProxyPair>& pairs) const override;
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const override;
  void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const override;
  void along(const Segment& segment, std::vector<SegmentHit>& found) const override;
  void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
               std::vector<NearHit>& found) const override;
  /// Returns GridScale::kLevels size classes and one more for the boxes that are too large for the largest of them.
  /// Several classes may share a level of the grid, so these are not the levels that a search visits.
  std::vector<BroadPhaseLevel> levels() const override;
  int levelOf(ProxyId id) const override;
  void checkInvariants() const override;

  /// Returns the longest side [m] that a box of this size class can have; 0 <= level < GridScale::kLevels.
  double edge(int level) const;
  /// Returns the size class of a box: 0 .. GridScale::kLevels.
  int levelFor(const Aabb& box) const;
  /// Returns the memory [bytes] of all stored data, without the pairs of resting boxes that the grid keeps.
  std::size_t bytes() const;

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace hgrid
