// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/state_search.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "geometry/rounding.h"
#include "maps/map_gap.h"
#include "narrow/measured_contact.h"
#include "queries/states/four_boxes.h"

namespace hgrid {
namespace {

constexpr float kLikely = -0.01f;          // [m] shapes whose boxes overlap by more than this are measured early
constexpr double kCubeGrown = 1.0 + 3e-6;  // makes up for the rounding of the axes of a cube in floats

/// Returns whether two boxes may be at most `reach` [m] apart.
bool mayReach(const Separation<float>& apart, float reach) {
  return apart.along_faces <= reach && (reach > 0.0f || apart.along_edges <= 0.0f);
}

/// Calls act(lane) for each bit that is set.
template <class Act>
void forEachLane(unsigned bits, const Act& act) {
  for (std::size_t lane = 0; bits != 0; ++lane, bits >>= 1) {
    if (bits & 1u) act(lane);
  }
}

bool isNearer(const NearShapes& a, const NearShapes& b) {
  return std::tie(a.gap, a.with, a.own, a.other) < std::tie(b.gap, b.with, b.own, b.other);
}

}  // namespace

Contact TouchingSolids::measure(const NarrowPhase& narrow_phase, Measure status) const {
  if (first.solid == nullptr || second.solid == nullptr) return {};
  return measuredContact(narrow_phase, {*first.solid, first.world_from_shape, first.padding},
                         {*second.solid, second.world_from_shape, second.padding}, status);
}

void StateMemory::prepare(const Kinematics& kinematics, const RobotShapes& robot) {
  const std::size_t shapes = robot.shapes().size(), variables = kinematics.variables().size();
  placed.resize(shapes);
  clusters.resize(robot.clusters().size());
  spheres.resize(4 * shapes);
  spheres_known.resize(shapes);
  shape_reach.resize(shapes);
  pair_reach.resize(robot.selfPairs().size());
  block_reach.resize(robot.selfBlocks().size());
  self_near.resize(robot.selfPairs().size());
  from.resize(variables);
  difference.resize(variables);
}

StateSearch::StateSearch(const Snapshot& snapshot, const NarrowPhase& narrow_phase, const RobotShapes& robot,
                         const WorldShapes& world, SearchGoal goal, double farthest, bool describes,
                         StateMemory& scratch)
    : snapshot_(snapshot),
      narrow_phase_(narrow_phase),
      robot_(robot),
      world_(world),
      goal_(goal),
      farthest_(farthest),
      describes_(describes),
      scratch_(scratch),
      robots_{{{snapshot, narrow_phase, robot, scratch.groups.in_world, scratch.placed, 0},
               {snapshot, narrow_phase, robot, scratch.groups.in_world, scratch.placed, 1},
               {snapshot, narrow_phase, robot, scratch.groups.in_world, scratch.placed, 2},
               {snapshot, narrow_phase, robot, scratch.groups.in_world, scratch.placed, 3}}} {}

void StateSearch::place(unsigned open, bool first) {
  open_ = open;
  limit_.fill(farthest_);
  for (StatePair& pair : near_pair_) pair.first = Structure::kNone;
  for (auto& near : scratch_.near) near.clear();
  for (auto& kept : scratch_.kept) kept.clear();
  for (auto& found : scratch_.pairs) found.clear();
  const GroupChange* const changes = first ? nullptr : scratch_.changes.data();
  for (std::size_t i = 0; i < robot_.shapes().size(); ++i) {
    if (changeOf(changes, robot_.shapes()[i].group) != GroupChange::none) scratch_.spheres_known[i] = 0;
  }
  robot_.place(scratch_.groups.in_world, changes, snapshot_.origin(), scratch_.placed);
  robot_.boundClusters(scratch_.placed, scratch_.clusters);
}

void StateSearch::findAll(unsigned lanes) {
  if (lanes == 0) return;
  const unsigned others = open_ & ~lanes;
  open_ &= lanes;
  findSelf();
  measureLikely();
  world_.isSmall() ? findInFewShapes() : findInGrid();
  findFarFromMaps();
  forEachLane(lanes, [&](std::size_t lane) {
    std::vector<NearShapes>& near = scratch_.near[lane];
    if (isOpen(lane)) std::sort(near.begin(), near.end(), isNearer);
    for (const NearShapes& shapes : near) measure(lane, shapes);
    findPlanesAndMaps(lane);
    sortContacts(lane);
  });
  open_ |= others;
}

void StateSearch::findAmong(std::size_t lane, const NearShapes* begin, const NearShapes* end) {
  const RobotInState& robot = robotIn(lane);
  for (const NearShapes* candidate = begin; candidate != end && isOpen(lane); ++candidate) {
    NearShapes near = *candidate;
    near.reach = near.with == With::self ? scratch_.pair_reach[near.pair][lane] : scratch_.shape_reach[near.own][lane];
    if (near.with == With::plane) {
      near.gap = static_cast<float>(distance(world_.planes()[near.other].half_space, robot.boundsOf(near.own)));
    } else if (near.with == With::map) {
      near.gap = 0.0f;  // it was that of one cell, in another state
    } else {
      const TiltedBox<float> other =
          near.with == With::self ? robot.boxOf(near.other) : world_.shapes()[near.other].box;
      const Separation<float> apart = separationOf(robot.boxOf(near.own), other, near.reach);
      if (!mayReach(apart, near.reach)) continue;
      if (near.with == With::self && isFarFromMesh(lane, near)) continue;
      near.gap = apart.along_faces;
    }
    measure(lane, near);
  }
  sortContacts(lane);
}

void StateSearch::sortContacts(std::size_t lane) {
  std::vector<StatePair>& found = scratch_.pairs[lane];
  std::sort(found.begin(), found.end(), [](const StatePair& a, const StatePair& b) {
    return std::tie(a.first, a.second, a.first_shape, a.second_shape) <
           std::tie(b.first, b.second, b.first_shape, b.second_shape);
  });
}

/// Finds the self pairs whose axis-aligned boxes are within reach in an open state, and writes them to
/// StateMemory::self_near. The innermost loop has no branches, because they would often be mispredicted.
/// @returns how many there are
std::size_t StateSearch::findSelfBoxes() {
  const std::vector<SelfPair>& pairs = robot_.selfPairs();
  const unsigned open = open_;
  const FourShapes* const placed = scratch_.placed.data();
  const Four* const reach = scratch_.pair_reach.data();
  StateMemory::SelfNear* const near = scratch_.self_near.data();
  std::size_t count = 0;
  for (std::size_t k = 0; k < robot_.selfBlocks().size(); ++k) {
    const SelfBlock block = robot_.selfBlocks()[k];
    if (block.isOfClusters() && (overlapping(scratch_.clusters[block.first_cluster],
                                             scratch_.clusters[block.second_cluster], scratch_.block_reach[k]) &
                                 open) == 0) {
      continue;
    }
    for (std::uint32_t i = block.first; i < block.last;) {
      const std::uint32_t first = pairs[i].first;
      const FourBounds own = placed[first].bounds;
      for (; i < block.last && pairs[i].first == first; ++i) {
        const unsigned lanes = overlapping(own, placed[pairs[i].second].bounds, reach[i]) & open;
        near[count] = {i, lanes};
        count += lanes != 0 ? 1 : 0;
      }
    }
  }
  return count;
}

void StateSearch::findSelf() {
  const std::size_t count = findSelfBoxes();
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t i = scratch_.self_near[k].pair;
    const SelfPair& pair = robot_.selfPairs()[i];
    const Four& reach = scratch_.pair_reach[i];
    const FourShapes &a = scratch_.placed[pair.first], &b = scratch_.placed[pair.second];
    const unsigned lanes = scratch_.self_near[k].lanes & open_;
    if (lanes == 0) continue;
    const Separation<Four> apart = separationOf(a.box, b.box, reach);
    unsigned near = 0;
    forEachLane(lanes, [&](std::size_t lane) {
      if (mayReach({apart.along_faces[lane], apart.along_edges[lane]}, reach[lane])) near |= 1u << lane;
    });
    forEachLane(near & ~farFromMesh(pair, reach, near), [&](std::size_t lane) {
      consider(lane, {apart.along_faces[lane], reach[lane], With::self, pair.first, pair.second, i});
    });
    if (open_ == 0) return;
  }
}

