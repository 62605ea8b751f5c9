// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <unordered_map>

#include "partitions/cell_scale.h"
#include "partitions/id_set.h"
#include "partitions/kd_nodes.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// A grid of trees (Ericson, Real-Time Collision Detection, 2005, section 7.3.8): each occupied cell of a coarse grid
/// has a k-d tree of its boxes.
///
/// The minimum corner of a box selects its cell, so each box is in one tree. A cell is loose: its boxes may extend into
/// the next cells, and it keeps their bounds. A box is no longer than a cell. So a query visits the cells that its
/// shape touches and those within one edge below. A change makes at most two trees outdated. The next search builds
/// only these again, where a KdTree would be built again as a whole.
///
/// Differs from the book:
/// - Boxes that are longer than a cell are in one more tree, `large_`. The book does not say where they go.
/// - Cells are in a hash table, so the world is unbounded.
/// - The search for all pairs queries the grid with each box. The book does not describe one.
class TreeGrid final : public Partition {
 public:
  TreeGrid() : Partition("TreeGrid") {}

 private:
  static constexpr double kBoxesPerCell = 32;  // a cell has about this many boxes if the world is evenly filled
  struct Tree {
    std::vector<ProxyId> ids;
    Aabb bounds;  // of the boxes
    KdNodes nodes;
    bool is_outdated = false;  // whether `bounds` and `nodes` do not match `ids`
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

  /// Whether a box belongs to the tree `large_`.
  bool isLarge(const Aabb& box) const { return longestSideInDouble(box) > scale_.edge(); }
  void buildTree(Tree& tree);

  CellScale scale_;
  std::unordered_map<Cell, Tree, CellHash> cells_;
  Tree large_;
  std::vector<Cell> outdated_cells_;  // cells whose trees have to be built again
};

}  // namespace book
}  // namespace hgrid
