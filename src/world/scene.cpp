// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/world/scene.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "world/scene_state.h"

namespace hgrid {
namespace {

constexpr double kLargestMargin = 1e3;  // [m] also the largest padding, hysteresis, growth cap and finest edge
// [m] Largest coordinate of a shape in the frame of its body, and of a body in the world frame.
constexpr double kFarthestShape = 1e6;
constexpr std::ptrdiff_t kMostMatches = 64;  // most elements of State::name_matches; each has a copy of all globs

void checkLength(double value, double limit, const std::string& what) {
  if (!(value >= 0.0 && value <= limit)) {
    throw Refusal(Code::out_of_range, what + " is " + text(value) + " m; it must be within 0 .. " + text(limit) + " m");
  }
}

std::size_t planesOf(const Body& body) {
  return static_cast<std::size_t>(std::count_if(body.shapes.begin(), body.shapes.end(), [](const BodyShape& shape) {
    return shape.shape.kind() == ShapeKind::plane;
  }));
}

void checkBody(const Body& body) {
  const std::size_t slash = body.name.find('/');
  if (slash == std::string::npos) {
    throw Refusal(Code::bad_id, "body name is '" + printable(body.name) + "'; it must have the form source/local");
  }
  checkSource(body.name.substr(0, slash), "source of body '" + printable(body.name) + "'");
  checkLocal(body.name.substr(slash + 1), "local name of body '" + printable(body.name) + "'");
  checkLength(body.margin, kLargestMargin, "margin of body '" + body.name + "'");
  if (!(body.max_speed >= 0.0)) {
    throw Refusal(Code::out_of_range,
                  "max_speed of body '" + body.name + "' is " + text(body.max_speed) + " m/s; it must not be negative");
  }
  if (body.links && body.link >= body.links->size()) {
    throw Refusal(Code::out_of_range, "link index of body '" + body.name + "' is " + std::to_string(body.link) +
                                          "; it must be smaller than the number of links of the robot, " +
                                          std::to_string(body.links->size()));
  }
  if (planesOf(body) > 0 && (body.kind != BodyKind::obstacle || body.mobility != Mobility::fixed)) {
    throw Refusal(Code::unsupported, "body '" + body.name +
                                         "' has a plane; only an obstacle that is fixed in the world " +
                                         "may have planes, because no speed bounds the motion of a plane");
  }
  for (const BodyShape& shape : body.shapes) {
    const std::string what = "pose of a shape of body '" + body.name + "'";
    if (!shape.body_from_shape.matrix().allFinite()) {
      throw Refusal(Code::nonfinite, what + " is not finite; every number in it must be finite");
    }
    checkWithin(shape.body_from_shape.translation(), kFarthestShape, what);
    checkLength(shape.padding, kLargestMargin, "padding of a shape of body '" + body.name + "'");
  }
}

void checkTuning(const SceneTuning& tuning) {
  checkLength(tuning.margin, kLargestMargin, "margin");
  checkLength(tuning.event_hysteresis, kLargestMargin, "event_hysteresis");
  checkLength(tuning.growth_cap, kLargestMargin, "growth_cap");
  if (!(tuning.horizon >= 0.0 && tuning.horizon <= 60.0)) {
    throw Refusal(Code::out_of_range, "horizon is " + text(tuning.horizon) + " s; it must be within 0 .. 60 s");
  }
}

/// Returns whether a new obstacle is the old one at another place, so that its pairs continue. It must be fixed: the
/// pose of a moving obstacle may be unknown until its frame is found, so it becomes a new body.
bool isSameElsewhere(const Body& before, const Body& after) {
  const auto isObstacle = [](const Body& body) {
    return body.kind == BodyKind::obstacle && body.mobility == Mobility::fixed;
  };
  const auto isSameShape = [](const BodyShape& a, const BodyShape& b) {
    return a.solid && a.solid == b.solid && a.padding == b.padding &&
           a.body_from_shape.matrix() == b.body_from_shape.matrix();
  };
  return isObstacle(before) && isObstacle(after) && before.frame == after.frame && before.margin == after.margin &&
         before.group == after.group &&
         std::equal(before.shapes.begin(), before.shapes.end(), after.shapes.begin(), after.shapes.end(), isSameShape);
}

}  // namespace

const char* name(Freshness state) {
  static constexpr const char* kNames[] = {"FRESH", "LATE", "STALE", "LOST", "FROZEN", "INVALID", "UNPLACED"};
  return kNames[static_cast<int>(state)];
}

Scene::State::Slot& Scene::State::at(BodyId id) {
  if (id.slot >= slots.size() || !slots[id.slot].used || slots[id.slot].generation != id.generation) {
    throw Refusal(Code::unknown_id, "body handle " + std::to_string(id.slot) + " (generation " +
                                        std::to_string(id.generation) + ") is not valid; its body was removed");
  }
  return slots[id.slot];
}

Scene::Scene(const SceneOptions& options) : state_(std::make_unique<State>(options)) {
  checkTuning({options.margin, options.event_hysteresis, options.growth_cap, options.horizon});
  for (const PairMargin& pair : options.pair_margins) {
    checkLength(pair.margin, kLargestMargin,
                "margin of the pair '" + printable(pair.first) + "', '" + printable(pair.second) + "'");
  }
  checkLength(options.world_limit, kFarthestShape, "world_limit");
  checkLength(options.finest_edge, kLargestMargin, "finest_edge");
  if (options.finest_edge > 0.0 && options.finest_edge < 1e-6) {
    throw Refusal(Code::out_of_range,
                  "finest_edge is " + text(options.finest_edge) + " m; it must be 0 or at least 1e-06 m");
  }
}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;

/// Notes that the pose or the state of a body changes before the next commit. Allocates no memory.
void Scene::State::noteChange(std::uint32_t slot) {
  if (slots[slot].changed == commits + 1) return;  // noted already
  changes.note(slot);
  slots[slot].changed = commits + 1;
}

/// Returns the slots of the bodies to be removed, ascending.
/// @throws Refusal unknown_id; dup_id if a body occurs twice
std::vector<std::uint32_t> Scene::State::checkedSlots(const std::vector<BodyId>& out) {
  std::vector<std::uint32_t> leaving;
  for (const BodyId id : out) {
    at(id);
    leaving.push_back(id.slot);
  }
  std::sort(leaving.begin(), leaving.end());
  const auto twice = std::adjacent_find(leaving.begin(), leaving.end());
  if (twice != leaving.end()) {
    throw Refusal(Code::dup_id, "body '" + bodies[*twice]->name + "' is to be removed twice; list it only once");
  }
  return leaving;
}

/// Checks the bodies to be added, their names, and whether there is room for them.
void Scene::State::checkIn(const std::vector<std::uint32_t>& leaving, const std::vector<Body>& in) const {
  std::size_t count = slot_of_name.size() - leaving.size(), planes = plane_count;
  for (const std::uint32_t slot : leaving) planes -= planesOf(*bodies[slot]);
  std::unordered_set<std::string_view> names;
  names.reserve(in.size());
  for (const Body& body : in) {
    checkBody(body);
    const auto known = slot_of_name.find(body.name);
    const bool stays =
        known != slot_of_name.end() && !std::binary_search(leaving.begin(), leaving.end(), known->second);
    if (stays || !names.insert(body.name).second) {
      throw Refusal(Code::dup_id, "there is already a body '" + body.name + "'; every body must have its own name");
    }
    if (count++ >= options.max_bodies) {
      throw Refusal(Code::limit, "there is no room for body '" + body.name + "'; the world may have at most " +
                                     std::to_string(options.max_bodies) + " bodies (max_bodies)");
    }
    planes += planesOf(body);
    if (planes > options.max_planes) {
      throw Refusal(Code::limit, "there is no room for the planes of body '" + body.name +
                                     "'; the world may have at most " + std::to_string(options.max_planes) +
                                     " planes (max_planes)");
    }
  }
}

/// Returns slots for the bodies to be added: first the slots of the bodies to be removed, then free slots, then new
/// slots.
std::vector<std::uint32_t> Scene::State::slotsFor(const std::vector<std::uint32_t>& leaving, std::size_t count) const {
  std::vector<std::uint32_t> numbers;
  for (auto slot = leaving.rbegin(); slot != leaving.rend() && numbers.size() < count; ++slot) numbers.push_back(*slot);
  for (auto number = free_slots.rbegin(); number != free_slots.rend() && numbers.size() < count; ++number) {
    numbers.push_back(*number);
  }
  for (std::size_t number = slots.size(); numbers.size() < count; ++number) {
    numbers.push_back(static_cast<std::uint32_t>(number));
  }
  return numbers;
}

void Scene::State::reserveSlots(std::size_t count) {
  const auto reserve = [count](auto& values) {
    if (values.capacity() < count) values.reserve(std::max(count, 2 * values.capacity()));
  };
  reserve(slots);
  reserve(bodies);
  reserve(cells);
  reserve(free_slots);
  changes.reserve(count);
}

void Scene::State::takeOut(std::uint32_t slot) {
  slot_of_name.erase(bodies[slot]->name);
  plane_count -= planesOf(*bodies[slot]);
  bodies[slot].reset();
  cells[slot].reset();
  slots[slot].used = slots[slot].moved = false;
  ++slots[slot].generation;
  free_slots.push_back(slot);
}

void Scene::State::putIn(std::uint32_t slot, std::shared_ptr<const Body>&& body) {
  if (slot < slots.size()) {
    free_slots.pop_back();
  } else {
    slots.emplace_back();
    bodies.emplace_back();
    cells.emplace_back();
  }
  plane_count += planesOf(*body);
  slots[slot].used = true;
  slots[slot].fixed = body->mobility == Mobility::fixed;
  slots[slot].pose = BodyPose{};
  bodies[slot] = std::move(body);
}

std::vector<BodyId> Scene::exchange(const std::vector<BodyId>& out, std::vector<Body> in) {
  State& s = *state_;
  std::vector<std::uint32_t> leaving = s.checkedSlots(out);
  s.checkIn(leaving, in);
  std::vector<BodyId> ids(in.size());
  std::vector<std::size_t> entering;   // the bodies of `in` that need a slot; the others keep the one they have
  std::vector<std::uint32_t> staying;  // the slots of the others
  for (std::size_t i = 0; i < in.size(); ++i) {
    const auto known = s.slot_of_name.find(in[i].name);
    if (known == s.slot_of_name.end() || !isSameElsewhere(*s.bodies[known->second], in[i])) {
      entering.push_back(i);
      continue;
    }
    ids[i] = {known->second, s.slots[known->second].generation};
    staying.push_back(known->second);
  }
  std::sort(staying.begin(), staying.end());
  const auto stays = [&](std::uint32_t slot) { return std::binary_search(staying.begin(), staying.end(), slot); };
  leaving.erase(std::remove_if(leaving.begin(), leaving.end(), stays), leaving.end());
  const std::vector<std::uint32_t> numbers = s.slotsFor(leaving, entering.size());
  std::map<std::string, std::uint32_t> names;
  for (std::size_t i = 0; i < entering.size(); ++i) {
    names.emplace_hint(names.end(), in[entering[i]].name, numbers[i]);  // fast if the names are sorted
  }
  const std::size_t last = numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end()) + std::size_t{1};
  s.reserveSlots(std::max(s.slots.size(), last));
  std::vector<std::shared_ptr<const Body>> shared;
  for (Body& body : in) shared.push_back(std::make_shared<const Body>(std::move(body)));
  // The code below allocates no memory, so it cannot fail.
  for (const std::uint32_t slot : leaving) s.takeOut(slot);
  s.slot_of_name.merge(names);
  for (std::size_t i = 0; i < entering.size(); ++i) {
    s.putIn(numbers[i], std::move(shared[entering[i]]));
    ids[entering[i]] = {numbers[i], s.slots[numbers[i]].generation};
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (shared[i]) s.bodies[ids[i].slot] = std::move(shared[i]);  // this body keeps its slot
  }
  s.bodies_changed = s.bodies_changed || !out.empty() || !ids.empty();
  s.structure_changed = s.structure_changed || s.bodies_changed;
  return ids;
}

