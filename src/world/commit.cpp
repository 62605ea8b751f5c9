// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Scene::commit(): makes a snapshot of the bodies and poses in a scene.
#include <algorithm>

#include "hgrid_proximity/broadphase/partitions.h"
#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
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

/// Returns the box of a shape in its own frame, grown by half of the margin. The grid chooses its cells by these boxes.
Aabb sizeOf(const BodyShape& shape, double margin) {
  return grown(boxOf(shape.shape, Pose::Identity(), shape.padding, Eigen::Vector3d::Zero()), 0.5 * margin);
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

/// The overlap filter of the grid: keeps the pairs of proxies whose bodies the pair filter reports.
bool isReported(const void* structure, ProxyId first, ProxyId second) {
  const Structure& s = *static_cast<const Structure*>(structure);
  return !s.filter.allowed(s.body_of_proxy[first], s.body_of_proxy[second]);
}

}  // namespace

/// Returns the filter of the next structure. Uses an earlier filter with the same rules, if there is one.
/// @param next   the bodies of the next structure
/// @param known  for each of them: its index in the present structure, or Structure::kNone
PairFilter Scene::State::filterFor(const BodyList& next, const std::vector<std::uint32_t>& known) const {
  static_assert(PairFilter::kUnknown == Structure::kNone);
  const PairFilter* earlier = nullptr;
  if (!rules_changed) earlier = &structure->filter;
  if (prepared && prepared->revision == structure->revision) earlier = &prepared->filter;
  if (earlier == nullptr) return PairFilter(next, options.pair_kinds, options.allowed_pairs);
  return bodies_changed ? earlier->forBodies(next, known) : *earlier;
}

void Scene::State::rebuildStructure() {
  auto next = std::make_shared<Structure>();
  next->revision = structure->revision + 1;
  next->least_margin = options.margin;
  const BodiesBefore before(*structure, slots.size());
  std::vector<Aabb> next_sizes;
  std::vector<std::uint32_t> next_uncovered, known_bodies;
  std::vector<ShapeInBody> next_shapes;
  std::vector<std::uint32_t> next_body_of_slot(slots.size(), Structure::kNone);
  next->bodies.reserve(slot_of_name.size());
  next_shapes.reserve(slot_of_name.size());
  next_sizes.reserve(slot_of_name.size());
  for (const auto& named : slot_of_name) {
    const Body& body = *bodies[named.second];
    if (!body.covered && !body.waived) next_uncovered.push_back(static_cast<std::uint32_t>(next->bodies.size()));
    next->first_proxy.push_back(static_cast<std::uint32_t>(next->body_of_proxy.size()));
    next->body_of_proxy.insert(next->body_of_proxy.end(), body.shapes.size(),
                               static_cast<std::uint32_t>(next->bodies.size()));
    if (hasCells(body.kind)) next->maps.push_back(static_cast<std::uint32_t>(next->bodies.size()));
    next_body_of_slot[named.second] = static_cast<std::uint32_t>(next->bodies.size());
    next->bodies.push_back(bodies[named.second]);
    next->ids.push_back({named.second, slots[named.second].generation});
    next->margin.push_back(std::max(options.margin, body.margin));
    const std::uint32_t known = before.find(next->ids.back());
    known_bodies.push_back(known);
    for (std::size_t i = 0; i < body.shapes.size(); ++i) {
      const BodyShape& shape = body.shapes[i];
      if (shape.shape.kind() == ShapeKind::plane) next->planes.push_back(static_cast<ProxyId>(next_shapes.size()));
      next_shapes.push_back({shape.shape, shape.body_from_shape, shape.padding});
      const bool has_size = known != Structure::kNone && !sizes_changed;
      next_sizes.push_back(has_size ? sizes[structure->first_proxy[known] + i] : sizeOf(shape, options.margin));
    }
  }
  next->first_proxy.push_back(static_cast<std::uint32_t>(next->body_of_proxy.size()));
  next->pair_margins = PairMargins(next->bodies, options.pair_margins);
  next->filter = filterFor(next->bodies, known_bodies);
  next->silenced = silencesAll(next->bodies, options.pair_kinds, next->filter);
  std::vector<ProxyId> next_fixed;
  for (ProxyId proxy = 0; proxy < next->body_of_proxy.size(); ++proxy) {
    const bool fixed = next->bodies[next->body_of_proxy[proxy]].mobility == Mobility::fixed;
    if (fixed && !next->isPlane(proxy)) next_fixed.push_back(proxy);
  }
  fillSources(*next);
  std::vector<bool> next_is_watched(next->bodies.size());
  // The code below allocates no memory, so it cannot fail.
  uncovered.swap(next_uncovered);
  shapes.swap(next_shapes);
  sizes.swap(next_sizes);
  fixed_proxies.swap(next_fixed);
  body_of_slot.swap(next_body_of_slot);
  watched.clear();
  is_watched.swap(next_is_watched);
  structure = std::move(next);
  scale = GridScale::fitting(sizes);  // the smallest box counts, so the huge boxes of planes do not matter
  if (options.finest_edge > 0.0) scale.finest_edge = options.finest_edge;
  structure_changed = bodies_changed = rules_changed = sizes_changed = false;
  prepared.reset();
}

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
    const ShapeInBody& shape = shapes[proxy];
    snapshot.boxes_[proxy] = boxOf(shape.shape, world_from_body * shape.body_from_shape, shape.padding, options.origin);
  }
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

