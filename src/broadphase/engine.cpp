// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/engine.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace hgrid {
namespace {

constexpr std::size_t kMostLoose = 64;

// A box that moves is looked for in two or three layers; from about this share on, sorting all is cheaper.
constexpr std::size_t kShareOfMoving = 4;

}  // namespace

HGrid::Engine::Engine(double finest) : finest_edge(finest) {}

void HGrid::Engine::requireStored(ProxyId id) const {
  if (!isStored(id)) throw std::invalid_argument("HGrid: box " + std::to_string(id) + " is not stored");
}

void HGrid::Engine::grow(ProxyId id) {
  if (id < boxes.size()) return;
  boxes.resize(id + std::size_t{1});
  place.resize(id + std::size_t{1}, kAbsent);
}

void HGrid::Engine::sortLayer(Place layer) {
  layers[layer].sort(boxes, finest_edge, machine());
  located[layer] = false;
}

void HGrid::Engine::locate(Place layer) {
  if (located[layer]) return;
  std::vector<std::uint32_t>& position = positions();
  if (position.size() < place.size()) position.resize(place.size());
  const ProxyId* ids = layers[layer].ids();
  for (std::uint32_t i = 0; i < layers[layer].size(); ++i) position[ids[i]] = i;
  located[layer] = true;
}

void HGrid::Engine::takeOut(ProxyId id) {
  const Place from = place[id];
  if (from == kLoose) {
    members[kLoose].erase(std::find(members[kLoose].begin(), members[kLoose].end(), id));
    layers[kLoose].setIds(members[kLoose]);
    sortLayer(kLoose);
  } else {
    locate(from);
    layers[from].withdraw(positions()[id]);
    ++withdrawn;
    if (from == kMoving) {
      moving_changed = true;
    } else {
      kept_dirty = true;
    }
  }
  place[id] = kAbsent;
  --stored;
}

void HGrid::Engine::putLoose(ProxyId id) {
  place[id] = kLoose;
  fixed_astray = fixed_astray || isFixed(id);
  ++stored;
  members[kLoose].push_back(id);
  if (members[kLoose].size() > kMostLoose || withdrawn > stored) return settleLoose();
  layers[kLoose].setIds(members[kLoose]);
  sortLayer(kLoose);
}

/// The moving, without those that were taken out, and with the loose.
void HGrid::Engine::joinLoose() {
  std::vector<ProxyId>& moving = members[kMoving];
  moving.erase(std::remove_if(moving.begin(), moving.end(), [this](ProxyId id) { return place[id] != kMoving; }),
               moving.end());
  for (const ProxyId id : members[kLoose]) {
    place[id] = kMoving;
    moving.push_back(id);
  }
  members[kLoose].clear();
  layers[kLoose].setIds(members[kLoose]);
  sortLayer(kLoose);
  moving_changed = false;
}

void HGrid::Engine::settleLoose() {
  joinLoose();
  const std::size_t moving = members[kMoving].size();
  if (moving > std::max(kMostLoose, stored / kShareOfMoving) || withdrawn > stored) return sortAll();
  layers[kMoving].setIds(members[kMoving]);
  sortLayer(kMoving);
}

void HGrid::Engine::sortAll() {
  bool same = members[kMoving].empty() && members[kLoose].empty() && withdrawn == 0 &&
              layers[kFixed].size() + layers[kResting].size() == stored;
  if (!same) {  // otherwise the layers hold the right ids, in a good order
    members[kMoving].clear();
    members[kLoose].clear();
    std::array<std::size_t, kLayers> counts{};
    for (ProxyId id = 0; id < place.size(); ++id) {
      if (place[id] == kAbsent) continue;
      place[id] = isFixed(id) ? kFixed : kResting;
      ++counts[place[id]];
    }
    std::array<ProxyId*, kLayers> next{};
    for (const Place layer : {kFixed, kResting, kMoving, kLoose}) next[layer] = layers[layer].setIds(counts[layer]);
    for (ProxyId id = 0; id < place.size(); ++id) {
      if (place[id] != kAbsent) *next[place[id]]++ = id;
    }
  }
  for (const Place layer : {kFixed, kResting, kMoving, kLoose}) sortLayer(layer);
  withdrawn = 0;
  waste = 0.0;
  fixed_astray = false;
  moving_changed = false;
  kept_valid = kept_dirty = false;
  kept.clear();
}

void HGrid::Engine::sortMoved() {
  if (moved.size() > stored / kShareOfMoving) return sortAll();
  bool started = false;
  for (const ProxyId id : moved) {
    if (place[id] == kFixed) return sortAll();  // it was said to be rare
    started = started || place[id] == kResting;
  }
  std::vector<ProxyId>& moving = members[kMoving];
  if (started || moving_changed || !members[kLoose].empty()) {
    joinLoose();
    if (started) locate(kResting);
    for (const ProxyId id : moved) {
      if (place[id] != kResting) continue;
      layers[kResting].withdraw(positions()[id]);
      ++withdrawn;
      kept_dirty = true;
      place[id] = kMoving;
      moving.push_back(id);
    }
    layers[kMoving].setIds(moving);
  }
  waste += static_cast<double>(moving.size() - moved.size());
  if (moving.size() > stored / kShareOfMoving || withdrawn > stored || waste > 2.0 * static_cast<double>(stored)) {
    return sortAll();
  }
  sortLayer(kMoving);
  keepPairs();
}

void HGrid::Engine::keepPairs() {
  if (!pairs_wanted.load(std::memory_order_relaxed)) return;
  // Boxes that left may have had most of the overlaps that were counted, so a large count is taken again.
  if (!kept_valid || (kept_dirty && kept_overlaps > bound.overlaps / 2)) {
    findKept();
  } else if (kept_dirty) {
    kept.erase(std::remove_if(kept.begin(), kept.end(),
                              [this](const ProxyPair& pair) {
                                return place[pair.first] > kResting || place[pair.second] > kResting;
                              }),
               kept.end());
  }
  kept_dirty = false;
}

}  // namespace hgrid
