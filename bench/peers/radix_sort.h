// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace hgrid {
namespace bench {

/// Converts a float to an unsigned integer that sorts in the same order.
inline std::uint32_t sortable(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits ^ (static_cast<std::uint32_t>(-static_cast<std::int32_t>(bits >> 31)) | 0x80000000u);
}

/// Sorts (key, number) items by their 32-bit keys, in three passes of 11 bits. One loop counts the digits of all
/// passes.
class RadixSort {
 public:
  struct Item {
    std::uint32_t key, number;
  };

  /// The items to sort. The caller fills this list, then calls sorted().
  std::vector<Item>& items() { return items_; }

  /// Sorts the items and returns them. Items with equal keys keep their order.
  const std::vector<Item>& sorted() {
    constexpr int kBits = 11, kPasses = 3;
    constexpr std::uint32_t kBuckets = 1u << kBits, kMask = kBuckets - 1;
    std::array<std::array<std::uint32_t, kBuckets>, kPasses> counts{};
    for (const Item& item : items_) {
      for (int pass = 0; pass < kPasses; ++pass) ++counts[pass][(item.key >> (pass * kBits)) & kMask];
    }
    other_.resize(items_.size());
    for (int pass = 0; pass < kPasses; ++pass) {
      std::uint32_t begin = 0;
      for (std::uint32_t& count : counts[pass]) begin += std::exchange(count, begin);
      for (const Item& item : items_) other_[counts[pass][(item.key >> (pass * kBits)) & kMask]++] = item;
      items_.swap(other_);
    }
    return items_;
  }

 private:
  std::vector<Item> items_, other_;
};

}  // namespace bench
}  // namespace hgrid
