// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/history/history_story.h"

#include <set>

#include "hgrid_proximity/explain/explain.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/buildings.h"
#include "test/support/maps.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

/// Appends values as bytes, so that only equal bits are equal.
class Bytes {
 public:
  template <class Value>
  void add(const Value& value) {
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>);
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void add(const Eigen::Vector3d& point) {
    for (int axis = 0; axis < 3; ++axis) add(point[axis]);
  }
  void add(const std::string& words) { text += words + '\n'; }
  std::string text;
};

void addState(const Snapshot& s, Bytes& out) {
  for (const std::uint64_t number : {s.sequence(), s.epoch(), s.lastEvent(), s.pairsFound(),
                                     std::uint64_t{s.reasonsTotal()}, s.structure().revision})
    out.add(number);
  out.add(s.stamp().count());
  out.add(s.worstState());
  out.add(s.maxAge());
  out.add(s.origin());
  for (const bool flag : {s.truncated(), s.searchCut(), s.complete(), s.reportsUnmapped()}) out.add(flag);
  for (const std::string& reason : s.reasons()) out.add(reason);
  for (const std::string& source : s.incompleteSources()) out.add(source + s.reasonOf(source));
  for (const std::uint32_t body : s.doubtful()) out.add(body);
  for (const std::uint32_t body : std::set<std::uint32_t>(s.watched().begin(), s.watched().end())) out.add(body);
  for (std::uint32_t body = 0; body < s.poses().size(); ++body) {
    const BodyPose& pose = s.poses()[body];
    out.add(s.structure().bodies[body].name);
    for (int i = 0; i < 16; ++i) out.add(pose.world_from_body.data()[i]);
    for (const double value : {pose.age, pose.reach, pose.growth}) out.add(value);
    out.add(pose.stamp.count());
    out.add(pose.state);
    out.add(pose.cohort);
    if (pose.state == Freshness::unplaced) continue;
    for (std::uint32_t proxy = s.structure().first_proxy[body]; proxy < s.structure().first_proxy[body + 1]; ++proxy) {
      if (s.structure().isPlane(proxy)) {
        out.add(s.halfSpaceOf(proxy).normal);
        out.add(s.halfSpaceOf(proxy).offset);
        continue;
      }
      for (int axis = 0; axis < 3; ++axis) {
        out.add(s.boxes()[proxy].min[axis]);
        out.add(s.boxes()[proxy].max[axis]);
      }
    }
  }
}

void addAnswer(const QueryAnswer& answer, Bytes& out) {
  out.add(answer.verdict);
  out.add(answer.because);
  out.add(answer.total);
  out.add(answer.reason);
  for (const QueryHit& hit : answer.hits) {
    out.add(hit.body);
    out.add(hit.shape);
    out.add(hit.status);
    for (const double value :
         {hit.distance, hit.signed_distance, hit.depth, hit.center_distance, hit.along, hit.cell_edge})
      out.add(value);
    for (const auto& point : {hit.point, hit.own_point, hit.normal}) out.add(point);
  }
}

void addPairs(const Snapshot& s, Random& random, Bytes& out) {
  for (const NearPair& pair : s.pairs()) {
    out.add(pair.first);
    out.add(pair.second);
    out.add(pair.gap);
    out.add(pair.margin);
    out.add(pair.since.count());
    out.add(pair.flags);
    out.add(s.noContactBefore(pair.first, pair.second, 1.0).before);
  }
  const BodyList& bodies = s.structure().bodies;
  for (int i = 0; i < 10 && bodies.size() > 0; ++i) {
    const auto any = [&]() -> const Body& { return bodies[std::size_t(random.below(int(bodies.size())))]; };
    const Body &first = any(), &second = any();
    const Explanation what = explain(s, first.name, second.name, nullptr);
    out.add(what.text);
    for (const double value : {what.gap, what.margin, what.growth, what.age_first, what.age_second}) out.add(value);
    out.add(what.reported);
    out.add(what.cut);
    out.add(what.separate);
    out.add(what.since.count());
  }
}

}  // namespace