/// Returns in which of four states the shapes of a pair are surely farther apart than `reach`, according to the one of
/// them that is a mesh. @param lanes  bit i: whether the result matters for state i
unsigned StateSearch::farFromMesh(const SelfPair& pair, const Four& reach, unsigned lanes) const {
  if (lanes == 0 || pair.mesh == Structure::kNone) return 0;
  const std::uint32_t other = pair.mesh == pair.first ? pair.second : pair.first;
  return robot_.shapes()[pair.mesh].clearance.farther(scratch_.placed[pair.mesh], scratch_.placed[other],
                                                      robot_.shapes()[other].cover, reach, lanes);
}

bool StateSearch::isFarFromMesh(std::size_t lane, const NearShapes& near) const {
  return farFromMesh(robot_.selfPairs()[near.pair], scratch_.pair_reach[near.pair], 1u << lane) != 0;
}

void StateSearch::findInFewShapes() {
  if (robot_.counting() == 0) return;
  FourBounds all;
  for (std::size_t i = 0; i < robot_.counting(); ++i) {
    FourBounds searched = scratch_.placed[i].bounds;
    for (std::size_t k = 0; k < 3; ++k) {
      searched.min[k] -= scratch_.shape_reach[i];
      searched.max[k] += scratch_.shape_reach[i];
    }
    all = i == 0 ? searched : around(all, searched);
  }
  for (std::uint32_t other = 0; other < world_.shapes().size(); ++other) {
    if ((overlapping(all, world_.boundsOf(other), allFour(0.0f)) & open_) == 0) continue;
    const WorldShape& shape = world_.shapes()[other];
    for (std::uint32_t own = 0; own < robot_.counting(); ++own) {
      const Four& reach = scratch_.shape_reach[own];
      forEachLane(overlapping(scratch_.placed[own].bounds, world_.boundsOf(other), reach) & open_,
                  [&](std::size_t lane) {
                    const Separation<float> apart = separationOf(robotIn(lane).boxOf(own), shape.box, reach[lane]);
                    if (!mayReach(apart, reach[lane]) || robotIn(lane).allowed(own, shape.body)) return;
                    consider(lane, {apart.along_faces, reach[lane], With::shape, own, other, 0});
                  });
    }
  }
}

