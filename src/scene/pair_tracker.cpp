// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/scene/pair_tracker.h"

namespace hgrid {

std::size_t PairTracker::KeyHash::operator()(const Key& key) const {
  std::uint64_t hash = 0;
  for (const std::uint32_t part : {key.first.slot, key.first.generation, key.second.slot, key.second.generation}) {
    hash = (hash ^ part) * 0x9e3779b97f4a7c15ull;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

void PairTracker::update(const std::vector<BodyId>& ids, Time stamp, std::vector<NearPair>& pairs) {
  next_.clear();
  for (NearPair& pair : pairs) {
    // By slot, since the order of the indices may change with the names of bodies that come and go.
    BodyId a = ids[pair.first], b = ids[pair.second];
    if (b.slot < a.slot) std::swap(a, b);
    const Key key{a, b};
    const auto known = since_.find(key);
    pair.since = known == since_.end() ? stamp : known->second;
    next_.emplace(key, pair.since);
  }
  since_.swap(next_);
}

}  // namespace hgrid
