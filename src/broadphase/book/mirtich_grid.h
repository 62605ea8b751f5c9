// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <unordered_map>

#include "broadphase/book/cell_scale.h"
#include "broadphase/book/id_set.h"
#include "broadphase/book/pair_counts.h"
#include "broadphase/book/partition.h"

namespace hgrid {
namespace book {

/// A hierarchical grid after Mirtich (Ericson, Real-Time Collision Detection, 2005, section 7.2.2, second scheme).
///
/// The size of a box selects its level; the cell edge doubles from level to level. A box is in all cells that it
/// overlaps on its own level, where it is a resident, and on all coarser levels, where it is a visitor. Two boxes are
/// close if they share a cell on the coarser of their two levels. A counter per close pair holds the number of shared
/// cells. It rises when the boxes come to share a cell and falls when one of them leaves. The pairs come from these
/// counters, without a search.
///
/// Differs from the book:
/// - Only the levels that have a resident when the structure is built exist, so each box visits few levels. A box that
///   needs another level makes the next search build the structure again.
/// - Counters use memory for each close pair. If there are far more of them than the pair bound allows, the grid drops
///   all counters. Until the grid is built again, queries then find the pairs.
/// - Pairs of two fixed boxes are not counted.
class MirtichGrid final : public Partition {
 public:
  MirtichGrid() : Partition("MirtichGrid") {}

 private:
  struct CellBoxes {
    std::vector<ProxyId> residents, visitors;
  };
  struct Level {
    int exponent;  // the edge of a cell is 2^exponent [m]
    CellScale scale;
    IdSet residents;
    std::unordered_map<Cell, CellBoxes, CellHash> cells;
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  bool tracksPairs() const override { return true; }
  void findPairs(PairSink& sink) const override;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  static int exponentOf(const Aabb& box);
  std::size_t firstLevelOf(int exponent) const;
  void enter(Level& level, const Cell& cell, ProxyId id, bool resident);
  void leave(Level& level, const Cell& cell, ProxyId id, bool resident);
  void count(ProxyId a, ProxyId b, bool up);

  std::vector<Level> levels_;  // from fine to coarse
  PairCounts close_;
  bool counts_ = true;          // whether `close_` holds all close pairs
  std::size_t most_close_ = 0;  // largest number of close pairs that are counted
};

}  // namespace book
}  // namespace hgrid
