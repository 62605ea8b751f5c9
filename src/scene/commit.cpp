// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The making of a snapshot from what the scene was told.
#include <algorithm>

#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
#include "scene/pair_margin.h"
#include "scene/scene_state.h"

namespace hgrid {
namespace {

/// [m] How far a body can have gone since its pose, where that is old. A frame that comes seldom is old before its
/// state says so.
double growthOf(const BodyPose& pose, const Body& body, const SceneOptions& options) {
  const bool old = pose.state >= Freshness::stale || pose.age > options.growth_after;
  if (!old || pose.state == Freshness::unplaced || !(pose.age > 0.0)) return 0.0;
  return std::min(body.max_speed * pose.age, options.growth_cap);
}

/// Why a body makes the world incomplete; empty if it does not.
std::string gapLeftBy(const Body& body, const BodyPose& pose) {
  if (pose.state == Freshness::unplaced) {
    return "UNPLACED " + body.name + ": it never had a pose (frame '" + printable(body.frame) + "')";
  }
  if (!body.covered && !body.waived) return "UNCOVERED " + body.name + ": " + body.note;
  if (pose.state >= Freshness::lost) {
    return std::string(name(pose.state)) + " " + body.name + (isCloud(body) ? ": what it saw is " : ": its pose is ") +
           secondsText(pose.age) + " old (frame '" + printable(body.frame) + "')";
  }
  return {};
}

/// Whether the grid may report a pair of proxies: its filter.
bool isReported(const void* structure, ProxyId first, ProxyId second) {
  const Structure& s = *static_cast<const Structure*>(structure);
  return !s.filter.allowed(s.body_of_proxy[first], s.body_of_proxy[second]);
}

}  // namespace

void Scene::State::rebuildStructure() {
  auto next = std::make_shared<Structure>();
  next->revision = structure->revision + 1;
  next->least_margin = options.margin;
  std::vector<Aabb> sizes;
  uncovered.clear();
  shapes.clear();
  for (const auto& named : slot_of_name) {
    slots[named.second].moved = true;  // its proxies may have other numbers now
    const Body& body = bodies[named.second];
    if (!body.covered && !body.waived) uncovered.push_back(static_cast<std::uint32_t>(next->bodies.size()));
    next->first_proxy.push_back(static_cast<std::uint32_t>(next->body_of_proxy.size()));
    next->body_of_proxy.insert(next->body_of_proxy.end(), body.shapes.size(),
                               static_cast<std::uint32_t>(next->bodies.size()));
    if (body.kind == BodyKind::map) next->maps.push_back(static_cast<std::uint32_t>(next->bodies.size()));
    next->bodies.push_back(body);
    next->ids.push_back({named.second, slots[named.second].generation});
    next->margin.push_back(std::max(options.margin, body.margin));
    for (const BodyShape& shape : body.shapes) {
      shapes.push_back({shape.shape, shape.body_from_shape, shape.padding});
      sizes.push_back(
          grown(boxOf(shape.shape, Pose::Identity(), shape.padding, Eigen::Vector3d::Zero()), 0.5 * options.margin));
    }
  }
  next->first_proxy.push_back(static_cast<std::uint32_t>(next->body_of_proxy.size()));
  boxes.assign(shapes.size(), Aabb{});
  next->pair_margins = PairMargins(next->bodies, options.pair_margins);
  next->filter = PairFilter(next->bodies, options.pair_kinds, options.allowed_pairs);
  next->silenced = silencesAll(next->bodies, options.pair_kinds, next->filter);
  fixed_proxies.clear();
  for (ProxyId proxy = 0; proxy < next->body_of_proxy.size(); ++proxy) {
    if (next->bodies[next->body_of_proxy[proxy]].mobility == Mobility::fixed) fixed_proxies.push_back(proxy);
  }
  structure = std::move(next);
  scale = GridScale::fitting(sizes);
  if (options.finest_edge > 0.0) scale.finest_edge = options.finest_edge;
  structure_changed = false;
}

std::shared_ptr<Snapshot> Scene::State::freshSnapshot() const {
  std::unique_ptr<Snapshot> snapshot = pool->take();
  if (!snapshot) snapshot.reset(new Snapshot);
  return {snapshot.release(), [kept = pool](Snapshot* used) { kept->giveBack(std::unique_ptr<Snapshot>(used)); },
          PoolAllocator<Snapshot>(pool)};
}

/// Makes the boxes of what moved since the last commit; what stands still keeps its own. Of the poses a snapshot that
/// was used before takes those that changed since then.
void Scene::State::fillBodies(Snapshot& snapshot) {
  const std::uint64_t known = snapshot.structure_ == structure ? snapshot.commit_ : 0;
  snapshot.structure_ = structure;
  snapshot.commit_ = ++commits;
  snapshot.poses_.resize(structure->ids.size());
  snapshot.worst_state_ = Freshness::fresh;
  snapshot.max_age_ = snapshot.max_growth_ = 0.0;
  for (std::size_t i = 0; i < structure->ids.size(); ++i) {
    Slot& slot = slots[structure->ids[i].slot];
    const bool placed = slot.pose.state != Freshness::unplaced;
    if (slot.moved && placed) {
      slot.moved = false;
      for (std::uint32_t proxy = structure->first_proxy[i]; proxy < structure->first_proxy[i + 1]; ++proxy) {
        const ShapeInBody& shape = shapes[proxy];
        boxes[proxy] =
            boxOf(shape.shape, slot.pose.world_from_body * shape.body_from_shape, shape.padding, options.origin);
      }
    }
    if (known == 0 || slot.changed > known) {
      snapshot.poses_[i] = slot.pose;
      snapshot.poses_[i].growth = growthOf(slot.pose, bodies[structure->ids[i].slot], options);
    }
    snapshot.worst_state_ = std::max(snapshot.worst_state_, slot.pose.state);
    snapshot.max_growth_ = std::max(snapshot.max_growth_, snapshot.poses_[i].growth);
    if (placed) snapshot.max_age_ = std::max(snapshot.max_age_, slot.pose.age);
  }
  snapshot.boxes_ = boxes;
  snapshot.cells_.clear();
  for (const std::uint32_t map : structure->maps) {
    const auto known_cells = cells_of_slot.find(structure->ids[map].slot);
    snapshot.cells_.push_back(known_cells == cells_of_slot.end() ? nullptr : known_cells->second);
  }
  horizon.step(structure, snapshot.poses_, boxes);
}

/// Grows the placed boxes by their shares of the margins: half of the global one, and all by which a body's own is
/// larger, or a pair of it may have. So two that are within their pair's margin plus their growth overlap.
void Scene::State::growBoxes(const Snapshot& snapshot) {
  ids.clear();
  grown_boxes.clear();
  grown_of.resize(snapshot.boxes_.size());
  for (ProxyId proxy = 0; proxy < snapshot.boxes_.size(); ++proxy) {
    const std::uint32_t body = structure->body_of_proxy[proxy];
    const BodyPose& pose = snapshot.poses_[body];
    if (pose.state == Freshness::unplaced) continue;
    const double own = std::max(structure->margin[body], structure->pair_margins.largestOf(body));
    const double can_go = horizon.reachOf(body);
    const double by = 0.5 * options.margin + (own - options.margin) + pose.growth + can_go;
    const Aabb& box = horizon.on() ? horizon.swept(proxy) : snapshot.boxes_[proxy];
    Grown& known = grown_of[proxy];
    if (known.by != by || known.box != box) {
      known = {box, by, grown(box, by)};
    }
    ids.push_back(proxy);
    grown_boxes.push_back(known.result);
  }
}

/// Stores the grown boxes and looks for the pairs of them that the filter lets through.
void Scene::State::fillGrid(Snapshot& snapshot) {
  if (snapshot.grid_revision_ != structure->revision) {
    snapshot.grid_ = HGrid(scale);
    snapshot.grid_.setThreads(options.threads);
    snapshot.grid_.setFixed(fixed_proxies);
    snapshot.grid_.setFilter(PairTest::of<isReported>(structure.get()));  // the snapshot keeps it alive
    snapshot.grid_revision_ = structure->revision;
  }
  snapshot.grid_.update(ids, grown_boxes);
  snapshot.grid_.overlappingPairs(proxy_pairs);
}

/// Sorts by (first, second, gap): counted by the first body, then each one's few among themselves.
void Scene::State::sortPairs(std::vector<NearPair>& pairs) {
  next_of_first.assign(structure->bodies.size() + 1, 0);
  for (const NearPair& pair : pairs) ++next_of_first[pair.first + 1];
  for (std::size_t i = 1; i < next_of_first.size(); ++i) next_of_first[i] += next_of_first[i - 1];
  unsorted.swap(pairs);
  pairs.resize(unsorted.size());
  for (const NearPair& pair : unsorted) pairs[next_of_first[pair.first]++] = pair;
  std::size_t begin = 0;
  for (std::size_t body = 0; body + 1 < next_of_first.size(); ++body) {
    const std::size_t end = next_of_first[body];
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(begin), pairs.begin() + static_cast<std::ptrdiff_t>(end),
              [](const NearPair& a, const NearPair& b) {
                return a.second != b.second ? a.second < b.second : a.gap < b.gap;
              });
    begin = end;
  }
}

