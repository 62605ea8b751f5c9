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

void PairTracker::update(const std::vector<BodyId>& ids, Time stamp, std::vector<NearPair>& pairs) {
  ended_.clear();
  if (ids != ids_) renumber(ids);
  auto known = known_.begin();
  const auto end = [this](const Known& pair) { ended_.emplace_back(ids_[pair.first], ids_[pair.second]); };
  for (NearPair& pair : pairs) {
    while (known != known_.end() && before(*known, pair)) end(*known++);
    const bool there = known != known_.end() && !before(pair, *known);
    pair.since = there ? (known++)->since : stamp;
  }
  while (known != known_.end()) end(*known++);
  known_.clear();
  for (const NearPair& pair : pairs) known_.push_back({pair.first, pair.second, pair.since});
}

}  // namespace hgrid
