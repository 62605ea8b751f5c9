// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Scene::commit(): makes a snapshot of the bodies and poses in a scene.
#include <algorithm>

#include "hgrid_proximity/geometry/float_environment.h"
#include "world/pair_margin.h"
#include "world/scene_state.h"

namespace hgrid {
namespace {

/// Returns how far [m] a point of the body may have moved since its pose was taken; 0 if the pose is not old. If a
/// frame is updated rarely, the pose can be old although the state is still FRESH or LATE.
double reachOf(const BodyPose& pose, const Body& body, double growth_after) {
  const bool old = pose.state >= Freshness::stale || pose.age > growth_after;
  if (!old || pose.state == Freshness::unplaced || !(pose.age > 0.0)) return 0.0;
  return body.max_speed * pose.age;
}

/// Returns how far [m] a point of the body may move until the next pose of a source on time; 0 if such a pose comes
/// before the body counts as old.
double reachInPeriod(const BodyPose& pose, const Body& body, double growth_after) {
  if (pose.state == Freshness::unplaced || !(pose.period > growth_after)) return 0.0;
  return body.max_speed * pose.period;
}

constexpr std::uint32_t kAhead = 8;  // how many bodies before its turn a body is loaded into the processor's cache

/// Starts to load the shapes of a body, because other work removes them from the cache between commits. This function
/// is always inlined, because gcc removes the calls of a function that only prefetches.
[[gnu::always_inline]] inline void prefetchShapes(const SceneStructure& structure, std::uint32_t body) {
  for (std::uint32_t proxy = structure.first_proxy[body]; proxy < structure.first_proxy[body + 1]; ++proxy) {
    const char* const shape = reinterpret_cast<const char*>(structure.shapes[proxy]);
    for (std::size_t at = 0; at < sizeof(BodyShape); at += 64) __builtin_prefetch(shape + at);
  }
}

/// Finds the bodies of an earlier structure by their handles.
class BodiesBefore {
 public:
  BodiesBefore(const Structure& before, std::size_t slots) : before_(before), of_slot_(slots, Structure::kNone) {
    for (std::uint32_t body = 0; body < before.ids.size(); ++body) of_slot_[before.ids[body].slot] = body;
  }
  /// Returns the index of a body in the earlier structure, or kNone.
  std::uint32_t find(const BodyId& id) const {
    const std::uint32_t body = of_slot_[id.slot];
    return body != Structure::kNone && before_.ids[body] == id ? body : Structure::kNone;
  }

