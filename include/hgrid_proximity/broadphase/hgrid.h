// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/broadphase/isa.h"

namespace hgrid {

/// The sizes of an HGrid's levels.
struct GridScale {
  static constexpr int kLevels = 16;     ///< levels of a grid; what is larger than the coarsest stands on one more
  static constexpr double kRatio = 4.0;  ///< size of a level's boxes over that of the next finer level's

  double finest_edge = 0.0625;  ///< [m] longest side of the boxes on the finest level; 2^-30 .. 2^30

  /// A scale whose finest level suits the smallest of the boxes (1 m if there are none).
  static GridScale fitting(const std::vector<Aabb>& boxes);
};

/// Decides which overlapping pairs are reported at all. Asked on any thread, of each pair perhaps only once while
/// neither of its boxes moves: the answer for a pair must not change.
struct PairTest {
  /// Moves those of `count` pairs that are reported to the front, in their order, and says how many. Null: all are.
  std::size_t (*sift)(const void* context, ProxyPair* pairs, std::size_t count) = nullptr;
  const void* context = nullptr;

  /// The test that asks a function of each pair.
  template <bool (*reported)(const void* context, ProxyId first, ProxyId second)>
  static PairTest of(const void* context) {
    return {[](const void* context, ProxyPair* pairs, std::size_t count) {
              std::size_t kept = 0;
              for (std::size_t i = 0; i < count; ++i) {
                const ProxyPair pair = pairs[i];
                pairs[kept] = pair;  // written, then kept or not: which it is nobody could guess
                kept += reported(context, pair.first, pair.second) ? 1 : 0;
              }
              return kept;
            },
            context};
  }
};

/// Bounds the work and the memory of HGrid::boundedPairs().
///
/// A search that would exceed the bound collects pairs in a fixed order instead. The boxes that are not fixed ask in
/// the order of their ids. Each asks for the boxes that overlap it and are fixed or have larger ids, in the order of
/// their ids. Pairs of two fixed boxes do not count.
struct PairBound {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::size_t pairs = kNone;     ///< pairs that a search returns at most
  std::size_t overlaps = kNone;  ///< overlapping pairs that it looks at, those that the PairTest leaves out included
};

/// A hierarchical grid (after Ericson, Real-Time Collision Detection, 2005, sections 7.1 and 7.2).
///
/// A box lives in one cell of one level: its longest side picks the level, its minimum corner the cell. So what
/// overlaps a box begins at most the reach of its level before it, and every box looks at its own and the coarser
/// levels. Boxes stand sorted by cell in structure of arrays, and a row of cells is one range of positions that is
/// tested many boxes at a time; the inner loops exist once per instruction set. Levels that are thinly populated share
/// one grid, and edges of cells follow from the boxes, by a model of the cost; coordinates outside the window of the
/// cells count to its outermost, so the world has no border.
///
/// Boxes that move are sorted anew whenever they do; those that rest keep their places, and the pairs among them.
/// Fixed boxes stand in a layer of their own that makes no pairs with itself.
///
/// A change that throws, also for lack of memory, has changed nothing: the grid holds the boxes that it held before.
///
/// What is found depends neither on the order of insertion, nor on the instruction set, nor on the threads; for the
/// same calls in the same order the pairs also come in the same order.
class HGrid final : public BroadPhase {
 public:
  /// @throws std::invalid_argument if the finest edge is not within 2^-30 .. 2^30.
  explicit HGrid(const GridScale& scale = {});
  ~HGrid() override;
  HGrid(HGrid&&) noexcept;
  HGrid& operator=(HGrid&&) noexcept;

  /// Instruction set of the inner loops; bestIsa() if not told. @throws std::invalid_argument if not supported.
  void setIsa(Isa isa);
  Isa isa() const;
  /// Threads that a bulk update and a search for pairs may use, the caller's among them: 1 (if not told) .. 64.
  /// @throws std::invalid_argument
  void setThreads(int threads);
  /// Boxes that make no pairs among each other, ids ascending, whether they are stored yet or not.
  /// @throws std::invalid_argument if they do not ascend
  void setFixed(const std::vector<ProxyId>& ids);

  /// Pairs that the test does not want are left out where they are found, before they are kept or copied.
  void setFilter(const PairTest& test);
  /// Bounds boundedPairs() and the pairs that are kept for resting boxes. Without it there is no bound.
  void setPairBound(const PairBound& bound);

  void insert(ProxyId id, const Aabb& box) override;
  void update(ProxyId id, const Aabb& box) override;
  void remove(ProxyId id) override;
  void clear() override;
  void update(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) override;
  std::size_t size() const override;
  void overlappingPairs(std::vector<ProxyPair>& pairs) const override;
  /// Finds the pairs within the bound. Which pairs these are depends only on the stored boxes, the fixed ones among
  /// them, the test and the bound. @returns whether these are all pairs
  bool boundedPairs(std::vector<ProxyPair>& pairs) const;
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) const override;
  void overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const override;
  void along(const Segment& segment, std::vector<SegmentHit>& found) const override;
  void nearest(const Eigen::Vector3d& point, std::size_t count, double limit,
               std::vector<NearHit>& found) const override;
  void overlapping(const std::vector<Aabb>& boxes, IdBatch& found) const override;
  void overlapping(const std::vector<Sphere>& spheres, IdBatch& found) const override;
  void along(const std::vector<Segment>& segments, SegmentBatch& found) const override;
  void checkInvariants() const override;

  /// [m] Longest side of the boxes on a level.
  double edge(int level) const;
  /// Level of a box of this size: 0 .. kLevels - 1, or kLevels if it is larger than the coarsest.
  int levelFor(const Aabb& box) const;
  /// Level of a stored box, as levelFor(); -1 if it is not stored.
  int levelOf(ProxyId id) const;
  /// Stored boxes per level, kLevels + 1 numbers. Looks at every box.
  std::vector<std::size_t> levelCounts() const;
  /// Bytes of all that is kept, the pairs of resting boxes apart.
  std::size_t bytes() const;

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace hgrid
