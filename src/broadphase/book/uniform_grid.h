// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "broadphase/book/cell_scale.h"
#include "broadphase/book/id_set.h"
#include "broadphase/book/partition.h"

namespace hgrid {
namespace book {

/// The common part of the uniform grids of section 7.1: cells of one size, and each box is in all cells that it
/// overlaps.
///
/// Boxes that would be in more than kMostCells cells are in a list of large boxes instead. A query tests all of them.
class UniformGrid : public Partition {
 protected:
  /// @param rule  how the cell size is computed from the boxes
  UniformGrid(const char* name, CellRule rule) : Partition(name), rule_(rule) {}

  // What each grid implements.

  /// Adds all pairs of two boxes that share a cell, each once.
  virtual void findPairsInCells(PairSink& sink) const = 0;
  /// Appends the ids of all boxes in cells that the shape touches, each once, and perhaps of boxes near it.
  virtual void candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const = 0;

  static bool isLarge(const CellRange& cells) { return cells.count() > kMostCells; }
  /// Whether so many boxes are large that the grid should be built again with larger cells.
  bool hasManyLargeBoxes() const { return 8 * large_.size() > size() + 64; }

  const CellRule rule_;
  CellScale scale_;
  IdSet large_;

 private:
  static constexpr double kMostCells = 512;

  void findPairs(PairSink& sink) const final;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const final;
};

}  // namespace book
}  // namespace hgrid
