// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "broadphase/book/uniform_grid.h"

namespace hgrid {
namespace book {

/// A uniform grid of static boxes in one array (Ericson, Real-Time Collision Detection, 2005, section 7.1.4).
///
/// A first pass counts the boxes that overlap each cell. One array holds the entries of all cells, each cell from its
/// offset on. A second pass fills them. Every change of a box makes the next search build the grid again.
///
/// The layers of HGrid are the modern form of this grid: they are also sorted by counting, but they store each box in
/// one cell, and they sort boxes that move apart from boxes that rest.
///
/// Differs from the book: both passes use the same monotone mapping of coordinates to cells, so they cannot disagree.
/// The second pass has a write position for each cell. Large boxes are in a list of their own, see UniformGrid. In a
/// small world, one bit per pair (section 7.7.1) tells whether a pair that shares several cells was already found.
class ArrayGrid final : public UniformGrid {
 public:
  explicit ArrayGrid(CellRule rule = CellRule::objects) : UniformGrid("ArrayGrid", rule) {}

  /// With at most this many boxes, findPairs() uses one bit per pair (8 kB); otherwise, it computes the cell in which a
  /// pair is reported. doc/partitions.md has the figures.
  static constexpr std::size_t kMostIdsForBits = 362;

 private:
  void build() override;
  void findPairsInCells(PairSink& sink) const override;
  void candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  std::size_t indexOf(const Cell& cell) const;

  CellRange cells_;                   // the cells of the grid
  std::vector<std::uint32_t> begin_;  // for each cell: index of its first entry; and the number of all entries
  std::vector<ProxyId> entries_;
};

}  // namespace book
}  // namespace hgrid
