// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace hgrid {
namespace book {

/// Visit stamps (Ericson, Real-Time Collision Detection, 2005, section 7.7.2): each query takes a new number, and each
/// visited object or bucket stores it. An equal number means "already visited", so nothing has to be cleared.
///
/// Differs from the book: the stamps are not in the objects. Several threads may query a partition at the same time, so
/// each thread has its own stamps. Numbers have 64 bits and do not wrap in practice. So the amortized clearing of
/// section 7.7.3 is not needed; SmallStamps shows it.
class Stamps {
 public:
  /// Begins a query over the objects 0 .. count - 1. No object is marked.
  void begin(std::size_t count) {
    if (stamps_.size() < count) stamps_.resize(count, 0);
    ++now_;
  }
  /// Marks an object. @returns whether it was not marked before
  bool mark(std::size_t object) {
    if (stamps_[object] == now_) return false;
    stamps_[object] = now_;
    return true;
  }

 private:
  std::uint64_t now_ = 0;
  std::vector<std::uint64_t> stamps_;
};

/// Visit stamps of one byte with amortized clearing (section 7.7.3). Each query clears one block of the objects, round
/// robin, so that no object still holds a number when the number is used again.
///
/// Differs from the listing: there are 255 numbers and 255 blocks. The listing has 255 blocks and only the numbers 1 ..
/// 254, so an object could hold the current number when a query begins.
///
/// No partition uses this class. It is here for comparison: doc/partition_figures.md has the measured times. It saves 7 bytes
/// per object, but each query writes count / 255 bytes.
class SmallStamps {
 public:
  explicit SmallStamps(std::size_t count) : stamps_(count, 0) {}

  /// Begins a query. No object is marked.
  void begin() {
    now_ = now_ == kNumbers ? 1 : static_cast<std::uint8_t>(now_ + 1);
    const std::size_t block = (stamps_.size() + kNumbers - 1) / kNumbers;
    const std::size_t first = std::min(stamps_.size(), (now_ - 1u) * block);
    const std::size_t last = std::min(stamps_.size(), first + block);
    // Block k is cleared when number k begins. Between two uses of a number, each block is cleared exactly once.
    std::fill(stamps_.begin() + static_cast<std::ptrdiff_t>(first), stamps_.begin() + static_cast<std::ptrdiff_t>(last),
              std::uint8_t{0});
  }
  /// Marks an object. @returns whether it was not marked before
  bool mark(std::size_t object) {
    if (stamps_[object] == now_) return false;
    stamps_[object] = now_;
    return true;
  }

 private:
  static constexpr std::uint8_t kNumbers = 255;
  std::uint8_t now_ = 0;
  std::vector<std::uint8_t> stamps_;
};

}  // namespace book
}  // namespace hgrid
