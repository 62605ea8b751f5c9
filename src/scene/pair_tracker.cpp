// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/scene/pair_tracker.h"

#include <algorithm>
#include <limits>

#include "scene/pair_order.h"

namespace hgrid {

void PairTracker::clear() {
  known_.clear();
  ended_.clear();
}

/// Known pairs in the numbers of the new ids; those of bodies that are gone have ended.
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
  std::size_t kept = 0;
  for (const Known& pair : known_) {
    const std::uint32_t a = now(pair.first), b = now(pair.second);
    if (a == kGone || b == kGone) {
      ended_.emplace_back(ids_[pair.first], ids_[pair.second]);
    } else {
      known_[kept++] = {std::min(a, b), std::max(a, b), pair.since};
    }
  }
  known_.resize(kept);
  std::sort(known_.begin(), known_.end(), [](const Known& a, const Known& b) { return before(a, b); });
  ids_ = ids;
}

void PairTracker::update(const std::vector<BodyId>& ids, Time stamp, std::vector<NearPair>& pairs,
                         const IsCut& is_cut) {
  ended_.clear();
  if (ids != ids_) renumber(ids);
  next_.clear();
  auto known = known_.begin();
  std::size_t room = most_ - std::min(most_, pairs.size());  // for pairs that are not listed
  const auto keepOrEnd = [&](const Known& pair) {
    if (is_cut && room > 0 && is_cut(pair.first, pair.second)) {
      next_.push_back(pair);
      --room;
    } else {
      ended_.emplace_back(ids_[pair.first], ids_[pair.second]);
    }
  };
  for (NearPair& pair : pairs) {
    while (known != known_.end() && before(*known, pair)) keepOrEnd(*known++);
    const bool there = known != known_.end() && !before(pair, *known);
    pair.since = there ? (known++)->since : stamp;
    next_.push_back({pair.first, pair.second, pair.since});
  }
  while (known != known_.end()) keepOrEnd(*known++);
  known_.swap(next_);
}

}  // namespace hgrid
