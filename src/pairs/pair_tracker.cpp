// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "pairs/pair_tracker.h"

#include <algorithm>
#include <limits>

#include "pairs/pair_order.h"

namespace hgrid {

void PairTracker::clear() {
  known_.clear();
  ended_.clear();
}

/// Converts the known pairs to the body indices of the new ids. A pair with a removed body has ended.
void PairTracker::renumber(const std::vector<BodyId>& ids) {
  constexpr std::uint32_t kGone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t slots = 0;
  for (const BodyId& id : ids) slots = std::max(slots, id.slot + 1);
  std::vector<std::uint32_t> of_slot(slots, kGone);
  for (std::uint32_t i = 0; i < ids.size(); ++i) of_slot[ids[i].slot] = i;
  const auto now = [&](std::uint32_t number) {
    const BodyId& id = ids_[number];
    const std::uint32_t i = id.slot < slots ? of_slot[id.slot] : kGone;
    return i != kGone && ids[i] == id ? i : kGone;
  };
  carried_over_.clear();
  for (const Known& pair : known_) {
    const std::uint32_t a = now(pair.first), b = now(pair.second);
    if (a == kGone || b == kGone) {
      ended_.emplace_back(ids_[pair.first], ids_[pair.second]);
    } else {
      carried_over_.push_back({std::min(a, b), std::max(a, b), pair.since});
    }
  }
  std::sort(carried_over_.begin(), carried_over_.end(), [](const Known& a, const Known& b) { return before(a, b); });
  next_ids_ = ids;
}

void PairTracker::update(const std::vector<BodyId>& ids, Time stamp, std::vector<NearPair>& pairs,
                         const IsCut& is_cut) {
  ended_.clear();
  renumbered_ = ids != ids_;
  if (renumbered_) renumber(ids);
  const std::vector<Known>& was = renumbered_ ? carried_over_ : known_;
  next_known_.clear();
  auto known = was.begin();
  std::size_t room = most_ - std::min(most_, pairs.size());  // how many pairs that are not listed may be remembered
  const auto keepOrEnd = [&](const Known& pair) {
    if (is_cut && room > 0 && is_cut(pair.first, pair.second)) {
      next_known_.push_back(pair);
      --room;
    } else {
      ended_.emplace_back(ids[pair.first], ids[pair.second]);
    }
  };
  for (NearPair& pair : pairs) {
    while (known != was.end() && before(*known, pair)) keepOrEnd(*known++);
    const bool there = known != was.end() && !before(pair, *known);
    pair.since = there ? (known++)->since : stamp;
    next_known_.push_back({pair.first, pair.second, pair.since});
  }
  while (known != was.end()) keepOrEnd(*known++);
}

void PairTracker::accept() {
  if (renumbered_) ids_.swap(next_ids_);
  renumbered_ = false;
  known_.swap(next_known_);
}

}  // namespace hgrid
