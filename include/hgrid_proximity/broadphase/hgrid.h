// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/broadphase/isa.h"

namespace hgrid {

/// The sizes of an HGrid's levels.
struct GridScale {
  static constexpr int kLevels = 16;  ///< levels of a grid, without the one for boxes that are larger than the coarsest
  static constexpr double kRatio = 4.0;  ///< size of a level's boxes, divided by that of the next finer level's

  double finest_edge = 0.0625;  ///< [m] longest side of the boxes on the finest level; 2^-30 .. 2^30

  /// The scale whose finest level fits the smallest of the boxes (1 m if there are none).
  static GridScale fitting(const std::vector<Aabb>& boxes);
};

/// A hierarchical grid (after Ericson, Real-Time Collision Detection, 2005, sections 7.1 and 7.2).
///
/// Each box is stored in one cell of one level: its longest side selects the level, its minimum corner selects the
/// cell. A box that overlaps another one therefore begins at most the longest side of its level before it. Every box is
/// tested against its own level and the coarser ones.
///
/// - Boxes are stored sorted by cell, as a structure of arrays. A row of cells is one range of positions, which is
///   tested many boxes at a time. Rows lie along the axis on which the world is longest. The inner loops are compiled
///   once per instruction set.
/// - Levels that hold few boxes share one grid. A cost model derives the edges of the cells from the boxes.
/// - Where boxes are spread unevenly, a k-d tree (section 7.3.7) divides space into regions of about even density, and
///   each region has cells of its own. So the cost follows the boxes and their pairs, not the empty space between them.
/// - Coordinates outside the window of the cells count as its outermost cells, so the world has no border.
/// - Boxes that move are sorted again when they move. Boxes that rest keep their positions, and the pairs among them.
/// - Fixed boxes are stored in a layer of their own, whose pairs among themselves are not searched.
///
/// What is found depends neither on the order of insertion, nor on the instruction set, nor on the number of threads.
/// The same calls in the same order also give the pairs in the same order.
class HGrid final : public BroadPhase {
 public:
  /// @throws std::invalid_argument if the finest edge is not within 2^-30 .. 2^30.
  explicit HGrid(const GridScale& scale = {});
  ~HGrid() override;
  HGrid(HGrid&&) noexcept;
  HGrid& operator=(HGrid&&) noexcept;

  /// Instruction set of the inner loops; initially bestIsa(). @throws std::invalid_argument if it is not supported.
  void setIsa(Isa isa);
  Isa isa() const;
  /// Threads that a bulk update or a search for pairs may use, the caller's included: 1 (initially) .. 64.
  /// @throws std::invalid_argument
  void setThreads(int threads);

  void insert(ProxyId id, const Aabb& box) override;
  void update(ProxyId id, const Aabb& box) override;
  void remove(ProxyId id) override;
  void clear() override;
  void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void setFixed(const std::vector<ProxyId>& ids) override;
  void setOverlapFilter(const OverlapFilter& filter) override;
  /// Also bounds the pairs that the grid keeps of resting boxes.
  void setPairBound(const PairBound& bound) override;

  std::size_t size() const override;
  void overlappingPairs(std::vector<ProxyPair>& pairs) const override;
  bool boundedPairs(std::vector<ProxyPair>& pairs) const override;
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const override;
  void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const override;
  void along(const Segment& segment, std::vector<SegmentHit>& found) const override;
  void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
               std::vector<NearHit>& found) const override;
  /// Answers the questions in an order that follows their positions, which saves cache misses.
  void overlapping(const std::vector<Aabb>& boxes, IdBatch& found) const override;
  void overlapping(const std::vector<Sphere>& spheres, IdBatch& found) const override;
  void along(const std::vector<Segment>& segments, SegmentBatch& found) const override;
  /// GridScale::kLevels levels, and one more for the boxes that are larger than the coarsest.
  std::vector<BroadPhaseLevel> levels() const override;
  int levelOf(ProxyId id) const override;
  void checkInvariants() const override;

  /// [m] Longest side of the boxes on a level below GridScale::kLevels.
  double edge(int level) const;
  /// Level of a box of this size: 0 .. GridScale::kLevels.
  int levelFor(const Aabb& box) const;
  /// Bytes of all stored data, without the pairs that the grid keeps of resting boxes.
  std::size_t bytes() const;

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace hgrid
