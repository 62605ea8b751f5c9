// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace hgrid {
namespace book {

/// One bit per unordered pair of objects (Ericson, Real-Time Collision Detection, 2005, section 7.7.1). If two objects
/// share several cells, the bit tells whether this pair was already found in an earlier cell.
///
/// The bits form a triangle: the pair a < b has the index a (2 n - a - 3) / 2 + b - 1. Differs from the listing:
/// indices have 64 bits, because 65,537 objects have more than 2^31 pairs.
class PairBits {
 public:
  /// Prepares for `count` objects and clears all bits. There are count (count - 1) / 2 bits, so use it for small
  /// worlds.
  void reset(std::size_t count) {
    count_ = count;
    bits_.assign((count * (count - (count > 0 ? 1 : 0)) / 2 + 63) / 64, 0);
  }
  /// Returns the position of the bit that stands for the pair {a, b}. Both orders give the same bit. `a` and `b` must
  /// differ.
  std::uint64_t indexOf(std::uint64_t a, std::uint64_t b) const {
    if (a > b) std::swap(a, b);
    return a * (2 * count_ - a - 3) / 2 + b - 1;
  }
  /// Sets the bit of a pair. @returns whether it was not set before
  bool mark(std::uint64_t a, std::uint64_t b) {
    const std::uint64_t index = indexOf(a, b), bit = std::uint64_t{1} << (index & 63);
    std::uint64_t& word = bits_[index >> 6];
    if ((word & bit) != 0) return false;
    word |= bit;
    return true;
  }

 private:
  std::uint64_t count_ = 0;
  std::vector<std::uint64_t> bits_;
};

}  // namespace book
}  // namespace hgrid