void Scene::State::addPair(std::uint32_t first, std::uint32_t second, double gap, double margin, bool near,
                           std::vector<NearPair>& pairs) const {
  const bool odd = horizon.teleported(first) || horizon.teleported(second);
  const auto flags = static_cast<std::uint8_t>((near ? 0 : kHorizonFlag) | (odd ? kTeleportFlag : 0));
  pairs.push_back({first, second, near ? std::min(gap, margin) : gap, margin, Time{0}, flags});
}

void Scene::State::fillPairs(Snapshot& snapshot) {
  std::vector<NearPair>& pairs = snapshot.pairs_;
  pairs.clear();
  for (const ProxyPair& proxies : proxy_pairs) {
    // Proxies are numbered in the order of their bodies.
    const std::uint32_t first = structure->body_of_proxy[proxies.first],
                        second = structure->body_of_proxy[proxies.second];
    const Aabb &a = snapshot.boxes_[proxies.first], &b = snapshot.boxes_[proxies.second];
    const double margin = pairMargin(*structure, first, stalenessOf(snapshot.poses_[first]), second,
                                     stalenessOf(snapshot.poses_[second]));
    const bool near = withinDistance(a, b, margin);
    if (!near && !horizon.on()) continue;
    const double gap = distance(a, b);
    if (!near && !horizon.canMeet(*structure, proxies.first, proxies.second, gap, margin)) continue;
    addPair(first, second, gap, margin, near, pairs);
  }
  map_pairs.find(snapshot, horizon,
                 [&](std::uint32_t first, std::uint32_t second, double gap, double margin, bool near) {
                   addPair(first, second, gap, margin, near, pairs);
                 });
  sortPairs(pairs);
  // One entry per pair of bodies, that of the nearest boxes.
  pairs.erase(
      std::unique(pairs.begin(), pairs.end(),
                  [](const NearPair& a, const NearPair& b) { return a.first == b.first && a.second == b.second; }),
      pairs.end());
  tracker.update(structure->ids, snapshot.stamp_, pairs);
  pair_events.update(
      {structure, snapshot.poses_, snapshot.boxes_, pairs, snapshot.worst_state_, snapshot.max_growth_, snapshot.stamp_,
       [&](std::uint32_t first, std::uint32_t second, double up_to) { return snapshot.gapOf(first, second, up_to); }},
      snapshot.events_);
}