std::string toldBy(const Snapshot& s, NarrowPhase& narrow_phase, unsigned seed) {
  Random random(seed);
  Bytes out;
  addState(s, out);
  addPairs(s, random, out);
  for (int i = 0; i < 4; ++i) {
    QueryScope scope;
    if (i % 2 == 1) scope.exact = &narrow_phase;
    if (i == 3) scope.exclude = {"map/*"};
    if (i == 2 && s.poses().size() > 0) scope.respect_allowed = std::uint32_t(random.below(int(s.poses().size())));
    const auto point = [&] { return randomPose(random, 3.0).translation().eval(); };
    addAnswer(query(s, Sphere{point(), random.uniform(0, 1)}, scope), out);
    addAnswer(query(s, Segment{point(), point(), random.uniform(0, 0.3)}, scope), out);
    addAnswer(query(s, QueryBox{randomPose(random, 3.0), {0.5, random.uniform(0.1, 1), 0.2}}, narrow_phase, scope),
              out);
    addAnswer(query(s, QueryShape{Shape::capsule(0.5, 0.2), randomPose(random, 3.0), 0.1}, narrow_phase, scope), out);
    scope.limit = 3;
    addAnswer(nearest(s, point(), random.chance(0.5) ? 0.0 : 1.0, scope), out);
    if (s.poses().size() == 0) continue;
    const auto body = std::uint32_t(random.below(int(s.poses().size())));
    if (s.poses()[body].state == Freshness::unplaced || s.structure().bodies[body].shapes.empty()) continue;
    if (s.structure().hasPlane(body)) continue;  // a plane has no end to ask from
    addAnswer(nearest(s, body, 0.0, scope), out);
  }
  return out.text;
}

ChangingWorld::ChangingWorld(unsigned seed, std::shared_ptr<NarrowPhase> narrow_phase)
    : random_(seed), narrow_phase_(std::move(narrow_phase)), scene_(optionsOf(random_)) {
  scene_.beginEpoch(seed);
  for (const char* name : {"hall", "yard"}) {
    const std::string body = std::string("map/") + name;
    ids_[body] = put(scene_, mapBody(name, Mobility::moving), randomPose(random_, 1.0));
    changeCells(ids_[body]);
  }
}

SceneOptions ChangingWorld::optionsOf(Random& random) {
  SceneOptions options;
  options.margin = random.chance(0.2) ? 0.0 : sixtyFourths(random, 0, 0.5);
  options.growth_cap = sixtyFourths(random, 0, 2);
  if (random.chance(0.5)) options.origin << random.uniform(-10, 10), 1.5, -7;
  if (random.chance(0.3)) options.horizon = 0.5;
  if (random.chance(0.3)) options.max_pairs = 20;
  if (random.chance(0.5)) options.building = twoRooms();
  return options;
}

void ChangingWorld::changeCells(BodyId id) {
  const auto voxels = randomVoxels(random_, random_.between(0, 30), 20);
  scene_.setCells(id, makeMapCells(std::make_shared<StaticGrid>(0.1, voxels), *narrow_phase_));
}

void ChangingWorld::change() {
  const int kind = random_.below(100);
  if (kind < 30) {
    const std::string name = "o" + std::to_string(random_.below(60));
    if (ids_.count("obstacle/" + name) != 0) return;
    Body body = randomBody(random_, name);
    if (random_.chance(0.1)) {
      body.shapes.erase(body.shapes.begin() + 1, body.shapes.end());
      body.shapes[0].shape = Shape::plane();
      body.mobility = Mobility::fixed;
    }
    for (BodyShape& shape : body.shapes) shape.solid = narrow_phase_->solidOf(shape.shape);
    ids_[body.name] = scene_.add(body);
    return;
  }
  auto chosen = ids_.begin();
  std::advance(chosen, random_.below(int(ids_.size())));
  const bool is_map = hasCells(scene_.body(chosen->second).kind);
  if (kind < 36 && !is_map) {
    scene_.remove(chosen->second);
    ids_.erase(chosen);
  } else if (kind < 45 && is_map) {
    changeCells(chosen->second);
  } else if (kind < 80) {
    scene_.place(chosen->second, randomPose(random_, 3.0), stamp_);
  } else if (kind < 94) {
    scene_.setState(chosen->second, static_cast<Freshness>(random_.below(6)), sixtyFourths(random_, 0, 3),
                    std::uint32_t(random_.below(3)));
  } else if (kind < 97) {
    PairRule rule;
    rule.first = chosen->first;
    rule.second = "*";
    rule.reason = "for the test";
    rule.origin = Origin::service;
    scene_.setRules({rule});
  } else if (gaps_.empty()) {
    gaps_.push_back({"map/cellar", "map/cellar", "NOT_READY map 'cellar': for the test"});
    if (random_.chance(0.5)) gaps_.back().within = Sphere{randomPose(random_, 3.0).translation(), 1.0};
  } else {
    gaps_.clear();
  }
}

std::shared_ptr<const Snapshot> ChangingWorld::tick() {
  if (!random_.chance(0.1)) stamp_ += std::chrono::milliseconds(20);
  for (int changes = random_.below(12); changes > 0; --changes) change();
  return scene_.commit(stamp_, gaps_);
}

}  // namespace test
}  // namespace hgrid
