// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "partitions/cell_scale.h"

namespace hgrid {
namespace book {

/// One bit per cell of a bounded range: whether the cell is occupied (the pretest of section 7.1.3). If the bit is 0, a
/// search need not look into the hash table.
///
/// Differs from the book: the grid need not have a fixed size. A cell beyond the range has no bit, so mayBeOccupied()
/// is always true for it.
class CellBits {
 public:
  /// Starts anew for a range of cells, none of them occupied. If the range has more than `most` cells, no cell has a
  /// bit.
  void cover(const CellRange& range, double most) {
    covered_ = range.count() <= most;
    range_ = range;
    across_x_ = range.high.x - range.low.x + 1;
    across_y_ = range.high.y - range.low.y + 1;
    bits_.assign(covered_ ? static_cast<std::size_t>(range.count()) / 64 + 1 : 0, 0);
  }
  bool mayBeOccupied(const Cell& cell) const {
    if (!covered_ || !range_.contains(cell)) return true;
    const std::size_t index = indexOf(cell);
    return (bits_[index >> 6] >> (index & 63) & 1) != 0;
  }
  void set(const Cell& cell, bool occupied) {
    if (!covered_ || !range_.contains(cell)) return;
    const std::size_t index = indexOf(cell);
    const std::uint64_t bit = std::uint64_t{1} << (index & 63);
    bits_[index >> 6] = occupied ? bits_[index >> 6] | bit : bits_[index >> 6] & ~bit;
  }
  bool covers() const { return covered_; }
  std::size_t bytes() const { return bits_.capacity() * sizeof(std::uint64_t); }

 private:
  std::size_t indexOf(const Cell& cell) const {
    return static_cast<std::size_t>(((cell.z - range_.low.z) * across_y_ + cell.y - range_.low.y) * across_x_ + cell.x -
                                    range_.low.x);
  }

  bool covered_ = false;
  CellRange range_;
  std::int64_t across_x_ = 0, across_y_ = 0;
  std::vector<std::uint64_t> bits_;
};

}  // namespace book
}  // namespace hgrid
