// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/tree_grid.h"

#include <cmath>

namespace hgrid {
namespace book {

// ---- changes

void TreeGrid::build() {
  const std::vector<ProxyId> ids = storedIds();
  const std::vector<Aabb> all = storedBoxes();
  const double apart = cellEdgeFor(all, CellRule::density) * std::cbrt(kBoxesPerCell);
  scale_ = CellScale(std::max(cellEdgeFor(all, CellRule::objects), apart));
  cells_.clear();
  outdated_cells_.clear();
  large_ = Tree{};
  for (const ProxyId id : ids) added(id);
  settle();
}

// The functions added() and removed() change only the list of a tree. settle() builds the outdated trees.

Partition::Followed TreeGrid::added(ProxyId id) {
  const bool is_large = isLarge(box(id));
  const Cell cell = scale_.cellOf(box(id).min);
  Tree& tree = is_large ? large_ : cells_[cell];
  tree.ids.push_back(id);
  if (!is_large && !tree.is_outdated) outdated_cells_.push_back(cell);
  tree.is_outdated = true;
  return Followed::settle;
}

Partition::Followed TreeGrid::removed(ProxyId id, const Aabb& from) {
  const bool is_large = isLarge(from);
  const Cell cell = scale_.cellOf(from.min);
  Tree& tree = is_large ? large_ : cells_[cell];
  eraseUnordered(tree.ids, id);
  if (!is_large && !tree.is_outdated) outdated_cells_.push_back(cell);
  tree.is_outdated = true;
  return Followed::settle;
}

void TreeGrid::buildTree(Tree& tree) {
  tree.nodes.build(boxes(), tree.ids);
  for (std::size_t i = 0; i < tree.ids.size(); ++i) {
    const Aabb& here = box(tree.ids[i]);
    tree.bounds.min = i == 0 ? here.min : tree.bounds.min.cwiseMin(here.min);
    tree.bounds.max = i == 0 ? here.max : tree.bounds.max.cwiseMax(here.max);
  }
  tree.is_outdated = false;
}

/// Builds the outdated trees again, and drops cells that have no box.
void TreeGrid::settle() {
  for (const Cell& cell : outdated_cells_) {
    const auto place = cells_.find(cell);
    if (place->second.ids.empty()) {
      cells_.erase(place);
    } else {
      buildTree(place->second);
    }
  }
  outdated_cells_.clear();
  if (large_.is_outdated) buildTree(large_);
}

// ---- searches

void TreeGrid::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  const std::size_t before = found.size();
  const auto consider = [&](ProxyId id) {
    if (overlap(shape.bounds(), box(id))) found.push_back(id);
  };
  const auto visit = [&](const Tree& tree) {
    if (shape.mayTouch(tree.bounds)) tree.nodes.visit(shape, consider);
  };
  // If the shape touches a box in a point p, the minimum corner of the box is at most one edge below p on each axis. So
  // a shape that is grown by one edge touches the cell of this corner. Only a segment is grown on all sides.
  constexpr double kGrown = 1.0 + 1e-9;  // makes up for the rounding of cells
  const double edge = scale_.edge() * kGrown;
  Aabb reach = shape.bounds();
  for (int axis = 0; axis < 3; ++axis) reach.min[axis] = roundedDown(double(reach.min[axis]) - edge);
  Segment thick = shape.segment();
  thick.radius += 1.75 * edge;  // more than the diagonal of a cell
  const QueryShape near = shape.kind() == QueryShape::Kind::segment ? QueryShape(thick) : QueryShape(reach);
  const auto limit = static_cast<double>(cells_.size());
  const bool all = scale_.visitRanges(near, CellScale::everywhere(), 4.0 * limit, [&](const CellRange& range) {
    range.visit([&](const Cell& cell) {
      const auto tree = cells_.find(cell);
      if (tree != cells_.end()) visit(tree->second);
    });
  });
  if (!all) {              // The shape covers many more cells than there are trees, so this goes through the trees.
    found.resize(before);  // drops the boxes of the ranges that visitRanges() has visited
    for (const auto& tree : cells_) visit(tree.second);
  }
  large_.nodes.visit(shape, consider);
}

void TreeGrid::checkStructure() const {
  std::size_t held = 0;
  const auto check = [&](const Tree& tree) {
    held += tree.ids.size();
    std::vector<ProxyId> expected = tree.ids, in_tree = tree.nodes.ids();
    std::sort(expected.begin(), expected.end());
    std::sort(in_tree.begin(), in_tree.end());
    require(!tree.is_outdated && expected == in_tree, "the tree of a cell has the boxes of the cell");
    for (const ProxyId id : tree.ids) require(isStored(id), "each box in a cell is stored");
  };
  check(large_);
  for (const ProxyId id : large_.ids) require(isLarge(box(id)), "a large box is longer than a cell");
  for (const auto& one : cells_) {
    check(one.second);
    require(!one.second.ids.empty(), "an empty cell is not stored");
    for (const ProxyId id : one.second.ids)
      require(!isLarge(box(id)) && scale_.cellOf(box(id).min) == one.first,
              "a box is in the cell of its minimum corner");
  }
  require(held == size(), "each box is in one cell or is large");
}

std::size_t TreeGrid::structureBytes() const {
  const auto of = [](const Tree& tree) { return tree.ids.capacity() * sizeof(ProxyId) + tree.nodes.bytes(); };
  std::size_t bytes = of(large_) + cells_.bucket_count() * sizeof(void*);
  for (const auto& one : cells_) bytes += sizeof(one) + 2 * sizeof(void*) + of(one.second);
  return bytes;
}

void TreeGrid::draw(std::vector<Aabb>& regions) const {
  for (const auto& one : cells_) {
    one.second.nodes.visitRegions(one.second.bounds, [&](const Aabb& region) { regions.push_back(region); });
  }
}

}  // namespace book
}  // namespace hgrid
