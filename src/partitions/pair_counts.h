// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {
namespace book {

/// A counter per tracked pair of boxes. A pair whose counter is 0 is not stored.
///
/// MirtichGrid counts the cells that two boxes share on the coarser of their levels (Ericson, Real-Time Collision
/// Detection, 2005, section 7.2.2). SweepLists uses it as a set of pairs: each counter is 1 (section 7.5.1). The book
/// leaves the kind of the table open.
///
/// It is a hash table with linear probing (closed hashing in section 7.1.3) at a load of at most 1/2. Differs from that
/// section: a deletion moves later entries back. Lazy deletion would fill the table with marks, because pairs come and
/// go all the time.
///
/// The number of pairs has a limit. If a pair exceeds it, the table drops all pairs, releases their memory, and tracks
/// no more pairs until clear().
class PairCounts {
 public:
  /// Drops all pairs, and tracks pairs again. @param most  largest number of pairs
  void clear(std::size_t most) {
    slots_.assign(kLeast, {});
    size_ = 0;
    most_ = most;
    is_complete_ = true;
  }
  /// Whether the limit was never exceeded since clear(). Then the table holds every pair whose counter is above 0.
  bool isComplete() const { return is_complete_; }
  std::size_t size() const { return size_; }
  /// Adds 1 to the counter of a pair.
  void raise(ProxyId a, ProxyId b) {
    if (!is_complete_) return;
    if (2 * (size_ + 1) > slots_.size()) grow();
    Slot& slot = slots_[find(keyOf(a, b))];
    if (slot.count == 0) {
      if (size_ == most_) return drop();
      slot.key = keyOf(a, b);
      ++size_;
    }
    ++slot.count;
  }
  /// Subtracts 1 from the counter of a pair, and drops the pair at 0. Does nothing for a pair that is not tracked.
  void lower(ProxyId a, ProxyId b) {
    const std::size_t place = find(keyOf(a, b));
    if (slots_[place].count != 0 && --slots_[place].count == 0) eraseAt(place);
  }
  /// The counter of a pair; 0 if it is not tracked.
  std::uint32_t of(ProxyId a, ProxyId b) const { return slots_[find(keyOf(a, b))].count; }
  /// Calls visit(a, b), a < b, for each tracked pair.
  template <class Visit>
  void visit(Visit&& visit) const {
    for (const Slot& slot : slots_) {
      if (slot.count != 0) visit(static_cast<ProxyId>(slot.key >> 32), static_cast<ProxyId>(slot.key));
    }
  }
  std::size_t bytes() const { return slots_.capacity() * sizeof(Slot); }

 private:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t count = 0;
  };
  static std::uint64_t keyOf(ProxyId a, ProxyId b) {
    return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
  }
  std::size_t homeOf(std::uint64_t key) const {
    key *= 0x9e3779b97f4a7c15u;  // multiplicative hashing: the upper bits are well mixed
    return static_cast<std::size_t>(key ^ key >> 32) & (slots_.size() - 1);
  }
  /// Returns the index of the slot that holds `key`. If no slot holds it, returns the index of the empty slot in which
  /// raise() has to store it.
  std::size_t find(std::uint64_t key) const {
    std::size_t place = homeOf(key);
    while (slots_[place].count != 0 && slots_[place].key != key) place = (place + 1) & (slots_.size() - 1);
    return place;
  }
  void eraseAt(std::size_t hole) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t next = (hole + 1) & mask; slots_[next].count != 0; next = (next + 1) & mask) {
      // An entry whose home slot comes after the hole stays, because a search begins at the home slot and never
      // reaches the hole.
      if (((next - homeOf(slots_[next].key)) & mask) < ((next - hole) & mask)) continue;
      slots_[hole] = slots_[next];
      hole = next;
    }
    slots_[hole].count = 0;
    --size_;
  }
  void drop() {
    std::vector<Slot>(kLeast).swap(slots_);
    size_ = 0;
    is_complete_ = false;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old) {
      if (slot.count != 0) slots_[find(slot.key)] = slot;
    }
  }

  static constexpr std::size_t kLeast = 64;  // smallest number of slots

  std::vector<Slot> slots_{kLeast};  // their number is a power of two
  std::size_t size_ = 0, most_ = static_cast<std::size_t>(-1);
  bool is_complete_ = true;
};

}  // namespace book
}  // namespace hgrid
