// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/engine.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string>

namespace hgrid {
namespace {

// For each moving box, a search for pairs visits two or three layers. So if more than a quarter of all boxes moves, it
// is cheaper to sort all boxes.
constexpr std::size_t kShareOfMoving = 4;
// If less than half of the moving layer still moves, and the layer holds more than a seventh of all boxes, it is
// cheaper to sort all boxes.
constexpr std::size_t kShareOfIdle = 7;
// If other boxes move each time, and more than one in 16, it is cheaper to sort all boxes each time.
constexpr std::size_t kShareOfOthers = 16;
// If so many boxes were tried, and less than an eighth of them could return to the resting layer, trying others costs
// more than it saves.
constexpr std::size_t kMostVain = 64, kShareOfReturned = 8;

/// Reserves memory for `count` ids. Like push_back(), it at least doubles the capacity.
void makeRoom(std::vector<ProxyId>& ids, std::size_t count) {
  if (ids.capacity() < count) ids.reserve(std::max(count, 2 * ids.capacity()));
}

}  // namespace

HGrid::Engine::Engine(double finest) : finest_edge(finest), singles(finest) {}

void HGrid::Engine::throwNotStored(ProxyId id) {
  throw std::invalid_argument("HGrid: box " + std::to_string(id) + " is not stored; insert it first");
}

void HGrid::Engine::grow(ProxyId id) {
  const std::size_t count = id + std::size_t{1};
  if (boxes.size() < count) boxes.resize(count);
  // The arrays may differ in size, because the second resize may have failed before.
  if (layer_of.size() < count) layer_of.resize(count, kAbsent);
}

void HGrid::Engine::reserveLayer(LayerNumber layer, std::size_t count) {
  layers[layer].reserve(count, boxes.size(), machine());
}

void HGrid::Engine::sortLayer(LayerNumber layer) {
  layers[layer].sort(boxes, finest_edge, machine());
  located[layer] = false;
}

void HGrid::Engine::locate(LayerNumber layer) {
  if (located[layer]) return;
  std::vector<std::uint32_t>& position = positions();
  if (position.size() < layer_of.size()) position.resize(layer_of.size());
  const ProxyId* ids = layers[layer].ids();
  for (std::uint32_t i = 0; i < layers[layer].size(); ++i) position[ids[i]] = i;
  located[layer] = true;
}

void HGrid::Engine::restoreFromLayers() {
  std::fill(layer_of.begin(), layer_of.end(), kAbsent);
  stored = 0;
  for (const LayerNumber number : {kFixed, kResting, kMoving, kLoose}) {
    const Layer& layer = layers[number];
    for (std::uint32_t i = 0; i < layer.size(); ++i) {
      if (layer.isWithdrawn(i)) continue;
      boxes[layer.ids()[i]] = layer.boxAt(i);
      layer_of[layer.ids()[i]] = number;
      ++stored;
    }
  }
}

std::size_t HGrid::Engine::movingWithLoose() const {
  const std::vector<ProxyId>& moving = members[kMoving];
  std::size_t still_moving = moving.size();
  if (moving_changed) {
    still_moving = static_cast<std::size_t>(
        std::count_if(moving.begin(), moving.end(), [this](ProxyId id) { return layer_of[id] == kMoving; }));
  }
  return still_moving + members[kLoose].size();
}

void HGrid::Engine::reserveLoose(ProxyId id, const Aabb& box) {
  const bool comes = !isStored(id), leaves_layer = !comes && !isSingle(id);
  const std::size_t stored_then = stored + (comes ? 1 : 0), withdrawn_then = withdrawn + (leaves_layer ? 1 : 0);
  if (withdrawn_then > stored_then) {
    sortAll();
  } else if (!members[kLoose].empty() || !singles.hasRoom(box) || singlesSettle()) {
    settleLoose();
  }
  if (!comes && !isSingle(id)) locate(layer_of[id]);
  if (positions().size() < layer_of.size()) positions().resize(layer_of.size());
  singles.reserve(box);
}

void HGrid::Engine::takeOut(ProxyId id) {
  const LayerNumber from = layer_of[id];
  if (isSingle(id)) {
    const std::uint32_t place = positions()[id];
    if (singles.remove(place)) positions()[singles.idAt(place)] = place;
    singlesChanged();
    if (!isHashed()) emptyLooseLayer();
  } else {
    locate(from);
    if (from == kLoose) members[kLoose].erase(std::find(members[kLoose].begin(), members[kLoose].end(), id));
    layers[from].withdraw(positions()[id]);
    ++withdrawn;
    moving_changed = moving_changed || from == kMoving;
    kept_dirty = kept_dirty || from <= kResting;
  }
  buffers.found_valid = false;
  layer_of[id] = kAbsent;
  --stored;
}

void HGrid::Engine::putLoose(ProxyId id) {
  buffers.found_valid = false;
  layer_of[id] = kLoose;
  fixed_astray = fixed_astray || isFixed(id);
  ++stored;
  positions()[id] = singles.add(id, boxes[id]);
  singlesChanged();
}

bool HGrid::Engine::moveSingle(ProxyId id, const Aabb& box) {
  if (!isSingle(id) || singlesSettle() || !singles.move(positions()[id], box)) return false;
  boxes[id] = box;
  buffers.found_valid = false;
  singlesChanged();
  return true;
}

void HGrid::Engine::singlesChanged() {
  loose_sorted = false;
}

void HGrid::Engine::settleLoose() {
  std::vector<ProxyId>& moving = members[kMoving];
  const std::size_t count =
      moving.size() + singles.size() + members[kLoose].size();  // upper limit: some boxes may have been taken out
  if (count > std::max(std::size_t{kMostLoose}, stored / kShareOfMoving)) return sortAll();
  makeRoom(moving, count);
  reserveLayer(kMoving, moving.capacity());
  joinLoose();
  layers[kMoving].setIds(moving);
  sortLayer(kMoving);
}

/// Turns the loose boxes into moving boxes. From the list of moving boxes, removes the boxes that were taken out of the
/// moving layer. Allocates nothing if the list of moving boxes has room for the loose ones.
void HGrid::Engine::joinLoose() {
  std::vector<ProxyId>& moving = members[kMoving];
  kept_moving = false;  // kept_dirty is true, so searches leave out the pairs of the moving boxes
  moving.erase(std::remove_if(moving.begin(), moving.end(), [this](ProxyId id) { return layer_of[id] != kMoving; }),
               moving.end());
  const auto join = [&](ProxyId id) {
    layer_of[id] = kMoving;
    moving.push_back(id);
  };
  std::for_each(members[kLoose].begin(), members[kLoose].end(), join);
  singles.visitAll([&](ProxyId id, std::uint32_t) { join(id); });
  members[kLoose].clear();
  singles.clear();
  emptyLooseLayer();
  moving_changed = false;
}

/// Leaves no boxes in the loose layer. Allocates nothing.
void HGrid::Engine::emptyLooseLayer() {
  layers[kLoose].setIds(0);
  sortLayer(kLoose);
  loose_sorted = true;
}

void HGrid::Engine::unhash() {
  if (!isHashed()) return;
  sortLoose();
  members[kLoose].assign(layers[kLoose].ids(), layers[kLoose].ids() + layers[kLoose].size());
  singles.clear();
  located[kLoose] = false;
}

void HGrid::Engine::sortLoose() const {
  if (loose_sorted.load(std::memory_order_acquire)) return;
  const std::lock_guard<std::mutex> lock(loose_mutex);
  if (loose_sorted.load(std::memory_order_relaxed)) return;
  Workers alone(1);  // another search may use the other threads
  const Machine machine{loops, &alone, &loose_scratch};
  layers[kLoose].reserve(singles.size(), boxes.size(), machine);
  ProxyId* const first = layers[kLoose].setIds(singles.size());
  ProxyId* next = first;
  singles.visitAll([&](ProxyId id, std::uint32_t) { *next++ = id; });
  std::sort(first, next);  // the order of the pairs must not depend on the order in the table
  layers[kLoose].sort(boxes, finest_edge, machine);
  loose_sorted.store(true, std::memory_order_release);
}

void HGrid::Engine::sortAll(bool others) {
  const bool same = !others && members[kMoving].empty() && members[kLoose].empty() && !isHashed() && withdrawn == 0 &&
                    layers[kFixed].size() + layers[kResting].size() == stored;
  std::array<std::size_t, kLayers> counts{};
  if (same) {  // the layers hold the right ids, in a good order
    for (const LayerNumber layer : {kFixed, kResting}) counts[layer] = layers[layer].size();
  } else {
    for (ProxyId id = 0; id < layer_of.size(); ++id) {
      if (layer_of[id] != kAbsent) ++counts[isFixed(id) ? kFixed : kResting];
    }
  }
  for (const LayerNumber layer : {kFixed, kResting}) reserveLayer(layer, counts[layer]);
  // Nothing below allocates.
  if (!same) {
    members[kMoving].clear();
    members[kLoose].clear();
    if (isHashed()) singles.clear();
    loose_sorted = true;
    std::array<ProxyId*, kLayers> next{};
    for (const LayerNumber layer : {kFixed, kResting, kMoving, kLoose})
      next[layer] = layers[layer].setIds(counts[layer]);
    for (ProxyId id = 0; id < layer_of.size(); ++id) {
      if (layer_of[id] == kAbsent) continue;
      layer_of[id] = isFixed(id) ? kFixed : kResting;
      *next[layer_of[id]]++ = id;
    }
  }
  for (const LayerNumber layer : {kFixed, kResting, kMoving, kLoose}) sortLayer(layer);
  withdrawn = 0;
  waste = 0.0;
  fixed_astray = false;
  moving_changed = false;
  dropKept();
}

void HGrid::Engine::dropKept() {
  kept_valid = kept_dirty = kept_moving = keep_found = buffers.found_valid = false;
  kept.clear();
}

bool HGrid::Engine::movesOthers() {
  const auto moves = [this](ProxyId id) { return std::binary_search(moved.begin(), moved.end(), id); };
  const auto sample = moved_before.begin();
  const auto still = std::count_if(sample, sample + static_cast<std::ptrdiff_t>(moved_before_count), moves);
  const bool others = 2 * static_cast<std::size_t>(still) < moved_before_count;
  moved_before_count = std::min(moved.size(), moved_before.size());
  for (std::size_t i = 0; i < moved_before_count; ++i) moved_before[i] = moved[i * moved.size() / moved_before_count];
  return others;
}

void HGrid::Engine::sortMoved() {
  if (moved.size() > stored / kShareOfMoving) return sortAll();
  std::size_t started = 0;
  for (const ProxyId id : moved) {
    if (layer_of[id] == kFixed) return sortAll();  // rare: fixed boxes should not move
    started += layer_of[id] == kResting;
  }
  keep_found = started > 0 && movesOthers();
  if (keep_found && started > stored / kShareOfOthers) return sortAll();
  if (keep_found && sortOthers(started)) return;
  std::vector<ProxyId>& moving = members[kMoving];
  const bool regroup = started > 0 || moving_changed || !members[kLoose].empty();
  const std::size_t count = regroup ? movingWithLoose() + started : moving.size();
  const double wasted = waste + static_cast<double>(count - moved.size());
  if (count > stored / kShareOfMoving || withdrawn + started > stored || wasted > 2.0 * static_cast<double>(stored)) {
    sortAll();
    keep_found = true;
    return;
  }
  // If few boxes move at a time, but other boxes each time, most boxes of the moving layer do not move anymore.
  const bool others = 2 * started > moved.size() && moved.size() < count / 2;
  if (others && count > stored / kShareOfIdle) {
    sortAll();
    keep_found = true;
    return;
  }
  if (regroup) makeRoom(moving, count);
  reserveLayer(kMoving, count);
  if (started > 0) locate(kResting);
  // Nothing below allocates, except keepPairs().
  kept_moving = false;
  if (regroup) {
    joinLoose();
    for (const ProxyId id : moved) {
      if (layer_of[id] != kResting) continue;
      layers[kResting].withdraw(positions()[id]);
      ++withdrawn;
      kept_dirty = true;
      layer_of[id] = kMoving;
      moving.push_back(id);
    }
    layers[kMoving].setIds(moving);
  }
  waste = wasted;
  sortLayer(kMoving);
  keepPairs();
  buffers.found_valid = false;
}

bool HGrid::Engine::sortOthers(std::size_t started) {
  // As in keepPairs(), if too many overlaps are counted, only a new search corrects their number.
  if (!buffers.found_valid || buffers.found.size() > bound.pairs || buffers.found_overlaps > bound.overlaps / 2)
    return false;
  std::vector<ProxyId>&moving = members[kMoving], &loose = members[kLoose];
  const std::size_t count = moving.size() + loose.size();  // upper limit: some of them move now
  // A search for pairs does not visit the boxes that only have to be sorted. So they count less than in sortMoved().
  const double wasted = waste + 0.6 * static_cast<double>(count);
  if (count > stored / kShareOfMoving || withdrawn + started > stored || wasted > 2.0 * static_cast<double>(stored)) {
    sortAll();
    keep_found = true;
    return true;
  }
  // The number of moving boxes varies. If memory for it grows by doubling, the grid soon allocates nothing.
  makeRoom(moving, count);
  makeRoom(loose, moved.size());
  reserveLayer(kMoving, moving.capacity());
  reserveLayer(kLoose, loose.capacity());
  locate(kResting);
  // Nothing below allocates.
  // Takes the ids in the order of the layers, because boxes that are near each other are sorted faster one after
  // another.
  moving.clear();
  std::size_t moved_long_ago = 0;
  for (const LayerNumber number : {kMoving, kLoose}) {
    moved_long_ago = moving.size();
    const Layer& layer = layers[number];
    for (std::uint32_t i = 0; i < layer.size(); ++i) {
      if (layer.isWithdrawn(i)) continue;
      moving.push_back(layer.ids()[i]);
      layer_of[layer.ids()[i]] = kMoving;
    }
  }
  for (const ProxyId id : moved) {
    if (layer_of[id] == kResting) {
      layers[kResting].withdraw(positions()[id]);
      ++withdrawn;
    }
    layer_of[id] = kLoose;
  }
  std::size_t tried = 0, returned = 0;
  for (std::size_t i = moved_long_ago; i < moving.size(); ++i) {
    if (layer_of[moving[i]] != kMoving) continue;
    if (tried >= kMostVain && returned < tried / kShareOfReturned) break;
    ++tried;
    if (!putBack(moving[i])) continue;
    ++returned;
    layer_of[moving[i]] = kResting;
  }
  moving.erase(std::remove_if(moving.begin(), moving.end(), [this](ProxyId id) { return layer_of[id] != kMoving; }),
               moving.end());
  loose.assign(moved.begin(), moved.end());
  for (const LayerNumber layer : {kMoving, kLoose}) {
    layers[layer].setIds(members[layer]);
    sortLayer(layer);
  }
  waste = wasted;
  moving_changed = false;
  keepFound();
  kept_moving = kept_dirty = true;
  return true;
}

bool HGrid::Engine::putBack(ProxyId id) {
  Layer& resting = layers[kResting];
  if (id >= positions().size()) return false;
  const std::uint32_t position = positions()[id];  // means nothing if the box was not in this layer
  if (position >= resting.size() || resting.idAt(position) != id || !resting.putBack(position, boxes[id])) return false;
  --withdrawn;
  return true;
}

bool HGrid::Engine::keepFound() {
  if (!buffers.found_valid || buffers.found.size() > bound.pairs || buffers.found_overlaps > bound.overlaps)
    return false;
  kept.swap(buffers.found);
  kept_overlaps = buffers.found_overlaps;
  kept_valid = true;
  kept_moving = buffers.found_valid = false;
  return true;
}

void HGrid::Engine::keepPairs() {
  if (!pairs_wanted.load(std::memory_order_relaxed)) return;
  // kept_overlaps still counts the overlaps of boxes that have left their layer. If kept_overlaps is large, a new
  // search corrects its value.
  if (!kept_valid && keepFound()) kept_dirty = true;
  if (!kept_valid || (kept_dirty && kept_overlaps > bound.overlaps / 2)) {
    kept_valid = false;
    try {
      findKept();
    } catch (const std::bad_alloc&) {
      return;  // without the kept pairs, each search finds these pairs itself
    }
  } else if (kept_dirty) {
    kept.erase(std::remove_if(kept.begin(), kept.end(), [this](const ProxyPair& pair) { return !isKept(pair); }),
               kept.end());
  }
  kept_dirty = false;
}

}  // namespace hgrid
