// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/state_search.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "maps/map_gap.h"

namespace hgrid {
namespace {

constexpr float kLikely = -0.01f;  // [m] shapes whose boxes overlap by more than this are measured early

/// Returns one bit for each lane in which all bits of `lanes` are set.
unsigned bitsOf(const FourCounts& lanes) {
  return (lanes[0] & 1u) | (lanes[1] & 2u) | (lanes[2] & 4u) | (lanes[3] & 8u);
}

/// Returns for each lane whether two boxes are at most `reach` [m] apart along each axis.
unsigned overlapping(const FourShapes& a, const FourShapes& b, float reach) {
  const Four by = allFour(reach);
  auto lanes = (a.min[0] <= b.max[0] + by) & (b.min[0] <= a.max[0] + by);
  for (std::size_t k = 1; k < 3; ++k) lanes &= (a.min[k] <= b.max[k] + by) & (b.min[k] <= a.max[k] + by);
  return bitsOf(reinterpret_cast<FourCounts>(lanes));
}

unsigned overlapping(const FourShapes& a, const Aabb& b, float reach) {
  auto lanes = (a.min[0] <= allFour(b.max[0] + reach)) & (allFour(b.min[0] - reach) <= a.max[0]);
  for (Eigen::Index k = 1; k < 3; ++k) {
    lanes &= (a.min[k] <= allFour(b.max[k] + reach)) & (allFour(b.min[k] - reach) <= a.max[k]);
  }
  return bitsOf(reinterpret_cast<FourCounts>(lanes));
}

/// Calls act(lane) for each bit that is set.
template <class Act>
void forEachLane(unsigned bits, const Act& act) {
  for (std::size_t lane = 0; bits != 0; ++lane, bits >>= 1) {
    if (bits & 1u) act(lane);
  }
}

bool isNearer(const NearShapes& a, const NearShapes& b) {
  return std::tie(a.gap, a.is_self, a.own, a.other) < std::tie(b.gap, b.is_self, b.own, b.other);
}

bool sameBodies(const StatePair& a, const StatePair& b) { return a.first == b.first && a.second == b.second; }

}  // namespace

StateSearch::StateSearch(const Snapshot& snapshot, const NarrowPhase& narrow_phase, const RobotShapes& robot,
                         const WorldShapes& world, const StateDoubts& doubts, const StateRequest& request,
                         bool by_snapshot, StateMemory& scratch)
    : snapshot_(snapshot),
      narrow_phase_(narrow_phase),
      robot_(robot),
      world_(world),
      doubts_(doubts),
      request_(request),
      by_snapshot_(by_snapshot),
      scratch_(scratch),
      robots_{{{snapshot, narrow_phase, robot, scratch.groups, scratch.placed, 0},
               {snapshot, narrow_phase, robot, scratch.groups, scratch.placed, 1},
               {snapshot, narrow_phase, robot, scratch.groups, scratch.placed, 2},
               {snapshot, narrow_phase, robot, scratch.groups, scratch.placed, 3}}} {}

void StateSearch::run(unsigned open, bool first, StateAnswer* answers, std::vector<StatePair>& pairs) {
  open_ = open;
  nearest_.fill(request_.clearance);
  for (StatePair& pair : nearest_pair_) pair.first = Structure::kNone;
  for (auto& near : scratch_.near) near.clear();
  std::fill(scratch_.spheres_known.begin(), scratch_.spheres_known.end(), std::uint8_t{0});
  for (auto& found : scratch_.pairs) found.clear();
  robot_.place(scratch_.groups, first ? nullptr : scratch_.changing.data(), snapshot_.origin(), scratch_.placed);
  findSelf();
  measureLikely();
  world_.isSmall() ? findInFewShapes() : findInGrid();
  forEachLane(open, [&](std::size_t lane) {
    std::vector<NearShapes>& near = scratch_.near[lane];
    if (isOpen(lane)) std::sort(near.begin(), near.end(), isNearer);
    for (const NearShapes& shapes : near) measure(lane, shapes);
    measurePlanes(lane);
    measureMaps(lane);
    finish(lane, answers[lane], pairs);
  });
}

void StateSearch::findSelf() {
  const float reach = roundedUp(request_.clearance);
  for (const SelfPair& pair : robot_.selfPairs()) {
    const FourShapes &a = scratch_.placed[pair.first], &b = scratch_.placed[pair.second];
    const unsigned lanes = overlapping(a, b, reach) & open_;
    if (lanes == 0) continue;
    const Separation<Four> apart = separationOf(a.box, b.box);
    forEachLane(lanes, [&](std::size_t lane) {
      if (apart.along_faces[lane] > reach || (reach == 0.0f && apart.along_edges[lane] > 0.0f)) return;
      consider(lane, {apart.along_faces[lane], pair.first, pair.second, true});
    });
    if (open_ == 0) return;
  }
}

void StateSearch::findInFewShapes() {
  const float reach = roundedUp(request_.clearance);
  if (robot_.counting() == 0) return;
  FourShapes all = scratch_.placed[0];  // only its bounds are used
  for (std::size_t i = 1; i < robot_.counting(); ++i) {
    const FourShapes& placed = scratch_.placed[i];
    for (std::size_t k = 0; k < 3; ++k) {
      all.min[k] = least(all.min[k], placed.min[k]);
      all.max[k] = greatest(all.max[k], placed.max[k]);
    }
  }
  for (std::uint32_t other = 0; other < world_.shapes().size(); ++other) {
    if ((overlapping(all, world_.boundsOf(other), reach) & open_) == 0) continue;
    const WorldShape& shape = world_.shapes()[other];
    for (std::uint32_t own = 0; own < robot_.counting(); ++own) {
      forEachLane(overlapping(scratch_.placed[own], world_.boundsOf(other), reach) & open_, [&](std::size_t lane) {
        const Separation<float> apart = separationOf(in(lane).boxOf(own), shape.box);
        if (apart.along_faces > reach || (reach == 0.0f && apart.along_edges > 0.0f)) return;
        if (!in(lane).allowed(own, shape.body)) consider(lane, {apart.along_faces, own, other, false});
      });
    }
  }
}

void StateSearch::findInGrid() {
  const float reach = roundedUp(request_.clearance);
  forEachLane(open_, [&](std::size_t lane) {
    for (std::uint32_t own = static_cast<std::uint32_t>(robot_.counting()); own-- > 0 && isOpen(lane);) {
      Aabb bounds = in(lane).boundsOf(own);
      if (reach > 0.0f) bounds = grown(bounds, reach);
      world_.overlapping(bounds, scratch_.found);
      if (scratch_.found.empty()) continue;
      const TiltedBox<float> box = in(lane).boxOf(own);
      for (const ProxyId other : scratch_.found) {
        const WorldShape& shape = world_.shapes()[other];
        const Separation<float> apart = separationOf(box, shape.box);
        if (apart.along_faces > reach || (reach == 0.0f && apart.along_edges > 0.0f)) continue;
        if (!in(lane).allowed(own, shape.body)) consider(lane, {apart.along_faces, own, other, false});
      }
    }
  });
}

/// Uses two shapes whose boxes are near each other. If spheres inside them meet, they are in contact. Otherwise they
/// are measured later.
void StateSearch::consider(std::size_t lane, const NearShapes& near) {
  if (!isOpen(lane)) return;
  if (near.gap < 0.0f && !request_.all_pairs && request_.clearance == 0.0 && haveSpheresInCommon(lane, near)) {
    StatePair pair = pairOf(near);
    pair.proximity.status = Measure::contact;
    pair.proximity.distance = 0.0;
    take(lane, pair, near.gap);
  } else {
    scratch_.near[lane].push_back(near);
  }
}

const FourSpheres& StateSearch::spheresOf(std::size_t lane, std::size_t own) {
  FourSpheres& spheres = scratch_.spheres[4 * own + lane];
  if ((scratch_.spheres_known[own] >> lane & 1u) == 0) {
    in(lane).placeSpheres(own, spheres);
    scratch_.spheres_known[own] = static_cast<std::uint8_t>(scratch_.spheres_known[own] | 1u << lane);
  }
  return spheres;
}

bool StateSearch::haveSpheresInCommon(std::size_t lane, const NearShapes& near) {
  if (robot_.shapes()[near.own].spheres.empty()) return false;
  if (!near.is_self) {
    const SmallSphere *const begin = world_.spheresOf(near.other), *const end = world_.spheresOf(near.other + 1);
    if (begin == end) return false;
    const FourSpheres& own = spheresOf(lane, near.own);
    return std::any_of(begin, end, [&](const SmallSphere& sphere) { return own.meet(sphere); });
  }
  if (robot_.shapes()[near.other].spheres.empty()) return false;
  const FourSpheres &own = spheresOf(lane, near.own), &other = spheresOf(lane, near.other);
  for (std::size_t i = 0; i < other.count; ++i) {
    if (own.meet(other[i])) return true;
  }
  return false;
}

/// Measures the shapes that are most likely in contact, before the world is searched.
void StateSearch::measureLikely() {
  forEachLane(open_, [&](std::size_t lane) {
    std::vector<NearShapes>& near = scratch_.near[lane];
    std::sort(near.begin(), near.end(), isNearer);
    std::size_t count = 0;
    while (count < near.size() && near[count].gap < kLikely && isOpen(lane)) measure(lane, near[count++]);
    near.erase(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count));
  });
}

