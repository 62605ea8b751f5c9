// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <unordered_map>

#include "partitions/cell_scale.h"
#include "partitions/id_set.h"
#include "partitions/pair_counts.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// A hierarchical grid after Mirtich (Ericson, Real-Time Collision Detection, 2005, section 7.2.2, second scheme).
///
/// Cell edges are powers of two [m]. The level of a box has the smallest edge that is at least as long as its longest
/// side. A box is in all cells that it overlaps on its own level and on all coarser levels. It is a *resident* of cells
/// of its own level and a *visitor* of cells of coarser levels. Two boxes are close if they share a cell on the coarser
/// of their two levels. Each close pair has a counter: the number of cells that the two boxes share on that level. A
/// move changes the counters only where a box enters or leaves a cell. The search for all pairs reads the counters.
///
/// Differs from the book:
/// - The edges of the levels are fixed. The book fits the finest level to the smallest object.
/// - A level exists only if it had a resident when the grid was built. So each box visits few levels. A box that needs
///   another level makes the next search build the grid again.
/// - A close pair becomes a pair only if its boxes overlap; the book passes all close pairs to the narrow phase.
/// - Pairs of two fixed boxes are not counted.
/// - If there are far more close pairs than the pair bound allows, all counters are dropped to save memory. Until the
///   grid is built again, a query with each box then finds the pairs.
/// - Queries look at the residents of each level. The book describes only the search for all pairs.
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
    IdSet residents;  // of all cells of the level
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
  void count(ProxyId id, const CellBoxes& cell, bool resident, bool up);

  std::vector<Level> levels_;  // from fine to coarse
  PairCounts close_;           // for each close pair: the number of shared cells on the coarser level of the two
};

}  // namespace book
}  // namespace hgrid