void StateSearch::findInGrid() {
  forEachLane(open_, [&](std::size_t lane) {
    for (std::size_t cluster = robot_.countingClusters(); cluster-- > 0 && isOpen(lane);) {
      findNearCluster(lane, robot_.clusters()[cluster]);
    }
  });
}

/// Finds the shapes of the world that are near the shapes of a cluster. Searches the grid once.
void StateSearch::findNearCluster(std::size_t lane, const ShapeCluster& cluster) {
  const RobotInState& robot = robotIn(lane);
  const auto reachOf = [&, limit = roundedUp(limit_[lane])](std::uint32_t own) {
    return std::min(limit, scratch_.shape_reach[own][lane]);
  };
  std::array<Aabb, ShapeCluster::kMost> searched;  // for each shape: its box grown by its reach
  Aabb all;
  for (std::uint32_t own = cluster.first; own < cluster.last; ++own) {
    const float reach = reachOf(own);
    Aabb& bounds = searched[own - cluster.first];
    bounds = robot.boundsOf(own);
    if (reach > 0.0f) bounds = grown(bounds, reach);
    all = own == cluster.first ? bounds : Aabb{all.min.cwiseMin(bounds.min), all.max.cwiseMax(bounds.max)};
  }
  world_.overlapping(all, scratch_.found);
  if (scratch_.found.empty()) return;
  const bool is_single = cluster.last - cluster.first == 1;  // the search has already tested the box of this shape
  for (std::uint32_t own = cluster.last; own-- > cluster.first && isOpen(lane);) {
    const float reach = reachOf(own);
    const Aabb& bounds = searched[own - cluster.first];
    std::optional<TiltedBox<float>> box;
    for (const ProxyId other : scratch_.found) {
      if (!is_single && !overlap(bounds, world_.boundsOf(other))) continue;
      if (!box) box = robot.boxOf(own);
      const WorldShape& shape = world_.shapes()[other];
      const Separation<float> apart = separationOf(*box, shape.box, reach);
      if (!mayReach(apart, reach) || robot.allowed(own, shape.body)) continue;
      consider(lane, {apart.along_faces, reach, With::shape, own, other, 0});
    }
  }
}