BodyId Scene::add(Body body) {
  std::vector<Body> in;
  in.push_back(std::move(body));
  return exchange({}, std::move(in)).front();
}

void Scene::remove(BodyId id) { exchange({id}, {}); }

bool Scene::find(const std::string& name, BodyId& id) const {
  const auto found = state_->slot_of_name.find(name);
  if (found == state_->slot_of_name.end()) return false;
  id = {found->second, state_->slots[found->second].generation};
  return true;
}

const Body& Scene::body(BodyId id) const {
  state_->at(id);
  return *state_->bodies[id.slot];
}
std::size_t Scene::size() const { return state_->slot_of_name.size(); }
const BodyPose& Scene::poseOf(BodyId id) const { return state_->at(id).pose; }

void Scene::checkPlace(BodyId id, const Pose& world_from_body) const {
  state_->at(id);
  if (!world_from_body.matrix().allFinite()) {
    throw Refusal(Code::nonfinite, "pose of body '" + state_->bodies[id.slot]->name +
                                       "' is not finite; every number in it must be finite");
  }
  const double limit = state_->options.world_limit;
  // A quick check first, because it takes time to build the text below.
  if (!(world_from_body.translation().cwiseAbs().maxCoeff() <= limit)) {
    checkWithin(world_from_body.translation(), limit, "pose of body '" + state_->bodies[id.slot]->name + "'");
  }
}

