// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/pairs_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hgrid {
namespace {

void fillPairs(const Snapshot& snapshot, const std::vector<std::uint32_t>& number, msg::Pairs& message) {
  const std::size_t shown = snapshot.pairs().size();
  message.first.resize(shown);
  message.second.resize(shown);
  message.gap.resize(shown);
  message.margin.resize(shown);
  message.since.resize(shown);
  message.state.resize(shown);
  message.no_contact_before.resize(shown);
  message.flags.resize(shown, 0);
  for (std::size_t i = 0; i < shown; ++i) {
    const NearPair& pair = snapshot.pairs()[i];
    message.first[i] = number[pair.first];
    message.second[i] = number[pair.second];
    message.gap[i] = pair.gap;
    message.margin[i] = pair.margin;
    message.since[i] = toRos(pair.since);
    const NoContact no_contact = snapshot.noContactBefore(pair.first, pair.second, pair.gap);
    message.no_contact_before[i] = no_contact.before;
    message.flags[i] = pair.flags | (no_contact.assumed ? kAssumedFlag : 0);
    message.state[i] =
        static_cast<std::uint8_t>(std::max(snapshot.poses()[pair.first].state, snapshot.poses()[pair.second].state));
  }
}

}  // namespace

PairsMessages::Pooled& PairsMessages::unused() {
  for (Pooled& pooled : pool_) {
    if (pooled.message.use_count() == 1) return pooled;
  }
  if (pool_.size() < kMostKept) {
    pool_.emplace_back();
    return pool_.back();
  }
  return extra_ = Pooled{};
}

/// Writes the names of all bodies that are in a pair into the message, and the index of each of these names into
/// number_. The names are sorted, because Structure::bodies is sorted by name.
void PairsMessages::fillNames(const Snapshot& snapshot, Pooled& pooled) {
  const Structure& structure = snapshot.structure();
  constexpr std::uint32_t kBits = 64;
  number_.resize(structure.bodies.size());
  in_pair_.assign(structure.bodies.size() / kBits + 1, 0);
  for (const NearPair& pair : snapshot.pairs()) {
    for (const std::uint32_t body : {pair.first, pair.second})
      in_pair_[body / kBits] |= std::uint64_t{1} << body % kBits;
  }
  if (pooled.revision != structure.revision) pooled.named.clear();
  pooled.revision = structure.revision;
  std::vector<std::string>& names = pooled.message->names;
  std::uint32_t next = 0;
  const auto add = [&](std::uint32_t body) {
    if (next == names.size()) names.emplace_back();
    if (next == pooled.named.size()) {
      pooled.named.push_back(body);
      names[next] = structure.bodies[body].name;
    } else if (pooled.named[next] != body) {
      pooled.named[next] = body;
      names[next] = structure.bodies[body].name;
    }
    number_[body] = next++;
  };
  for (std::uint32_t word = 0; word < in_pair_.size(); ++word) {
    for (std::uint64_t bits = in_pair_[word]; bits != 0; bits &= bits - 1) {  // removes the lowest bit
      add(word * kBits + static_cast<std::uint32_t>(__builtin_ctzll(bits)));
    }
  }
  names.resize(next);
  pooled.named.resize(next);
}

boost::shared_ptr<msg::Pairs> PairsMessages::of(const Tick& tick, const msg::WorldState& world) {
  Pooled& pooled = unused();
  msg::Pairs& message = *pooled.message;
  if (!tick.snapshot) {
    message = msg::Pairs();
    pooled.named.clear();
  }
  message.header = headerOf(tick);
  message.world = world;
  if (!tick.snapshot) return pooled.message;
  const Snapshot& snapshot = *tick.snapshot;
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  message.total = static_cast<std::uint32_t>(std::min(snapshot.pairsFound(), kMost));
  message.truncated = snapshot.truncated();
  fillNames(snapshot, pooled);
  fillPairs(snapshot, number_, message);
  return pooled.message;
}

}  // namespace hgrid
