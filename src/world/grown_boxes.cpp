// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The part of Scene::commit() that grows the boxes by their margins and stores them in the broad phase.
#include <algorithm>
#include <stdexcept>

#include "world/scene_state.h"

namespace hgrid {
namespace {

/// The overlap filter of the grid: keeps the pairs of proxies whose bodies the pair filter reports.
bool isReported(const void* structure, ProxyId first, ProxyId second) {
  const Structure& s = *static_cast<const Structure*>(structure);
  return !s.filter.allowed(s.body_of_proxy[first], s.body_of_proxy[second]);
}

/// Makes a broad phase without boxes, of the kind that the options ask for.
std::unique_ptr<BroadPhase> emptyBroadPhase(const SceneOptions& options, double finest_edge) {
  if (options.broad_phase) {
    std::unique_ptr<BroadPhase> made = options.broad_phase(finest_edge, options.threads);
    if (!made) throw std::invalid_argument("SceneOptions::broad_phase returned null; it must return a broad phase");
    return made;
  }
  GridScale scale;
  scale.finest_edge = finest_edge;
  auto grid = std::make_unique<HGrid>(scale);
  grid->setThreads(options.threads);
  return grid;
}

}  // namespace

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
    pooled.setBroadPhase(emptyBroadPhase(options, structure->scale.finest_edge));
    BroadPhase& grid = *pooled.broad_phase;
    grid.setFixed(structure->fixed_proxies);
    grid.setOverlapFilter(OverlapFilter::of<isReported>(
        static_cast<const Structure*>(structure.get())));  // the snapshot keeps the structure alive
    grid.setPairBound(limits.boundOf(structure->body_of_proxy.size()));
    pooled.grid_revision = structure->revision;
  }
  BroadPhase& grid = *pooled.broad_phase;
  const auto* hgrid = dynamic_cast<const HGrid*>(&grid);
  threads = hgrid != nullptr ? hgrid->threads() : 1;
  if (!moveInGrid(grid)) grid.update(ids, grown_boxes);
  pooled.snapshot.search_cut_ = !grid.boundedPairs(proxy_pairs);
}

}  // namespace hgrid
