// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/hashed_grid.h"

#include "partitions/stamps.h"

namespace hgrid {
namespace book {

// ---- the hash table

/// Index of the slot of a cell, or slots_.size() if the cell is not occupied.
std::size_t HashedGrid::find(const Cell& cell) const {
  if (!occupied_.mayBeOccupied(cell)) return slots_.size();
  for (std::size_t place = homeOf(cell);; place = (place + 1) & (slots_.size() - 1)) {
    const Slot& slot = slots_[place];
    if (slot.state == SlotState::empty) return slots_.size();
    if (slot.state == SlotState::used && slot.cell == cell) return place;
  }
}

/// Index of the slot of a cell. If the cell is not occupied, a slot without boxes is made for it.
std::size_t HashedGrid::findOrMake(const Cell& cell) {
  std::size_t place = find(cell);
  if (place != slots_.size()) return place;
  if (2 * (busy_ + 1) > slots_.size()) resize(4 * (used_ + 1));
  for (place = homeOf(cell); slots_[place].state == SlotState::used;) place = (place + 1) & (slots_.size() - 1);
  if (slots_[place].state == SlotState::empty) ++busy_;
  ++used_;
  slots_[place] = {cell, kEnd, SlotState::used};
  occupied_.set(cell, true);
  return place;
}

/// Moves the used slots into a table of at least this size. No slot of the new table is reusable.
void HashedGrid::resize(std::size_t slots) {
  std::size_t size = 16;
  while (size < slots) size *= 2;
  std::vector<Slot> old(size);
  old.swap(slots_);
  for (const Slot& slot : old) {
    if (slot.state != SlotState::used) continue;
    std::size_t place = homeOf(slot.cell);
    while (slots_[place].state == SlotState::used) place = (place + 1) & (slots_.size() - 1);
    slots_[place] = slot;
  }
  busy_ = used_;
}

/// Adds a box to the list of a cell.
void HashedGrid::link(const Cell& cell, ProxyId id) {
  std::uint32_t entry = free_;
  if (entry == kEnd) {
    entries_.push_back({});
    entry = static_cast<std::uint32_t>(entries_.size() - 1);
  } else {
    free_ = entries_[entry].next;
  }
  Slot& slot = slots_[findOrMake(cell)];
  entries_[entry] = {id, slot.first};
  slot.first = entry;
}

/// Removes a box from the list of a cell, which contains it.
void HashedGrid::unlink(const Cell& cell, ProxyId id) {
  Slot& slot = slots_[find(cell)];
  std::uint32_t* link = &slot.first;
  while (entries_[*link].id != id) link = &entries_[*link].next;
  const std::uint32_t entry = *link;
  *link = entries_[entry].next;
  entries_[entry].next = free_;
  free_ = entry;
  if (slot.first != kEnd) return;
  slot.state = SlotState::reusable;
  --used_;
  occupied_.set(cell, false);
}

// ---- changes

void HashedGrid::build() {
  const std::vector<ProxyId> ids = storedIds();
  scale_ = CellScale(cellEdgeFor(storedBoxes(), rule_));
  slots_.clear();
  entries_.clear();
  free_ = kEnd;
  used_ = busy_ = 0;
  large_.clear();
  occupied_.cover(scale_.cellsOf(world()), pretest_ ? 64.0 * double(ids.size()) : 0.0);
  resize(4 * ids.size());
  for (const ProxyId id : ids) added(id);
}

Partition::Followed HashedGrid::added(ProxyId id) {
  const CellRange cells = scale_.cellsOf(box(id));
  if (isLarge(cells)) {
    large_.add(id);
  } else {
    cells.visit([&](const Cell& cell) { link(cell, id); });
  }
  return hasManyLargeBoxes() ? Followed::no : Followed::yes;
}

Partition::Followed HashedGrid::removed(ProxyId id, const Aabb& from) {
  const CellRange cells = scale_.cellsOf(from);
  if (isLarge(cells)) {
    large_.remove(id);
  } else {
    cells.visit([&](const Cell& cell) { unlink(cell, id); });
  }
  return Followed::yes;
}

Partition::Followed HashedGrid::moved(ProxyId id, const Aabb& from) {
  return scale_.cellsOf(from) == scale_.cellsOf(box(id)) ? Followed::yes : Partition::moved(id, from);
}

// ---- searches

void HashedGrid::findPairsInCells(PairSink& sink) const {
  std::vector<ProxyId> here;
  for (const Slot& slot : slots_) {
    if (slot.state != SlotState::used || entries_[slot.first].next == kEnd) continue;
    if (sink.isFull()) return;
    here.clear();
    for (std::uint32_t entry = slot.first; entry != kEnd; entry = entries_[entry].next)
      here.push_back(entries_[entry].id);
    sink.visitPairs(here, [&](ProxyId a, ProxyId b) {
      if (sink.isPair(a, b) && scale_.reportingCell(box(a), box(b)) == slot.cell) sink.add(a, b);
    });
  }
}

void HashedGrid::candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const {
  thread_local Stamps seen;  // the boxes that this query has met
  seen.begin(idEnd());
  const Aabb& around = shape.bounds();
  const auto visit = [&](const Slot& slot) {
    for (std::uint32_t entry = slot.first; entry != kEnd; entry = entries_[entry].next) {
      const ProxyId id = entries_[entry].id;
      if (overlap(around, box(id)) && seen.mark(id)) found.push_back(id);
    }
  };
  const bool all = scale_.visitRanges(shape, CellScale::everywhere(), double(used_), [&](const CellRange& range) {
    range.visit([&](const Cell& cell) {
      const std::size_t place = find(cell);
      if (place != slots_.size()) visit(slots_[place]);
    });
  });
  if (!all) {
    for (const Slot& slot : slots_) {
      if (slot.state == SlotState::used) visit(slot);
    }
  }
}

void HashedGrid::checkStructure() const {
  std::size_t links = 0, expected = 0, used = 0, busy = 0;
  for (const Slot& slot : slots_) {
    used += slot.state == SlotState::used ? 1 : 0;
    busy += slot.state != SlotState::empty ? 1 : 0;
    if (slot.state != SlotState::used) continue;
    require(slot.first != kEnd, "a used slot has a box");
    require(&slots_[find(slot.cell)] == &slot, "a search finds each used slot");
    for (std::uint32_t entry = slot.first; entry != kEnd; entry = entries_[entry].next, ++links) {
      require(isStored(entries_[entry].id), "each box in a cell is stored");
      require(scale_.cellsOf(box(entries_[entry].id)).contains(slot.cell), "a box overlaps the cell that holds it");
    }
  }
  for (const ProxyId id : storedIds()) {
    const CellRange cells = scale_.cellsOf(box(id));
    require(large_.contains(id) == isLarge(cells), "a box is large if it covers too many cells");
    expected += isLarge(cells) ? 0 : static_cast<std::size_t>(cells.count());
  }
  require(links == expected, "each box is in all cells that it overlaps, once");
  require(used == used_ && busy == busy_ && 2 * busy <= slots_.size(), "the table is at most half full");
}

std::size_t HashedGrid::structureBytes() const {
  return slots_.capacity() * sizeof(Slot) + entries_.capacity() * sizeof(Entry) + large_.bytes() + occupied_.bytes();
}

void HashedGrid::draw(std::vector<Aabb>& regions) const {
  for (const Slot& slot : slots_) {
    if (slot.state == SlotState::used) regions.push_back(scale_.regionOf(slot.cell));
  }
}

}  // namespace book
}  // namespace hgrid
