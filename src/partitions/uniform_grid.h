// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "partitions/cell_scale.h"
#include "partitions/id_set.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// The common part of the uniform grids of section 7.1 (Ericson, Real-Time Collision Detection, 2005) that store a box
/// in all cells that it overlaps: HashedGrid, BucketGrid and ArrayGrid.
///
/// Section 7.1.6 compares this placement with placement by center or by minimum corner. It makes queries simple: they
/// visit only the cells that they overlap. So the search for all pairs looks at single cells and not at neighbors.
///
/// Differs from the book:
/// - A box may be longer than a cell. A box that would be in more than kMostCells cells is in the list `large_`
/// instead.
///   Each query tests all boxes of this list.
/// - A pair that shares several cells must be reported once. The grids report it only in CellScale::reportingCell(). So
///   the bits of 7.7.1 are not needed; ArrayGrid uses them only in small worlds, where they are as fast.
class UniformGrid : public Partition {
 protected:
  /// @param rule  how the cell size is computed from the boxes
  UniformGrid(const char* name, CellRule rule) : Partition(name), rule_(rule) {}

  // What each grid implements.

  /// Adds all pairs of two boxes in cells, each once. Pairs with large boxes are found by queries.
  virtual void findPairsInCells(PairSink& sink) const = 0;
  /// Appends the ids of all boxes in cells that the shape touches, each once, and perhaps of boxes near it.
  virtual void candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const = 0;

  /// Whether a box that overlaps these cells belongs to the list of large boxes.
  static bool isLarge(const CellRange& cells) { return cells.count() > kMostCells; }
  /// Whether so many boxes are large that the grid should be built again: the new boxes may lead to larger cells.
  bool hasManyLargeBoxes() const { return 8 * large_.size() > size() + 64; }

  const CellRule rule_;
  CellScale scale_;  // build() chooses it
  IdSet large_;      // the large boxes, which are in no cell

 private:
  static constexpr double kMostCells = 512;

  void findPairs(PairSink& sink) const final;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const final;
};

}  // namespace book
}  // namespace hgrid
