// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <atomic>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "test/support/expectations.h"

namespace hgrid {
namespace test {

/// A filter that keeps only pairs whose ids add up to a multiple of `divisor`. It counts the pairs that it receives.
struct Divisible {
  ProxyId divisor = 1;
  mutable std::atomic<std::size_t> asked{0};

  static bool isKept(const void* context, ProxyId first, ProxyId second) {
    const auto& filter = *static_cast<const Divisible*>(context);
    ++filter.asked;
    return (first + second) % filter.divisor == 0;
  }
  OverlapFilter filter() const { return OverlapFilter::of<isKept>(this); }
};

/// The boxes (the id of a box is its index) and the settings of a search for pairs with a bound.
struct Task {
  std::vector<Aabb> boxes;
  std::vector<ProxyId> fixed;
  ProxyId divisor = 1;
  PairBound bound;
};

struct Found {
  Pairs pairs;  // sorted
  bool all = true;
  bool operator==(const Found& other) const { return pairs == other.pairs && all == other.all; }
};

/// Computes the pairs that the comment of PairBound promises, by a scan of all pairs.
inline Found ruleOf(const Task& task) {
  Found found;
  std::vector<bool> fixed(task.boxes.size());
  for (const ProxyId id : task.fixed) fixed[id] = true;
  std::size_t overlaps = 0;
  const auto collect = [&](ProxyId asker, ProxyId other) {
    if (++overlaps > task.bound.overlaps) return false;
    if ((asker + other) % task.divisor != 0) return true;
    if (found.pairs.size() == task.bound.pairs) return false;
    found.pairs.emplace_back(std::min(asker, other), std::max(asker, other));
    return true;
  };
  for (ProxyId asker = 0; asker < task.boxes.size() && found.all; ++asker) {
    if (fixed[asker]) continue;
    for (ProxyId other = 0; other < task.boxes.size() && found.all; ++other) {
      if (other == asker || !(fixed[other] || other > asker)) continue;
      if (overlap(task.boxes[asker], task.boxes[other])) found.all = collect(asker, other);
    }
  }
  std::sort(found.pairs.begin(), found.pairs.end());
  return found;
}

inline Found boundedPairsOf(const BroadPhaseReader& tested) {
  std::vector<ProxyPair> pairs = {{7, 7}};  // the search must replace this old content
  Found found;
  found.all = tested.boundedPairs(pairs);
  for (const ProxyPair& pair : pairs) found.pairs.emplace_back(pair.first, pair.second);
  std::sort(found.pairs.begin(), found.pairs.end());
  return found;
}

inline void setUp(BroadPhase& tested, const Task& task, const Divisible& divisible) {
  tested.setFixed(task.fixed);
  tested.setOverlapFilter(divisible.filter());
  tested.setPairBound(task.bound);
}

/// Stores the boxes of a task by a random sequence of calls.
inline void bringTo(BroadPhase& tested, const Task& task, Random& random) {
  std::vector<ProxyId> ids = allIds(task.boxes.size());
  if (random.chance(0.3)) {  // one by one, in random order
    for (std::size_t i = ids.size(); i > 1; --i) std::swap(ids[i - 1], ids[std::size_t(random.below(int(i)))]);
    for (const ProxyId id : ids) tested.insert(id, task.boxes[id]);
    return;
  }
  std::vector<Aabb> before = task.boxes;
  const double share = random.chance(0.5) ? 0.1 : 0.8;  // fraction of the boxes that move
  for (Aabb& box : before) {
    if (random.chance(share)) box = task.boxes[std::size_t(random.below(int(task.boxes.size())))];
  }
  std::vector<ProxyPair> pairs;
  tested.update(ids, before);
  if (random.chance(0.7)) tested.boundedPairs(pairs);  // after this search, HGrid keeps the pairs of resting boxes
  tested.update(ids, task.boxes);
  for (int i = random.below(4); i > 0; --i) {  // moves some boxes away and back
    const ProxyId id = ProxyId(random.below(int(ids.size())));
    tested.move({id}, {before[id]});
    if (random.chance(0.5)) tested.boundedPairs(pairs);
    tested.move({id}, {task.boxes[id]});
  }
}

/// Returns a random task. Many of its boxes are at one place, the others at random places.
inline Task randomTask(unsigned seed, Random& random) {
  Task task;
  task.boxes = worldOf(static_cast<Family>(seed % kFamilies), seed);
  if (task.boxes.empty()) task.boxes.push_back(boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  const Aabb pile = task.boxes.front();
  for (Aabb& box : task.boxes) {
    if (random.chance(0.5)) box = pile;
  }
  for (const ProxyId id : allIds(task.boxes.size())) {
    if (random.chance(0.3)) task.fixed.push_back(id);
  }
  task.divisor = ProxyId(random.between(1, 3));
  const Found all = ruleOf(task);
  const auto part = [&](std::size_t whole) {
    return random.chance(0.3) ? PairBound::kNone : std::size_t(random.below(int(whole + whole / 4 + 2)));
  };
  task.bound.pairs = part(all.pairs.size());
  task.bound.overlaps = part(all.pairs.size() * task.divisor);
  return task;
}

}  // namespace test
}  // namespace hgrid