void Scene::State::fillCompleteness(Snapshot& snapshot, const std::vector<std::string>& missing) const {
  snapshot.reasons_.clear();
  snapshot.reasons_total_ = static_cast<std::uint32_t>(missing.size());
  for (const std::string& sentence : missing) {
    if (snapshot.reasons_.size() < options.max_reasons) snapshot.reasons_.push_back(sentence);
  }
  if (snapshot.worst_state_ < Freshness::lost && uncovered.empty()) return;  // nothing else leaves a gap
  std::vector<std::pair<int, std::uint32_t>> gaps;  // the worse the state, the smaller the number
  for (std::uint32_t i = 0; i < snapshot.poses_.size(); ++i) {
    if (snapshot.poses_[i].state >= Freshness::lost) gaps.emplace_back(-static_cast<int>(snapshot.poses_[i].state), i);
  }
  for (const std::uint32_t i : uncovered) {
    const Freshness state = snapshot.poses_[i].state;
    if (state < Freshness::lost) gaps.emplace_back(-static_cast<int>(state), i);
  }
  snapshot.reasons_total_ += static_cast<std::uint32_t>(gaps.size());
  const std::size_t listed = std::min(gaps.size(), options.max_reasons - snapshot.reasons_.size());
  std::partial_sort(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(listed), gaps.end());
  for (std::size_t i = 0; i < listed; ++i) {
    const std::uint32_t body = gaps[i].second;
    snapshot.reasons_.push_back(gapLeftBy(structure->bodies[body], snapshot.poses_[body]));
  }
}

std::shared_ptr<const Snapshot> Scene::commit(Time stamp, const std::vector<std::string>& missing) {
  const DefaultFloatEnvironment environment;
  using Clock = std::chrono::steady_clock;
  State& s = *state_;
  const auto begin = Clock::now();
  if (s.structure_changed) s.rebuildStructure();
  std::shared_ptr<Snapshot> snapshot = s.freshSnapshot();
  snapshot->origin_ = s.options.origin;
  snapshot->stamp_ = stamp;
  snapshot->report_unmapped_ = s.options.report_unmapped;
  s.fillBodies(*snapshot);
  s.growBoxes(*snapshot);
  const auto boxes_done = Clock::now();
  s.fillGrid(*snapshot);
  const auto grid_done = Clock::now();
  s.fillPairs(*snapshot);
  snapshot->sequence_ = ++s.sequence;
  snapshot->epoch_ = s.epoch;
  s.fillCompleteness(*snapshot, missing);
  s.times = {boxes_done - begin, grid_done - boxes_done, Clock::now() - grid_done};
  return snapshot;
}

}  // namespace hgrid