 private:
  const Structure& before_;
  std::vector<std::uint32_t> of_slot_;
};

}  // namespace

std::shared_ptr<PooledSnapshot> Scene::State::freshSnapshot() const {
  std::unique_ptr<PooledSnapshot> pooled = pool->take();
  if (!pooled) pooled = std::make_unique<PooledSnapshot>();
  pooled->finished = false;
  const auto give_back = [kept = pool](PooledSnapshot* used) {
    std::unique_ptr<PooledSnapshot> owned(used);
    if (owned->finished) kept->giveBack(std::move(owned));
  };
  return {pooled.release(), give_back, PoolAllocator<PooledSnapshot>(pool)};
}

/// Computes the boxes of a body from its pose.
void Scene::State::makeBoxes(std::size_t body, const Pose& world_from_body, Snapshot& snapshot) const {
  for (std::uint32_t proxy = structure->first_proxy[body]; proxy < structure->first_proxy[body + 1]; ++proxy) {
    const BodyShape& shape = *structure->shapes[proxy];
    snapshot.boxes_[proxy] = boxOf(shape.shape, world_from_body * shape.body_from_shape, shape.padding, options.origin);
  }
}

/// Fills the pose of a body.
void Scene::State::fillPose(std::uint32_t body, Snapshot& snapshot) const {
  BodyPose& pose = snapshot.poses_[body];
  pose = slots[structure->ids[body].slot].pose;
  const Body& what = structure->bodies[body];
  pose.reach = reachOf(pose, what, options.growth_after);
  pose.growth = std::min(std::max(pose.reach, reachInPeriod(pose, what, options.growth_after)), options.growth_cap);
}

/// Computes the boxes of a body if it has moved since the last commit. @returns whether it has
bool Scene::State::fillBoxes(std::uint32_t body, Snapshot& snapshot) {
  const Slot& slot = slots[structure->ids[body].slot];
  if (!slot.moved || slot.pose.state == Freshness::unplaced) return false;
  makeBoxes(body, slot.pose.world_from_body, snapshot);
  boxed.push_back(structure->ids[body].slot);
  return true;
}

/// Copies the boxes of the bodies that were in the last snapshot, whose structure was another one.
void Scene::State::keepBoxes(Snapshot& snapshot) const {
  const Structure& earlier = *last->structure_;
  const BodiesBefore before(earlier, slots.size());
  for (std::size_t body = 0; body < structure->ids.size(); ++body) {
    const std::uint32_t known = before.find(structure->ids[body]);
    if (known == Structure::kNone) continue;
    std::copy(last->boxes_.begin() + earlier.first_proxy[known], last->boxes_.begin() + earlier.first_proxy[known + 1],
              snapshot.boxes_.begin() + structure->first_proxy[body]);
  }
}

/// Fills all poses and boxes. If a body did not move since the last commit, copies its boxes from the last snapshot.
void Scene::State::fillAllBodies(Snapshot& snapshot) {
  snapshot.poses_.resize(structure->ids.size());
  if (last && last->structure_ == structure) {
    snapshot.boxes_ = last->boxes_;
  } else {
    snapshot.boxes_.assign(structure->body_of_proxy.size(), Aabb{});
    if (last) keepBoxes(snapshot);
  }
  for (std::uint32_t body = 0; body < structure->ids.size(); ++body) {
    if (body + kAhead < structure->ids.size()) prefetchShapes(*structure, body + kAhead);
    fillBoxes(body, snapshot);
    fillPose(body, snapshot);
  }
}

/// Fills the poses and boxes that changed since this snapshot object was used. The others are still right.
void Scene::State::fillChangedBodies(Snapshot& snapshot) {
  const auto fill = [&](std::uint32_t slot) {
    const std::uint32_t body = body_of_slot[slot];
    fillPose(body, snapshot);
    const auto first = static_cast<std::ptrdiff_t>(structure->first_proxy[body]);
    const auto end = static_cast<std::ptrdiff_t>(structure->first_proxy[body + 1]);
    std::copy(last->boxes_.begin() + first, last->boxes_.begin() + end, snapshot.boxes_.begin() + first);
  };
  changes.visitSince(since, fill);
  for (const std::uint32_t slot : changes.now()) {
    const std::uint32_t body = body_of_slot[slot];
    if (fillBoxes(body, snapshot)) {
      fillPose(body, snapshot);
    } else {
      fill(slot);
    }
  }
}

/// Computes the values of the snapshot that depend on the states and ages of all bodies. Looks only at the bodies that
/// were watched in the last commit and at those that changed, if the snapshot object is known.
void Scene::State::summarizePoses(Snapshot& snapshot) {
  snapshot.clearSummary();
  if (since == 0) {
    for (std::uint32_t body = 0; body < snapshot.poses_.size(); ++body) snapshot.addToSummary(body);
  } else {
    for (const std::uint32_t body : last->watched_) snapshot.addToSummary(body);
    for (const std::uint32_t slot : changes.now()) {
      if (!is_watched[body_of_slot[slot]]) snapshot.addToSummary(body_of_slot[slot]);
    }
  }
  const auto is_unplaced = [&](std::uint32_t body) { return snapshot.poses_[body].state == Freshness::unplaced; };
  unplaced = static_cast<std::size_t>(std::count_if(snapshot.watched_.begin(), snapshot.watched_.end(), is_unplaced));
}

/// Fills poses and boxes. If this snapshot object was used a few commits ago and few bodies changed since, writes only
/// those.
void Scene::State::fillBodies(Snapshot& snapshot) {
  const bool known = snapshot.structure_ == structure && last && last->structure_ == structure;
  const bool few =
      known && changes.covers(snapshot.commit_) && changes.countSince(snapshot.commit_) <= structure->ids.size() / 2;
  since = few ? snapshot.commit_ : 0;
  snapshot.structure_ = structure;
  snapshot.commit_ = commits + 1;
  boxed.clear();
  boxed.reserve(structure->ids.size());
  if (since == 0) {
    fillAllBodies(snapshot);
  } else {
    fillChangedBodies(snapshot);
  }
  summarizePoses(snapshot);
  snapshot.cells_.clear();
  for (const std::uint32_t map : structure->maps) {
    snapshot.cells_.push_back(cells[structure->ids[map].slot]);
  }
  snapshot.fillHalfSpaces();
  horizon.step(structure, snapshot.poses_, snapshot.boxes_, snapshot.stamp_);
}

void Scene::State::addPair(std::uint32_t first, std::uint32_t second, double gap, double margin, bool near) {
  const bool odd = horizon.teleported(first) || horizon.teleported(second);
  const auto flags = static_cast<std::uint8_t>((near ? 0 : kHorizonFlag) | (odd ? kTeleportFlag : 0));
  choice.collected().push_back({first, second, near ? std::min(gap, margin) : gap, margin, Time{0}, flags});
}

/// Returns whether a pair of bodies would be listed if there were no limit.
bool Scene::State::isCandidate(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second) {
  const BodyPose &a = snapshot.poses_[first], &b = snapshot.poses_[second];
  if (a.state == Freshness::unplaced || b.state == Freshness::unplaced) return false;
  if (structure->filter.allowed(first, second) || snapshot.areSeparate(first, second)) return false;
  if (structure->isMap(first) || structure->isMap(second)) return map_pairs.isNear(snapshot, horizon, first, second);
  if (plane_pairs.isNear(snapshot, horizon, first, second)) return true;
  const double margin = pairMargin(*structure, first, stalenessOf(a), second, stalenessOf(b));
  for (ProxyId i = structure->first_proxy[first]; i < structure->first_proxy[first + 1]; ++i) {
    for (ProxyId j = structure->first_proxy[second]; j < structure->first_proxy[second + 1]; ++j) {
      if (structure->isPlane(i) || structure->isPlane(j)) continue;
      const Aabb &one = snapshot.boxes_[i], &other = snapshot.boxes_[j];
      if (withinDistance(one, other, margin)) return true;
      if (horizon.on() && horizon.canMeet(*structure, i, j, distance(one, other), margin)) return true;
    }
  }
  return false;
}

/// Returns the bodies whose poses or states changed since the last commit.
const std::vector<std::uint32_t>& Scene::State::changedBodies() {
  changed_bodies.clear();
  for (const std::uint32_t slot : changes.now()) {
    if (body_of_slot[slot] != Structure::kNone) changed_bodies.push_back(body_of_slot[slot]);
  }
  return changed_bodies;
}

void Scene::State::fillPairs(Snapshot& snapshot) {
  choice.collected().clear();
  for (const ProxyPair& proxies : proxy_pairs) {
    // The ids of proxies are in the order of their bodies, so `first` is never larger than `second`.
    const std::uint32_t first = structure->body_of_proxy[proxies.first],
                        second = structure->body_of_proxy[proxies.second];
    if (snapshot.areSeparate(first, second)) continue;
    const Aabb &a = snapshot.boxes_[proxies.first], &b = snapshot.boxes_[proxies.second];
    const double margin = pairMargin(*structure, first, stalenessOf(snapshot.poses_[first]), second,
                                     stalenessOf(snapshot.poses_[second]));
    const bool near = withinDistance(a, b, margin);
    if (!near && !horizon.on()) continue;
    const double gap = distance(a, b);
    if (!near && !horizon.canMeet(*structure, proxies.first, proxies.second, gap, margin)) continue;
    addPair(first, second, gap, margin, near);
  }
  const auto add = [&](std::uint32_t first, std::uint32_t second, double gap, double margin, bool near) {
    addPair(first, second, gap, margin, near);
  };
  const bool all_with_maps = map_pairs.find(snapshot, horizon, limits.collected, add);
  const bool all_with_planes = plane_pairs.find(snapshot, horizon, changedBodies(), limits.collected, add);
  snapshot.search_cut_ = snapshot.search_cut_ || !all_with_maps || !all_with_planes;
  snapshot.pairs_found_ = choice.list(structure->bodies.size(), limits.listed, snapshot.pairs_);
  IsCut is_cut;
  if (snapshot.truncated()) {
    is_cut = [&](std::uint32_t first, std::uint32_t second) { return isCandidate(snapshot, first, second); };
  }
  tracker.update(structure->ids, snapshot.stamp_, snapshot.pairs_, is_cut);
  pair_events.update(
      {structure, snapshot.poses_, snapshot.boxes_, snapshot.pairs_, snapshot.worst_state_, snapshot.max_growth_,
       snapshot.stamp_,
       [&](std::uint32_t first, std::uint32_t second, double up_to) { return snapshot.gapOf(first, second, up_to); },
       is_cut, snapshot.rooms()},
      snapshot.events_);
}

/// Accepts the snapshot: the next commit starts from it. Allocates no memory, so it cannot fail.
void Scene::State::accept(const std::shared_ptr<PooledSnapshot>& accepted) {
  PooledSnapshot& pooled = *accepted;
  horizon.accept();
  map_pairs.accept();
  plane_pairs.accept();
  tracker.accept();
  pair_events.accept();
  for (const std::uint32_t slot : boxed) slots[slot].moved = false;
  changes.accept();
  if (last && last->structure_ == structure) {
    for (const std::uint32_t body : last->watched_) is_watched[body] = false;
  }
  for (const std::uint32_t body : pooled.snapshot.watched_) is_watched[body] = true;
  commits = pooled.snapshot.commit_;
  sequence = pooled.snapshot.sequence_;
  pooled.finished = true;
  last = {accepted, &pooled.snapshot};
  pool->keepOnly(structure->revision);
}

std::shared_ptr<const Snapshot> Scene::commit(Time stamp, const std::vector<SourceGap>& gaps) {
  const DefaultFloatEnvironment environment;
  using Clock = std::chrono::steady_clock;
  State& s = *state_;
  const auto begin = Clock::now();
  if (s.isOutdated()) s.renewStructure();
  const std::shared_ptr<PooledSnapshot> pooled = s.freshSnapshot();
  Snapshot& snapshot = pooled->snapshot;
  snapshot.origin_ = s.options.origin;
  snapshot.stamp_ = stamp;
  snapshot.report_unmapped_ = s.options.report_unmapped;
  s.fillBodies(snapshot);
  s.growBoxes(snapshot);
  s.findRooms(snapshot);
  const auto boxes_done = Clock::now();
  s.fillGrid(*pooled);
  const auto grid_done = Clock::now();
  s.fillPairs(snapshot);
  snapshot.sequence_ = s.sequence + 1;
  snapshot.epoch_ = s.epoch;
  s.fillCompleteness(snapshot, gaps);
  s.accept(pooled);
  s.times = {boxes_done - begin, grid_done - boxes_done, Clock::now() - grid_done};
  return s.last;
}

}  // namespace hgrid
