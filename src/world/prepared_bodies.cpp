// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/prepared_bodies.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/refusal.h"
#include "world/scene_state.h"

namespace hgrid {
namespace {

/// Returns the slots of bodies, ascending.
std::vector<std::uint32_t> slotsOf(const std::vector<BodyId>& ids) {
  std::vector<std::uint32_t> slots;
  slots.reserve(ids.size());
  for (const BodyId id : ids) slots.push_back(id.slot);
  std::sort(slots.begin(), slots.end());
  return slots;
}

std::vector<std::string> namesOf(const EnteringBodies& bodies) {
  std::vector<std::string> names;
  names.reserve(bodies.size());
  for (const std::shared_ptr<const Body>& body : bodies) names.push_back(body->name);
  return names;
}

}  // namespace

PreparedBodies::PreparedBodies() : data_(std::make_unique<Data>()) {}
PreparedBodies::PreparedBodies(PreparedBodies&&) noexcept = default;
PreparedBodies& PreparedBodies::operator=(PreparedBodies&&) noexcept = default;
PreparedBodies::~PreparedBodies() = default;

PreparedBodies Scene::prepare(const Snapshot& newest, const std::vector<std::string>& out, std::vector<Body> in,
                              const std::optional<std::vector<PairRule>>& rules) const {
  const DefaultFloatEnvironment environment;
  const SceneOptions& options = state_->first_options;
  PreparedBodies prepared;
  PreparedBodies::Data& data = *prepared.data_;
  data.before = std::static_pointer_cast<const SceneStructure>(newest.structure_);
  const SceneStructure& before = *data.before;
  data.in.reserve(in.size());
  for (Body& body : in) data.in.push_back(std::make_shared<const Body>(std::move(body)));
  std::vector<std::uint32_t>& leaving = data.change.out;
  for (const std::string& name : out) {
    const std::uint32_t body = before.find(name);
    if (body == Structure::kNone) {
      throw Refusal(Code::unknown_id,
                    "there is no body '" + printable(name) + "'; only an existing body can be removed");
    }
    leaving.push_back(body);
  }
  std::sort(leaving.begin(), leaving.end());
  const auto twice = std::adjacent_find(leaving.begin(), leaving.end());
  if (twice != leaving.end()) throw removedTwice(before.bodies[*twice]);
  std::size_t planes = before.planes.size();
  for (const std::uint32_t body : leaving) planes -= planesOf(before.bodies[body]);
  checkEntering(data.in, before.bodies.size() - leaving.size(), planes, options, [&](const std::string& name) {
    const std::uint32_t body = before.find(name);
    return body != Structure::kNone && !std::binary_search(leaving.begin(), leaving.end(), body);
  });
  data.sorted.resize(data.in.size());
  std::iota(data.sorted.begin(), data.sorted.end(), std::size_t{0});
  std::sort(data.sorted.begin(), data.sorted.end(),
            [&](std::size_t a, std::size_t b) { return data.in[a]->name < data.in[b]->name; });
  for (const std::size_t index : data.sorted) {
    const std::shared_ptr<const Body>& body = data.in[index];
    const std::uint32_t known = before.find(body->name);
    if (known != Structure::kNone && isSameElsewhere(before.bodies[known], *body)) {
      data.change.in.push_back({body, before.ids[known], known});
    } else {
      data.change.in.push_back({body, {}});
    }
  }
  if (!rules) data.matches = before.filter.match(namesOf(data.in));
  data.next = nextStructure(before, data.change, before.least_margin, options,
                            [&](const BodyList& bodies, const std::vector<std::uint32_t>& known) {
                              if (rules) return PairFilter(bodies, options.pair_kinds, *rules);
                              return before.filter.forBodies(bodies, known, {data.matches});
                            });
  for (const EnteringBody& entering : data.change.in) data.places.push_back(data.next->find(entering.body->name));
  data.watched.resize(data.next->bodies.size());
  return prepared;
}

std::vector<BodyId> Scene::exchangePrepared(const std::vector<BodyId>& out, PreparedBodies&& in) {
  PreparedBodies::Data& data = *in.data_;
  if (state_->isUpToDate(data, out)) return state_->exchange(data);
  // The prepared structure is out of date, so the next commit makes one.
  if (!data.matches.names.empty()) prepareNames(std::move(data.matches));  // it may throw, so it comes first
  return state_->exchange(out, std::move(data.in));
}

/// Returns whether `prepared` was made for the present structure, and for the removal of exactly the bodies `out`.
bool Scene::State::isUpToDate(const PreparedBodies::Data& prepared, const std::vector<BodyId>& out) const {
  if (isOutdated() || structure != prepared.before || out.size() != prepared.change.out.size()) return false;
  std::vector<BodyId> expected;
  expected.reserve(out.size());
  for (const std::uint32_t body : prepared.change.out) expected.push_back(structure->ids[body]);
  return slotsOf(out) == slotsOf(expected) &&
         std::all_of(out.begin(), out.end(), [&](BodyId id) { return isThere(id); });
}

std::vector<BodyId> Scene::State::exchange(PreparedBodies::Data& prepared) {
  std::vector<EnteringBody>& in = prepared.change.in;
  std::vector<bool> stays(structure->bodies.size());  // whether the same obstacle at another place keeps the handle
  std::vector<std::uint32_t> leaving;                 // slots
  std::size_t entering = 0;
  for (const EnteringBody& body : in) {
    if (body.replaces == Structure::kNone) {
      ++entering;
    } else {
      stays[body.replaces] = true;
    }
  }
  for (const std::uint32_t body : prepared.change.out) {
    if (!stays[body]) leaving.push_back(structure->ids[body].slot);
  }
  std::sort(leaving.begin(), leaving.end());
  const std::vector<std::uint32_t> numbers = slotsFor(leaving, entering);
  std::vector<std::uint32_t> places(reserveSlots(numbers), Structure::kNone);
  std::vector<BodyId> ids(in.size());
  // The code below allocates no memory, so it cannot fail.
  for (const std::uint32_t slot : leaving) takeOut(slot);
  auto number = numbers.begin();
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (in[i].replaces == Structure::kNone) {
      in[i].id = putIn(*number++, std::move(in[i].body));
      prepared.next->ids[prepared.places[i]] = in[i].id;
    } else {
      bodies[in[i].id.slot] = std::move(in[i].body);
    }
    ids[prepared.sorted[i]] = in[i].id;
  }
  setStructure(std::move(prepared.next), std::move(places), std::move(prepared.watched));
  return ids;
}

}  // namespace hgrid
