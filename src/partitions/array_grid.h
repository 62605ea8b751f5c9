// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "partitions/uniform_grid.h"

namespace hgrid {
namespace book {

/// A uniform grid of static boxes in one array (Ericson, Real-Time Collision Detection, 2005, section 7.1.4).
///
/// A first pass counts the boxes that overlap each cell. The sums of these counts are the offsets of the cells in one
/// array of entries. A second pass fills the array. Every change of a box makes the next search build the grid again.
///
/// Differs from the book, apart from what UniformGrid describes:
/// - Both passes map coordinates to cells with CellScale, so their rounding cannot differ.
/// - The second pass uses a copy of the offsets as write positions, one per cell.
/// - The cells are enlarged until there are at most 8 n + 64 of them. Otherwise a few distant boxes would need a huge
///   array of empty cells.
/// - In a small world, one bit per pair (section 7.7.1) tells whether a pair that shares several cells was already
///   found. In larger worlds, the pair is reported in its reporting cell.
///
/// The layers of HGrid are the modern form of this grid. They are also sorted by counting. But they store each box in
/// one cell, and they sort boxes that move apart from boxes that rest.
class ArrayGrid final : public UniformGrid {
 public:
  explicit ArrayGrid(CellRule rule = CellRule::objects) : UniformGrid("ArrayGrid", rule) {}

  /// findPairs() uses one bit per pair if all ids are below this number: these bits then take at most 8 kB.
  /// doc/partition_figures.md has the figures.
  static constexpr std::size_t kMostIdsForBits = 362;

 private:
  void build() override;
  void findPairsInCells(PairSink& sink) const override;
  void candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  /// Index of a cell in `begin_`. The x coordinate changes fastest.
  std::size_t indexOf(const Cell& cell) const;

  CellRange cells_;                   // all cells of the grid
  std::vector<std::uint32_t> begin_;  // for each cell: index of its first entry; at the end: the number of entries
  std::vector<ProxyId> entries_;      // the boxes of the first cell, then those of the second one, ...
};

}  // namespace book
}  // namespace hgrid
