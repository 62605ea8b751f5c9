// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "broadphase/book/cell_bits.h"
#include "broadphase/book/uniform_grid.h"

namespace hgrid {
namespace book {

/// A uniform grid in a hash table with open addressing (Ericson, Real-Time Collision Detection, 2005, section 7.1.3).
///
/// Each box is in all cells that it overlaps. The table holds one slot per occupied cell, with the exact key of the
/// cell, so the world is unbounded and storage follows the boxes. Slots are probed linearly at a load of at most 1/2.
/// An emptied slot is only marked as reusable (lazy deletion), because a search for another key may have to pass it.
///
/// Differs from the book:
/// - The hash works on unsigned numbers, and its bits are mixed once more, because the table size is a power of two.
/// - Large boxes are in a list of their own, see UniformGrid.
/// - A pair that shares several cells is reported in one of them only: the cell of the smallest common corner.
/// - A query that covers more cells than are occupied goes through the occupied cells instead.
class HashedGrid final : public UniformGrid {
 public:
  /// @param rule     how the cell size is computed from the boxes
  /// @param pretest  whether a bit per cell tells that a cell is empty, if the world is small enough for it
  explicit HashedGrid(CellRule rule = CellRule::objects, bool pretest = true)
      : UniformGrid("HashedGrid", rule), pretest_(pretest) {}

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  enum class SlotState : std::uint8_t { empty, used, reusable };
  struct Slot {
    Cell cell;
    std::uint32_t first = kEnd;  // first entry of the cell
    SlotState state = SlotState::empty;
  };
  /// An entry of the list of boxes in a cell.
  struct Entry {
    ProxyId id;
    std::uint32_t next;
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  void findPairsInCells(PairSink& sink) const override;
  void candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  std::size_t homeOf(const Cell& cell) const { return CellHash()(cell) & (slots_.size() - 1); }
  std::size_t find(const Cell& cell) const;
  std::size_t findOrMake(const Cell& cell);
  void resize(std::size_t slots);
  void link(const Cell& cell, ProxyId id);
  void unlink(const Cell& cell, ProxyId id);

  const bool pretest_;
  std::vector<Slot> slots_;          // their number is a power of two
  std::size_t used_ = 0, busy_ = 0;  // slots that are used; slots that are used or reusable
  std::vector<Entry> entries_;
  std::uint32_t free_ = kEnd;  // list of unused entries
  CellBits occupied_;
};

}  // namespace book
}  // namespace hgrid