StatePair StateSearch::pairOf(const NearShapes& near) const {
  const RobotShape& own = robot_.shapes()[near.own];
  StatePair pair;
  pair.first = own.body;
  pair.first_shape = own.shape;
  pair.second = near.is_self ? robot_.shapes()[near.other].body : world_.shapes()[near.other].body;
  pair.second_shape = near.is_self ? robot_.shapes()[near.other].shape : world_.shapes()[near.other].shape;
  return pair;
}

void StateSearch::measure(std::size_t lane, const NearShapes& near) {
  if (!isOpen(lane) || static_cast<double>(near.gap) > nearest_[lane]) return;
  StatePair pair = pairOf(near);
  if (near.is_self) {
    const BodyShape& other = *robot_.shapes()[near.other].what;
    pair.proximity = in(lane).measure(near.own, other.solid.get(), in(lane).worldFromShape(near.other), other.padding,
                                      nearest_[lane]);
  } else {
    pair.proximity = in(lane).measureBody(near.own, pair.second, pair.second_shape, nearest_[lane]);
  }
  take(lane, pair, near.gap);
}

/// Uses the result of a measurement. @param gap  [m] lower bound of the distance, from boxes
void StateSearch::take(std::size_t lane, const StatePair& pair, double gap) {
  const bool measured = pair.proximity.status != Measure::not_measured;
  const double distance = measured ? pair.proximity.distance : std::max(0.0, gap);
  if (isContact(pair.proximity.status) || distance <= 0.0) {
    scratch_.pairs[lane].push_back(pair);
    nearest_[lane] = 0.0;
    if (!request_.all_pairs) open_ &= ~(1u << lane);
  } else if (distance < nearest_[lane] || (distance == nearest_[lane] && !hasNearest(lane))) {
    nearest_[lane] = distance;
    nearest_pair_[lane] = pair;
  }
}