/// Fills the pose of a body.
void Scene::State::fillPose(std::uint32_t body, Snapshot& snapshot) const {
  BodyPose& pose = snapshot.poses_[body];
  pose = slots[structure->ids[body].slot].pose;
  pose.reach = reachOf(pose, structure->bodies[body], options.growth_after);
  pose.growth = std::min(pose.reach, options.growth_cap);
}

/// Computes the boxes of a body if it has moved since the last commit. @returns whether it has
bool Scene::State::fillBoxes(std::uint32_t body, Snapshot& snapshot) {
  const Slot& slot = slots[structure->ids[body].slot];
  if (!slot.moved || slot.pose.state == Freshness::unplaced) return false;
  makeBoxes(body, slot.pose.world_from_body, snapshot);
  boxed.push_back(structure->ids[body].slot);
  return true;
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

/// Computes the values of the snapshot that depend on the states and ages of all bodies. A fresh body whose pose has no
/// age has no influence on them.
void Scene::State::summarizePoses(Snapshot& snapshot) {
  snapshot.worst_state_ = Freshness::fresh;
  snapshot.max_age_ = snapshot.max_growth_ = snapshot.max_reach_ = 0.0;
  next_watched.clear();
  unplaced = 0;
  const auto add = [&](std::uint32_t body) {
    const BodyPose& pose = snapshot.poses_[body];
    if (pose.state == Freshness::fresh && pose.age == 0.0 && pose.reach == 0.0) return;
    next_watched.push_back(body);
    snapshot.worst_state_ = std::max(snapshot.worst_state_, pose.state);
    snapshot.max_growth_ = std::max(snapshot.max_growth_, pose.growth);
    snapshot.max_reach_ = std::max(snapshot.max_reach_, pose.reach);
    if (pose.state == Freshness::unplaced) {
      ++unplaced;
    } else {
      snapshot.max_age_ = std::max(snapshot.max_age_, pose.age);
    }
  };
  if (since == 0) {
    for (std::uint32_t body = 0; body < snapshot.poses_.size(); ++body) add(body);
  } else {
    for (const std::uint32_t body : watched) add(body);
    for (const std::uint32_t slot : changes.now()) {
      if (!is_watched[body_of_slot[slot]]) add(body_of_slot[slot]);
    }
  }
  snapshot.watched_ = next_watched;
}

void Scene::State::fillHalfSpaces(Snapshot& snapshot) const {
  snapshot.half_spaces_.clear();
  for (const ProxyId plane : structure->planes) {
    const ShapeInBody& shape = shapes[plane];
    const Pose& world_from_body = snapshot.poses_[structure->body_of_proxy[plane]].world_from_body;
    snapshot.half_spaces_.push_back(
        halfSpaceOf(world_from_body * shape.body_from_shape, shape.padding, options.origin));
  }
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
  fillHalfSpaces(snapshot);
  horizon.step(structure, snapshot.poses_, snapshot.boxes_, snapshot.stamp_);
}

/// Grows the box of a proxy of a placed body by its share of the margins. Keeps the grown box of an earlier commit if
/// it was computed from the same box and the same length.
void Scene::State::growBox(const Snapshot& snapshot, ProxyId proxy, std::size_t position) {
  const std::uint32_t body = structure->body_of_proxy[proxy];
  const double own = std::max(structure->margin[body], structure->pair_margins.largestOf(body));
  const double can_go = horizon.reachOf(body);
  const double by = 0.5 * options.margin + (own - options.margin) + snapshot.poses_[body].growth + can_go;
  const Aabb& box = horizon.on() ? horizon.swept(proxy) : snapshot.boxes_[proxy];
  GrownFrom& from = grown_from[position];
  if (from.by == by && from.box == box) return;
  from = {box, by};
  grown_boxes[position] = grown(box, by);
  grown_in[position] = commits + 1;
}

/// Grows the boxes of placed bodies by their shares of the margins. Then two boxes overlap if their gap is at most the
/// margin of their pair plus the growth of both bodies. The share of a body is half of the global margin. If the margin
/// of the body or of one of its pairs is larger than the global margin, the whole difference is added.
void Scene::State::growBoxes(const Snapshot& snapshot) {
  if (grown_revision == structure->revision && grown_unplaced == unplaced && !horizon.on()) {
    for (const std::uint32_t slot : changes.now()) {
      const std::uint32_t body = body_of_slot[slot];
      if (body == Structure::kNone) continue;  // it was removed, and then a commit failed
      if (snapshot.poses_[body].state == Freshness::unplaced) continue;
      for (ProxyId proxy = structure->first_proxy[body]; proxy < structure->first_proxy[body + 1]; ++proxy) {
        if (structure->isPlane(proxy)) continue;
        growBox(snapshot, proxy, position_of[proxy]);
      }
    }
    return;
  }
  grown_revision = 0;
  const std::size_t most = snapshot.boxes_.size();
  ids.resize(most);
  grown_from.resize(most);
  grown_boxes.resize(most);
  grown_in.resize(most);
  position_of.resize(most);
  std::size_t count = 0;
  for (ProxyId proxy = 0; proxy < most; ++proxy) {
    if (snapshot.poses_[structure->body_of_proxy[proxy]].state == Freshness::unplaced) continue;
    if (structure->isPlane(proxy)) continue;
    position_of[proxy] = static_cast<std::uint32_t>(count);
    growBox(snapshot, proxy, count);
    ids[count++] = proxy;
  }
  ids.resize(count);
  grown_from.resize(count);
  grown_boxes.resize(count);
  grown_in.resize(count);
  grown_revision = structure->revision;
  grown_unplaced = unplaced;
}

/// Moves only the boxes in the grid that changed since the grid was used. @returns false if that is not possible, or if
/// most boxes changed; then the grid is as it was
bool Scene::State::moveInGrid(BroadPhase& grid) {
  if (since == 0 || horizon.on() || grid.size() != ids.size()) return false;
  regrown.clear();
  const auto add = [&](std::uint32_t slot) {
    const std::uint32_t body = body_of_slot[slot];
    if (slots[slot].pose.state == Freshness::unplaced) return;
    for (ProxyId proxy = structure->first_proxy[body]; proxy < structure->first_proxy[body + 1]; ++proxy) {
      if (!structure->isPlane(proxy) && grown_in[position_of[proxy]] > since) regrown.push_back(proxy);
    }
  };
  changes.visitSince(since, add);
  for (const std::uint32_t slot : changes.now()) add(slot);
  if (regrown.size() > ids.size() / 4) return false;
  std::sort(regrown.begin(), regrown.end());
  regrown.erase(std::unique(regrown.begin(), regrown.end()), regrown.end());
  regrown_boxes.clear();
  for (const ProxyId proxy : regrown) regrown_boxes.push_back(grown_boxes[position_of[proxy]]);
  grid.move(regrown, regrown_boxes);
  return true;
}

/// Stores the grown boxes in the grid. Finds the overlapping pairs that the filter keeps, up to the limit.
void Scene::State::fillGrid(PooledSnapshot& pooled) {
  if (pooled.grid_revision != structure->revision) {
    pooled.setBroadPhase(makeBroadPhase({options.broad_phase, scale.finest_edge, options.threads}));
    BroadPhase& grid = *pooled.broad_phase;
    grid.setFixed(fixed_proxies);
    grid.setOverlapFilter(OverlapFilter::of<isReported>(structure.get()));  // the snapshot keeps the structure alive
    grid.setPairBound(limits.boundOf(structure->body_of_proxy.size()));
    pooled.grid_revision = structure->revision;
  }
  BroadPhase& grid = *pooled.broad_phase;
  const auto* hgrid = dynamic_cast<const HGrid*>(&grid);
  threads = hgrid != nullptr ? hgrid->threads() : 1;
  if (!moveInGrid(grid)) grid.update(ids, grown_boxes);
  pooled.snapshot.search_cut_ = !grid.boundedPairs(proxy_pairs);
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
  if (structure->filter.allowed(first, second)) return false;
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
       is_cut},
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
  for (const std::uint32_t body : watched) is_watched[body] = false;
  watched.swap(next_watched);
  for (const std::uint32_t body : watched) is_watched[body] = true;
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
  if (s.structure_changed) s.rebuildStructure();
  const std::shared_ptr<PooledSnapshot> pooled = s.freshSnapshot();
  Snapshot& snapshot = pooled->snapshot;
  snapshot.origin_ = s.options.origin;
  snapshot.stamp_ = stamp;
  snapshot.report_unmapped_ = s.options.report_unmapped;
  s.fillBodies(snapshot);
  s.growBoxes(snapshot);
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
