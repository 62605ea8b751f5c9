// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The part of a scene that makes and sets a new structure after bodies, rules or margins changed.
#include <algorithm>
#include <cstddef>
#include <utility>

#include "world/scene_state.h"

namespace hgrid {

/// Returns the filter of the next structure. Uses an earlier filter with the same rules, if there is one.
/// @param next   the bodies of the next structure
/// @param known  for each of them: its index in the present structure, or Structure::kNone
PairFilter Scene::State::filterFor(const BodyList& next, const std::vector<std::uint32_t>& known) const {
  static_assert(PairFilter::kUnknown == Structure::kNone);
  const PairFilter* earlier = nullptr;
  if (!rules_changed) earlier = &structure->filter;
  if (prepared_rules && prepared_rules->revision == structure->revision) earlier = &prepared_rules->filter;
  if (earlier == nullptr) return PairFilter(next, options.pair_kinds, options.allowed_pairs);
  return bodies_changed ? earlier->forBodies(next, known, name_matches) : *earlier;
}

/// Returns how the bodies of the scene differ from those of the present structure.
BodyChange Scene::State::changeOfBodies() const {
  BodyChange change;
  change.out = left;
  std::sort(change.out.begin(), change.out.end());
  change.out.erase(std::unique(change.out.begin(), change.out.end()), change.out.end());
  for (const std::uint32_t body : change.out) {
    const BodyId id = structure->ids[body];
    if (isThere(id)) change.in.push_back({bodies[id.slot], id, body});  // it was replaced; otherwise, it left
  }
  const auto replaced = static_cast<std::ptrdiff_t>(change.in.size());
  for (const auto& [name, slot] : entered) change.in.push_back({bodies[slot], {slot, slots[slot].generation}});
  std::inplace_merge(change.in.begin(), change.in.begin() + replaced, change.in.end(),  // both parts are sorted by name
                     [](const EnteringBody& a, const EnteringBody& b) { return a.body->name < b.body->name; });
  return change;
}

void Scene::State::renewStructure() {
  std::shared_ptr<const SceneStructure> next =
      nextStructure(*structure, changeOfBodies(), options.margin, options,
                    [this](const BodyList& all, const auto& known) { return filterFor(all, known); });
  std::vector<std::uint32_t> places(slots.size(), Structure::kNone);
  std::vector<bool> watched(next->bodies.size());
  setStructure(std::move(next), std::move(places), std::move(watched));
}

/// Replaces the structure. Allocates no memory, so it cannot fail.
/// @param places   Structure::kNone for each slot
/// @param watched  false for each body of the structure
void Scene::State::setStructure(std::shared_ptr<const SceneStructure> next, std::vector<std::uint32_t> places,
                                std::vector<bool> watched) {
  structure = std::move(next);
  body_of_slot = std::move(places);
  is_watched = std::move(watched);
  for (std::uint32_t body = 0; body < structure->ids.size(); ++body) body_of_slot[structure->ids[body].slot] = body;
  entered.clear();
  left.clear();
  options_changed = bodies_changed = false;
  rules_changed = options.allowed_pairs != structure->filter.rules();
  prepared_rules.reset();
  name_matches.clear();
}

}  // namespace hgrid