void Scene::place(BodyId id, const Pose& world_from_body, Time stamp) {
  checkPlace(id, world_from_body);
  State::Slot& slot = state_->at(id);
  const bool first = slot.pose.state == Freshness::unplaced;
  state_->noteChange(id.slot);
  slot.pose.stamp = stamp;
  if (!first && slot.pose.world_from_body.matrix() == world_from_body.matrix()) return;  // no tolerance
  slot.pose.world_from_body = world_from_body;
  if (first) slot.pose.state = Freshness::fresh;
  slot.moved = true;
}

void Scene::setState(BodyId id, Freshness state, double age, std::uint32_t cohort) {
  State::Slot& slot = state_->at(id);
  BodyPose& pose = slot.pose;
  if (pose.state == Freshness::unplaced) return;
  state_->noteChange(id.slot);
  pose.state = state == Freshness::unplaced ? Freshness::invalid : state;  // a placed body stays placed
  pose.age = slot.fixed ? 0.0 : age;
  pose.cohort = cohort;
}

void Scene::setCells(BodyId id, std::shared_ptr<const MapCells> cells) {
  State& s = *state_;
  s.at(id);
  const Body& body = *s.bodies[id.slot];
  if (!hasCells(body.kind) || !body.shapes.empty() || !cells || !cells->grid) {
    throw Refusal(Code::bad_geometry,
                  "body '" + body.name + "' cannot have occupied cells; only a map or cloud without shapes can");
  }
  s.cells[id.slot] = std::move(cells);
}

