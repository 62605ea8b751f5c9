// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/world/scene.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "world/scene_state.h"

namespace hgrid {
namespace {

constexpr std::ptrdiff_t kMostMatches = 64;  // most elements of State::name_matches; each has a copy of all globs

void checkTuning(const SceneTuning& tuning) {
  checkLength(tuning.margin, kLargestMargin, "margin");
  checkLength(tuning.event_hysteresis, kLargestMargin, "event_hysteresis");
  checkLength(tuning.growth_cap, kLargestMargin, "growth_cap");
  if (!(tuning.horizon >= 0.0 && tuning.horizon <= 60.0)) {
    throw Refusal(Code::out_of_range, "horizon is " + text(tuning.horizon) + " s; it must be within 0 .. 60 s");
  }
}

}  // namespace

const char* name(Freshness state) {
  static constexpr const char* kNames[] = {"FRESH", "LATE", "STALE", "LOST", "FROZEN", "INVALID", "UNPLACED"};
  return kNames[static_cast<int>(state)];
}

Scene::State::Slot& Scene::State::at(BodyId id) {
  if (!isThere(id)) {
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
  constexpr double kLeastEdge = 1e-6;  // [m]
  if (options.finest_edge > 0.0 && options.finest_edge < kLeastEdge) {
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
  if (twice != leaving.end()) throw removedTwice(*bodies[*twice]);
  return leaving;
}

/// Returns slots for bodies that enter: first the slots of bodies that leave, then free slots, then new slots.
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

/// Reserves memory, so that putIn() does not allocate. @param numbers  the slots that will be used
/// @returns the number of slots when these are used
std::size_t Scene::State::reserveSlots(const std::vector<std::uint32_t>& numbers) {
  const std::size_t last = numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end()) + std::size_t{1};
  const std::size_t count = std::max(slots.size(), last);
  const auto reserve = [count](auto& values) {
    if (values.capacity() < count) values.reserve(std::max(count, 2 * values.capacity()));
  };
  reserve(slots);
  reserve(bodies);
  reserve(cells);
  reserve(free_slots);
  changes.reserve(count);
  return count;
}

void Scene::State::takeOut(std::uint32_t slot) {
  plane_count -= planesOf(*bodies[slot]);
  bodies[slot].reset();
  cells[slot].reset();
  slots[slot].used = slots[slot].moved = false;
  ++slots[slot].generation;
  free_slots.push_back(slot);
  --body_count;
}

/// @returns the handle of the body
BodyId Scene::State::putIn(std::uint32_t slot, std::shared_ptr<const Body> body) {
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
  ++body_count;
  return {slot, slots[slot].generation};
}

/// Returns the slot of the body with this name, or Structure::kNone.
std::uint32_t Scene::State::slotOf(const std::string& name) const {
  const auto found = entered.find(name);
  if (found != entered.end()) return found->second;
  const std::uint32_t body = structure->find(name);
  return body != Structure::kNone && isThere(structure->ids[body]) ? structure->ids[body].slot : Structure::kNone;
}

/// Returns the index in `structure` of the body in a slot, or Structure::kNone if the structure lacks the body.
std::uint32_t Scene::State::indexOf(std::uint32_t slot) const {
  const std::uint32_t body = slot < body_of_slot.size() ? body_of_slot[slot] : Structure::kNone;
  return body != Structure::kNone && isThere(structure->ids[body]) ? body : Structure::kNone;
}

std::vector<BodyId> Scene::State::exchange(const std::vector<BodyId>& out, EnteringBodies in) {
  std::vector<std::uint32_t> leaving = checkedSlots(out);
  std::size_t planes = plane_count;
  for (const std::uint32_t slot : leaving) planes -= planesOf(*bodies[slot]);
  checkEntering(in, body_count - leaving.size(), planes, options, [&](const std::string& name) {
    const std::uint32_t slot = slotOf(name);
    return slot != Structure::kNone && !std::binary_search(leaving.begin(), leaving.end(), slot);
  });
  std::vector<BodyId> ids(in.size());
  std::vector<std::size_t> entering;   // the bodies of `in` that need a slot; the others keep the one they have
  std::vector<std::uint32_t> staying;  // the slots of the others
  for (std::size_t i = 0; i < in.size(); ++i) {
    const std::uint32_t slot = slotOf(in[i]->name);
    if (slot == Structure::kNone || !isSameElsewhere(*bodies[slot], *in[i])) {
      entering.push_back(i);
      continue;
    }
    ids[i] = {slot, slots[slot].generation};
    staying.push_back(slot);
  }
  std::sort(staying.begin(), staying.end());
  const auto stays = [&](std::uint32_t slot) { return std::binary_search(staying.begin(), staying.end(), slot); };
  leaving.erase(std::remove_if(leaving.begin(), leaving.end(), stays), leaving.end());
  const std::vector<std::uint32_t> numbers = slotsFor(leaving, entering.size());
  std::map<std::string, std::uint32_t> names;
  for (std::size_t i = 0; i < entering.size(); ++i) {
    names.emplace_hint(names.end(), in[entering[i]]->name, numbers[i]);  // fast if the names are sorted
  }
  reserveSlots(numbers);
  const std::size_t most_left = left.size() + leaving.size() + staying.size();
  if (left.capacity() < most_left) left.reserve(std::max(most_left, 2 * left.capacity()));
  // The code below allocates no memory, so it cannot fail.
  bodies_changed = bodies_changed || !out.empty() || !ids.empty();
  const auto noteLeft = [this](std::uint32_t slot) {
    const std::uint32_t body = indexOf(slot);
    if (body != Structure::kNone) left.push_back(body);
    return body != Structure::kNone;
  };
  for (const std::uint32_t slot : leaving) {
    if (!noteLeft(slot)) entered.erase(bodies[slot]->name);
    takeOut(slot);
  }
  for (const std::uint32_t slot : staying) noteLeft(slot);
  entered.merge(names);
  for (std::size_t i = 0; i < entering.size(); ++i) ids[entering[i]] = putIn(numbers[i], std::move(in[entering[i]]));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (in[i]) bodies[ids[i].slot] = std::move(in[i]);  // this body keeps its slot
  }
  return ids;
}

std::vector<BodyId> Scene::exchange(const std::vector<BodyId>& out, std::vector<Body> in) {
  EnteringBodies shared;
  shared.reserve(in.size());
  for (Body& body : in) shared.push_back(std::make_shared<const Body>(std::move(body)));
  return state_->exchange(out, std::move(shared));
}

BodyId Scene::add(Body body) {
  std::vector<Body> in;
  in.push_back(std::move(body));
  return exchange({}, std::move(in)).front();
}

void Scene::remove(BodyId id) { exchange({id}, {}); }

bool Scene::find(const std::string& name, BodyId& id) const {
  const std::uint32_t slot = state_->slotOf(name);
  if (slot == Structure::kNone) return false;
  id = {slot, state_->slots[slot].generation};
  return true;
}

const Body& Scene::body(BodyId id) const {
  state_->at(id);
  return *state_->bodies[id.slot];
}
std::size_t Scene::size() const { return state_->body_count; }
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

void Scene::setState(BodyId id, Freshness state, double age, std::uint32_t cohort, double period) {
  State::Slot& slot = state_->at(id);
  BodyPose& pose = slot.pose;
  if (pose.state == Freshness::unplaced) return;
  state_->noteChange(id.slot);
  pose.state = state == Freshness::unplaced ? Freshness::invalid : state;  // a placed body stays placed
  pose.age = slot.fixed ? 0.0 : age;
  pose.period = slot.fixed ? 0.0 : period;
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
  State& s = *state_;
  s.options.allowed_pairs = std::move(rules);
  s.prepared_rules.reset();
  // Before the first commit, the structure has no filter yet.
  s.rules_changed = s.structure->revision == 0 || s.options.allowed_pairs != s.structure->filter.rules();
}

void Scene::setPreparedRules(PreparedRules prepared) {
  setRules(prepared.filter.rules());
  state_->prepared_rules = std::move(prepared);
}

void Scene::removeRules(const std::vector<bool>& gone) {
  State& s = *state_;
  if (!s.rules_changed) {
    setPreparedRules({s.structure->filter.without(gone), s.structure->revision});
  } else if (s.prepared_rules) {
    setPreparedRules({s.prepared_rules->filter.without(gone), s.prepared_rules->revision});
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
  s.options_changed = true;
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
