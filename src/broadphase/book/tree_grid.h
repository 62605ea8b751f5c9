// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <unordered_map>

#include "broadphase/book/cell_scale.h"
#include "broadphase/book/id_set.h"
#include "broadphase/book/kd_nodes.h"
#include "broadphase/book/partition.h"

namespace hgrid {
namespace book {

/// A grid of trees (Ericson, Real-Time Collision Detection, 2005, section 7.3.8): each cell of a coarse grid has a k-d
/// tree of its boxes. The grid skips the top of one large tree.
///
/// The minimum corner of a box selects its cell. Cells are loose: a cell keeps the bounds of its boxes, which may reach
/// into the next cells. A box is no longer than a cell, so a query visits the cells within one edge of its shape. Each
/// box is in one tree. The move of a box makes at most two trees out of date, and the next search builds these again.
///
/// Differs from the book: boxes that are longer than a cell are in one more tree of their own.
class TreeGrid final : public Partition {
 public:
  TreeGrid() : Partition("TreeGrid") {}

 private:
  static constexpr double kBoxesPerCell = 32;  // about this many boxes are in a cell of an evenly filled world
  struct Tree {
    std::vector<ProxyId> ids;
    Aabb bounds;
    KdNodes nodes;
    bool is_outdated = false;  // whether the nodes have to be built again
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  void settle() override;
  void findPairs(PairSink& sink) const override { findPairsByQueries(sink); }
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  bool isLarge(const Aabb& box) const { return longestSide(box) > scale_.edge(); }
  void buildTree(Tree& tree);

  CellScale scale_;
  std::unordered_map<Cell, Tree, CellHash> cells_;
  Tree large_;
  std::vector<Cell> outdated_cells_;  // cells whose trees have to be built again
};

}  // namespace book
}  // namespace hgrid