void StateSearch::measureMaps(std::size_t lane) {
  for (const PlacedMap& map : world_.maps()) {
    for (std::size_t own = 0; own < robot_.counting() && isOpen(lane); ++own) {
      if (!in(lane).allowed(own, map.body)) measureMap(lane, own, map);
    }
  }
}

/// Measures a shape of the robot against the cells of a map, nearest cells first, until one is in contact.
void StateSearch::measureMap(std::size_t lane, std::size_t own, const PlacedMap& map) {
  const Eigen::AlignedBox3d box = boxInMap(map.map_from_world, in(lane).boundsOf(own), snapshot_.origin());
  if (grown(map.cells.grid->bounds(), nearest_[lane] + 1e-6).intersection(box).isEmpty()) return;
  struct Visit {
    const RobotShape& shape;
    TiltedBox<float> own_box, cell;
    bool met = false;
  } visit{robot_.shapes()[own], in(lane).boxOf(own), {}};
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      visit.cell.axes[i][k] = static_cast<float>(map.world_from_map.linear()(k, i));
    }
  }
  struct Context {  // one pointer to it fits into a std::function without memory of its own
    StateSearch& search;
    Visit& visit;
    const PlacedMap& map;
    const std::size_t lane, own;
  } context{*this, visit, map, lane, own};
  map.cells.grid->visitNear(box, nearest_[lane], [&context](const Voxel& voxel, double) {
    StateSearch& search = context.search;
    Visit& at = context.visit;
    const double limit = search.nearest_[context.lane];
    const Pose world_from_cube = context.map.worldFromCube(voxel);
    const Eigen::Vector3d center = world_from_cube.translation() - search.snapshot_.origin();
    const double half = 0.5 * context.map.edgeOf(voxel);
    const float half_side = roundedUp(half * (1.0 + 3e-6) + 4e-7 * center.norm());
    for (Eigen::Index k = 0; k < 3; ++k) {
      at.cell.center[k] = static_cast<float>(center[k]);
      at.cell.half[k] = half_side;
    }
    const Separation<float> apart = separationOf(at.own_box, at.cell);
    if (static_cast<double>(apart.along_faces) > limit) return limit;
    if (search.request_.clearance == 0.0 && apart.along_edges > 0.0f) return limit;
    StatePair pair;
    pair.first = at.shape.body;
    pair.first_shape = at.shape.shape;
    pair.second = context.map.body;
    pair.proximity = search.in(context.lane)
                         .measure(context.own, context.map.cells.cubes[voxel.level].get(), world_from_cube, 0.0, limit);
    const std::size_t before = search.scratch_.pairs[context.lane].size();
    search.take(context.lane, pair, static_cast<double>(apart.along_faces));
    const bool met = search.scratch_.pairs[context.lane].size() > before;
    return met ? kNoFurther : search.nearest_[context.lane];
  });
}

