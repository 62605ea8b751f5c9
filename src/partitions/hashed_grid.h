// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "partitions/cell_bits.h"
#include "partitions/uniform_grid.h"

namespace hgrid {
namespace book {

/// A uniform grid in a hash table with a record per occupied cell (Ericson, Real-Time Collision Detection, 2005,
/// section 7.1.3). The book calls this closed hashing; it is also called open addressing.
///
/// Each box is in all cells that it overlaps. A slot of the table holds the exact key of its cell and the head of a
/// linked list of the boxes in the cell. So the world is unbounded, and storage follows the boxes. Slots are probed
/// linearly at a load of at most 1/2. An emptied slot is only marked as reusable (lazy deletion), because a search for
/// another key may have to pass it.
///
/// Differs from the book, apart from what UniformGrid and CellHash describe:
/// - The reusable slots count in the load. If the load is too high, a larger table replaces this one without them.
/// - The pretest covers the cells of the world as it was when the grid was built, unless these are too many.
/// - A query that covers more cells than are occupied goes through all occupied cells instead.
class HashedGrid final : public UniformGrid {
 public:
  /// @param rule     how the cell size is computed from the boxes
  /// @param pretest  whether to keep one bit per cell, see CellBits; a world with too many cells has none anyway
  explicit HashedGrid(CellRule rule = CellRule::objects, bool pretest = true)
      : UniformGrid("HashedGrid", rule), pretest_(pretest) {}

 private:
  static constexpr std::uint32_t kEnd = 0xffffffffu;
  enum class SlotState : std::uint8_t { empty, used, reusable };
  struct Slot {
    Cell cell;
    std::uint32_t first = kEnd;  // index of the first entry of the cell; kEnd if the slot is not used
    SlotState state = SlotState::empty;
  };
  /// An entry of the list of boxes in a cell.
  struct Entry {
    ProxyId id;
    std::uint32_t next;  // index of the next entry; kEnd for the last one
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
  std::size_t used_ = 0, busy_ = 0;  // number of slots that are used; number of slots that are used or reusable
  std::vector<Entry> entries_;       // of all cells
  std::uint32_t free_ = kEnd;        // first entry of the list of unused entries
  CellBits occupied_;                // the pretest
};

}  // namespace book
}  // namespace hgrid