void Scene::setRules(std::vector<PairRule> rules) {
  state_->options.allowed_pairs = std::move(rules);
  state_->prepared.reset();
  state_->structure_changed = state_->rules_changed = true;
}

void Scene::setPreparedRules(PreparedRules prepared) {
  setRules(prepared.filter.rules());
  state_->prepared = std::move(prepared);
}

void Scene::removeRules(const std::vector<bool>& gone) {
  State& s = *state_;
  if (!s.structure_changed) {
    setPreparedRules({s.structure->filter.without(gone), s.structure->revision});
  } else if (s.prepared) {
    setPreparedRules({s.prepared->filter.without(gone), s.prepared->revision});
  } else {
    std::vector<PairRule> rules;
    for (std::size_t i = 0; i < gone.size(); ++i) {
      if (!gone[i]) rules.push_back(s.options.allowed_pairs[i]);
    }
    setRules(std::move(rules));
  }
}

void Scene::prepareNames(NameMatches matches) {
  std::vector<NameMatches>& kept = state_->name_matches;
  kept.push_back(std::move(matches));
  // The bodies may never be added, and the next commit with a new structure may come late. So the number of matches is
  // limited.
  std::size_t names = 0;
  auto oldest = kept.end();
  while (oldest != kept.begin() && kept.end() - oldest < kMostMatches) {
    names += std::prev(oldest)->names.size();
    if (names > state_->options.max_bodies) break;
    --oldest;
  }
  kept.erase(kept.begin(), oldest);
}

const std::vector<PairRule>& Scene::rules() const { return state_->options.allowed_pairs; }

void Scene::tune(const SceneTuning& tuning) {
  checkTuning(tuning);
  State& s = *state_;
  s.pair_events.setHysteresis(tuning.event_hysteresis);
  s.options.event_hysteresis = tuning.event_hysteresis;
  if (s.options.margin == tuning.margin && s.options.growth_cap == tuning.growth_cap &&
      s.options.horizon == tuning.horizon) {
    return;
  }
  // A new structure makes the next commit compute everything that it otherwise keeps from the last one.
  s.structure_changed = true;
  s.sizes_changed = s.sizes_changed || s.options.margin != tuning.margin;
  s.options.margin = tuning.margin;
  s.options.growth_cap = tuning.growth_cap;
  s.options.horizon = tuning.horizon;
  s.horizon.set(tuning.horizon, tuning.growth_cap);
}

void Scene::beginEpoch(std::uint64_t epoch) {
  state_->epoch = epoch;
  state_->sequence = 0;
  state_->tracker.clear();
  state_->pair_events.beginEpoch();
}

std::uint64_t Scene::revision() const { return state_->structure->revision; }
const TickTimes& Scene::lastTimes() const { return state_->times; }

int Scene::lastThreads() const { return state_->threads; }

}  // namespace hgrid