void StateSearch::measurePlanes(std::size_t lane) {
  for (const PlacedPlane& plane : world_.planes()) {
    for (std::size_t own = 0; own < robot_.counting() && isOpen(lane); ++own) {
      const double gap = distance(plane.half_space, in(lane).boundsOf(own));
      if (gap > nearest_[lane] || in(lane).allowed(own, plane.body)) continue;
      StatePair pair;
      pair.first = robot_.shapes()[own].body;
      pair.first_shape = robot_.shapes()[own].shape;
      pair.second = plane.body;
      pair.second_shape = plane.shape;
      pair.proximity =
          in(lane).measure(own, narrow_phase_.plane().get(), plane.world_from_plane, plane.padding, nearest_[lane]);
      take(lane, pair, gap);
    }
  }
}

/// Writes the answer for a state.
void StateSearch::finish(std::size_t lane, StateAnswer& answer, std::vector<StatePair>& pairs) {
  std::vector<StatePair>& found = scratch_.pairs[lane];
  const bool measured = request_.clearance > 0.0;
  answer.first_pair = static_cast<std::uint32_t>(pairs.size());
  if (!found.empty()) {
    answer.verdict = Verdict::hit;
    if (measured) answer.clearance = 0.0;
    std::sort(found.begin(), found.end(), [](const StatePair& a, const StatePair& b) {
      return std::tie(a.first, a.second, a.first_shape, a.second_shape) <
             std::tie(b.first, b.second, b.first_shape, b.second_shape);
    });
    pairs.insert(pairs.end(), found.begin(), std::unique(found.begin(), found.end(), sameBodies));
    answer.pairs = static_cast<std::uint32_t>(pairs.size()) - answer.first_pair;
    return;
  }
  if (const auto doubt = doubts_.none() ? std::nullopt : doubts_.find(in(lane), by_snapshot_, nearest_[lane])) {
    answer.verdict = Verdict::unknown;
    answer.because = doubts_[*doubt].because;
    answer.detail = *doubt;
  } else {
    answer.verdict = Verdict::clear;
  }
  if (!measured) return;
  answer.clearance = hasNearest(lane) ? nearest_[lane] : std::numeric_limits<double>::infinity();
  if (!hasNearest(lane)) return;
  pairs.push_back(nearest_pair_[lane]);
  answer.pairs = 1;
}

}  // namespace hgrid
