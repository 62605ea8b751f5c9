// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/array_grid.h"

#include "partitions/pair_bits.h"
#include "partitions/stamps.h"

namespace hgrid {
namespace book {

std::size_t ArrayGrid::indexOf(const Cell& cell) const {
  const std::int64_t across_x = cells_.high.x - cells_.low.x + 1, across_y = cells_.high.y - cells_.low.y + 1;
  return static_cast<std::size_t>(((cell.z - cells_.low.z) * across_y + cell.y - cells_.low.y) * across_x + cell.x -
                                  cells_.low.x);
}

void ArrayGrid::build() {
  const std::vector<ProxyId> ids = storedIds();
  double edge = cellEdgeFor(storedBoxes(), rule_);
  for (;; edge *= 2.0) {  // the size of the array must be bounded, also in an uneven world
    scale_ = CellScale(edge);
    cells_ = scale_.cellsOf(world());
    if (cells_.count() <= 8.0 * double(ids.size()) + 64.0) break;
  }
  large_.clear();
  begin_.assign(static_cast<std::size_t>(cells_.count()) + 1, 0);
  for (const ProxyId id : ids) {  // the first pass counts
    const CellRange cells = scale_.cellsOf(box(id));
    if (isLarge(cells)) {
      large_.add(id);
    } else {
      cells.visit([&](const Cell& cell) { ++begin_[indexOf(cell) + 1]; });
    }
  }
  for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
  entries_.resize(begin_.back());
  std::vector<std::uint32_t> next = begin_;
  for (const ProxyId id : ids) {  // the second pass fills
    if (large_.contains(id)) continue;
    scale_.cellsOf(box(id)).visit([&](const Cell& cell) { entries_[next[indexOf(cell)]++] = id; });
  }
}

void ArrayGrid::findPairsInCells(PairSink& sink) const {
  const bool by_bits = idEnd() <= kMostIdsForBits;
  PairBits bits;
  if (by_bits) bits.reset(idEnd());
  std::vector<ProxyId> here;
  std::size_t index = 0;  // visit() goes through the cells in the order of their indices
  cells_.visit([&](const Cell& cell) {
    const std::uint32_t begin = begin_[index], end = begin_[index + 1];
    ++index;
    if (end - begin < 2 || sink.isFull()) return;
    here.assign(entries_.begin() + begin, entries_.begin() + end);
    sink.visitPairs(here, [&](ProxyId a, ProxyId b) {
      if (!sink.isPair(a, b)) return;
      if (by_bits ? bits.mark(a, b) : scale_.reportingCell(box(a), box(b)) == cell) sink.add(a, b);
    });
  });
}

void ArrayGrid::candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const {
  thread_local Stamps seen;  // the boxes that this query has met
  seen.begin(idEnd());
  const Aabb& around = shape.bounds();
  const auto add = [&](std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t entry = begin; entry != end; ++entry) {
      const ProxyId id = entries_[entry];
      if (overlap(around, box(id)) && seen.mark(id)) found.push_back(id);
    }
  };
  const bool all = scale_.visitRanges(shape, cells_, double(begin_.size()), [&](const CellRange& range) {
    CellRange rows = range;  // the first cell of each row: the entries of a whole row are adjacent in the array
    rows.high.x = rows.low.x;
    rows.visit([&](const Cell& cell) {
      const std::size_t first = indexOf(cell);
      add(begin_[first], begin_[first + static_cast<std::size_t>(range.high.x - range.low.x) + 1]);
    });
  });
  if (!all) add(0, begin_.back());
}

void ArrayGrid::checkStructure() const {
  require(begin_.size() == static_cast<std::size_t>(cells_.count()) + 1, "there is one offset per cell");
  require(std::is_sorted(begin_.begin(), begin_.end()), "the offsets ascend");
  std::size_t index = 0, expected = 0;
  cells_.visit([&](const Cell& cell) {
    for (std::uint32_t entry = begin_[index]; entry != begin_[index + 1]; ++entry) {
      require(isStored(entries_[entry]), "each box in a cell is stored");
      require(scale_.cellsOf(box(entries_[entry])).contains(cell), "a box overlaps the cell that holds it");
    }
    ++index;
  });
  for (const ProxyId id : storedIds()) {
    const CellRange cells = scale_.cellsOf(box(id));
    require(large_.contains(id) == isLarge(cells), "a box is large if it covers too many cells");
    expected += isLarge(cells) ? 0 : static_cast<std::size_t>(cells.count());
  }
  require(entries_.size() == expected, "each box is in all cells that it overlaps, once");
}

std::size_t ArrayGrid::structureBytes() const {
  return (begin_.capacity() + entries_.capacity()) * sizeof(std::uint32_t) + large_.bytes();
}

void ArrayGrid::draw(std::vector<Aabb>& regions) const {
  cells_.visit([&](const Cell& cell) { regions.push_back(scale_.regionOf(cell)); });
}

}  // namespace book
}  // namespace hgrid