/// Uses two shapes whose boxes are near each other. If spheres inside them meet, they are in contact. Otherwise they
/// are measured later.
void StateSearch::consider(std::size_t lane, const NearShapes& near) {
  if (!isOpen(lane) || static_cast<double>(near.gap) > limit_[lane]) return;
  if (near.gap < 0.0f && goal_ == SearchGoal::contact && haveSpheresInCommon(lane, near)) {
    StatePair pair = pairOf(near);
    pair.proximity.status = Measure::contact;
    pair.proximity.distance = pair.proximity.lower_bound = 0.0;
    take(lane, near, pair, otherOf(lane, near), 0.0);
  } else {
    scratch_.near[lane].push_back(near);
  }
}

const FourSpheres& StateSearch::spheresOf(std::size_t lane, std::size_t own) {
  FourSpheres& spheres = scratch_.spheres[4 * own + lane];
  if ((scratch_.spheres_known[own] >> lane & 1u) == 0) {
    spheres = robotIn(lane).spheresOf(own);
    scratch_.spheres_known[own] = static_cast<std::uint8_t>(scratch_.spheres_known[own] | 1u << lane);
  }
  return spheres;
}

bool StateSearch::haveSpheresInCommon(std::size_t lane, const NearShapes& near) {
  if (robot_.shapes()[near.own].spheres.count == 0) return false;
  if (near.with != With::self) {
    const SmallSphere *const begin = world_.spheresOf(near.other), *const end = world_.spheresOf(near.other + 1);
    if (begin == end) return false;
    const FourSpheres& own = spheresOf(lane, near.own);
    return std::any_of(begin, end, [&](const SmallSphere& sphere) { return own.meet(sphere); });
  }
  if (robot_.shapes()[near.other].spheres.count == 0) return false;
  const FourSpheres& own = spheresOf(lane, near.own);
  return own.meet(spheresOf(lane, near.other));
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

/// Finds for each map and shape the open states in which they are surely farther apart than the reach of the shape.
void StateSearch::findFarFromMaps() {
  scratch_.map_far.resize(world_.maps().size() * robot_.counting());
  if (open_ == 0) return;
  auto far = scratch_.map_far.begin();
  for (const MapClearance& map : world_.clearances()) {
    for (std::size_t own = 0; own < robot_.counting(); ++own, ++far) {
      *far = static_cast<std::uint8_t>(
          map.farther(scratch_.placed[own], robot_.shapes()[own].cover, scratch_.shape_reach[own], open_));
    }
  }
}

bool StateSearch::isFarFromMap(std::size_t lane, std::size_t map, std::size_t own) const {
  return (scratch_.map_far[map * robot_.counting() + own] >> lane & 1u) != 0;
}

void StateSearch::findPlanesAndMaps(std::size_t lane) {
  for (std::uint32_t i = 0; i < world_.planes().size(); ++i) {
    for (std::uint32_t own = 0; own < robot_.counting() && isOpen(lane); ++own) {
      const float reach = scratch_.shape_reach[own][lane];
      const double gap = distance(world_.planes()[i].half_space, robotIn(lane).boundsOf(own));
      if (gap > static_cast<double>(reach) || robotIn(lane).allowed(own, world_.planes()[i].body)) continue;
      measure(lane, {static_cast<float>(gap), reach, With::plane, own, i, 0});
    }
  }
  for (std::uint32_t i = 0; i < world_.maps().size(); ++i) {
    for (std::uint32_t own = 0; own < robot_.counting() && isOpen(lane); ++own) {
      if (isFarFromMap(lane, i, own) || robotIn(lane).allowed(own, world_.maps()[i].body)) continue;
      measure(lane, {0.0f, scratch_.shape_reach[own][lane], With::map, own, i, 0});
    }
  }
}

/// Returns the two shapes. A map has no shape.
StatePair StateSearch::pairOf(const NearShapes& near) const {
  const RobotShape& own = robot_.shapes()[near.own];
  StatePair pair;
  pair.first = own.body;
  pair.first_shape = own.shape;
  switch (near.with) {
    case With::self:
      pair.second = robot_.shapes()[near.other].body;
      pair.second_shape = robot_.shapes()[near.other].shape;
      break;
    case With::shape:
      pair.second = world_.shapes()[near.other].body;
      pair.second_shape = world_.shapes()[near.other].shape;
      break;
    case With::plane:
      pair.second = world_.planes()[near.other].body;
      pair.second_shape = world_.planes()[near.other].shape;
      break;
    case With::map:
      pair.second = world_.maps()[near.other].body;
      break;
  }
  return pair;
}

void StateSearch::measure(std::size_t lane, const NearShapes& near) {
  const double limit = std::min<double>(limit_[lane], near.reach);
  if (!isOpen(lane) || static_cast<double>(near.gap) > limit) return;
  if (goal_ == SearchGoal::all_near && near.gap > 0.0f && near.reach > scratch_.coarse[lane]) {
    scratch_.kept[lane].push_back(near);
    return;
  }
  if (near.with == With::map) return measureMap(lane, near, limit);
  const TouchingSolids::Placed other = otherOf(lane, near);
  StatePair pair = pairOf(near);
  pair.proximity = robotIn(lane).measure(near.own, other.solid, other.world_from_shape, other.padding, limit);
  if (near.with == With::self) {
    const std::uint32_t mesh = robot_.selfPairs()[near.pair].mesh;
    if (mesh != Structure::kNone && !isContact(pair.proximity.status)) robot_.shapes()[mesh].clearance.countApart();
  }
  take(lane, near, pair, other, limit);
}

/// Returns the solid of the second shape, which is not a cell of a map.
TouchingSolids::Placed StateSearch::otherOf(std::size_t lane, const NearShapes& near) const {
  if (near.with == With::self) {
    const BodyShape& other = *robot_.shapes()[near.other].what;
    return {other.solid.get(), robotIn(lane).worldFromShape(near.other), other.padding};
  }
  if (near.with == With::plane) {
    const PlacedPlane& plane = world_.planes()[near.other];
    return {narrow_phase_.plane().get(), plane.world_from_plane, plane.padding};
  }
  const WorldShape& shape = world_.shapes()[near.other];
  const BodyShape& other = snapshot_.structure().bodies[shape.body].shapes[shape.shape];
  return {other.solid.get(), snapshot_.poses()[shape.body].world_from_body * other.body_from_shape, other.padding};
}

/// Uses the result of a measurement.
/// @param other  the second solid
/// @param limit  [m] larger distances do not count
void StateSearch::take(std::size_t lane, const NearShapes& near, const StatePair& pair,
                       const TouchingSolids::Placed& other, double limit) {
  const bool measured = pair.proximity.status != Measure::not_measured;
  const double found = goal_ == SearchGoal::all_near ? pair.proximity.lower_bound : pair.proximity.distance,
               distance = measured ? found : std::max(0.0, static_cast<double>(near.gap));
  const bool is_first = near_pair_[lane].first == Structure::kNone;
  if (isContact(pair.proximity.status) || distance <= 0.0) {
    const BodyShape& own = *robot_.shapes()[near.own].what;
    touching_[lane] = {{own.solid.get(), robotIn(lane).worldFromShape(near.own), own.padding}, other};
    scratch_.pairs[lane].push_back(pair);
    if (describes_) {
      scratch_.pairs[lane].back().contact = touching_[lane].measure(narrow_phase_, pair.proximity.status);
    }
    limit_[lane] = 0.0;
    if (goal_ != SearchGoal::all_contacts) open_ &= ~(1u << lane);
  } else if (distance < limit || (distance == limit && is_first)) {
    if (goal_ == SearchGoal::all_near) {
      scratch_.kept[lane].push_back(near);
    } else {
      limit_[lane] = distance;
    }
    if (!is_first && near_distance_[lane] <= distance) return;
    near_distance_[lane] = distance;
    near_pair_[lane] = pair;
  }
}

/// Measures a shape of the robot against the cells of a map, nearest cells first, until one is in contact.
void StateSearch::measureMap(std::size_t lane, const NearShapes& near, double limit) {
  const PlacedMap& map = world_.maps()[near.other];
  const Eigen::AlignedBox3d box = boxInMap(map.map_from_world, robotIn(lane).boundsOf(near.own), snapshot_.origin());
  if (grown(map.cells.grid->bounds(), limit + gapRounding(limit)).intersection(box).isEmpty()) return;
  struct Visit {
    NearShapes near;
    double limit;
    TiltedBox<float> own_box, cell;
  } visit{near, limit, robotIn(lane).boxOf(near.own), {}};
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      visit.cell.axes[i][k] = static_cast<float>(map.world_from_map.linear()(k, i));
    }
  }
  struct Context {  // one pointer to it fits into a std::function without memory of its own
    StateSearch& search;
    Visit& visit;
    const PlacedMap& map;
    const std::size_t lane;
  } context{*this, visit, map, lane};
  map.cells.grid->visitNear(box, limit, [&context](const Voxel& voxel, double) {
    StateSearch& search = context.search;
    Visit& at = context.visit;
    const Pose world_from_cube = context.map.worldFromCube(voxel);
    const Eigen::Vector3d center = world_from_cube.translation() - search.snapshot_.origin();
    const double half = 0.5 * context.map.edgeOf(voxel);
    const float half_side = roundedUp(half * kCubeGrown + kFloatRounding * center.norm());
    for (Eigen::Index k = 0; k < 3; ++k) {
      at.cell.center[k] = static_cast<float>(center[k]);
      at.cell.half[k] = half_side;
    }
    const Separation<float> apart = separationOf(at.own_box, at.cell, roundedUp(at.limit));
    at.near.gap = apart.along_faces;
    if (static_cast<double>(apart.along_faces) > at.limit) return at.limit;
    if (at.limit == 0.0 && apart.along_edges > 0.0f) return at.limit;
    StatePair pair = search.pairOf(at.near);
    const TouchingSolids::Placed cube{context.map.cells.cubes[voxel.level].get(), world_from_cube, 0.0};
    pair.proximity =
        search.robotIn(context.lane).measure(at.near.own, cube.solid, world_from_cube, cube.padding, at.limit);
    const std::size_t contacts = search.contacts(context.lane).size(), kept = search.kept(context.lane).size();
    search.take(context.lane, at.near, pair, cube, at.limit);
    if (search.contacts(context.lane).size() > contacts) return kNoFurther;
    at.limit = search.kept(context.lane).size() > kept ? 0.0 : std::min(at.limit, search.limit_[context.lane]);
    return at.limit;
  });
}

}  // namespace hgrid
