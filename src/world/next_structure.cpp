// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The part of Scene::commit() that makes a new structure after bodies, rules or margins changed.
#include <algorithm>

#include "world/scene_state.h"

namespace hgrid {
namespace {

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
  return bodies_changed ? earlier->forBodies(next, known, name_matches) : *earlier;
}

void Scene::State::rebuildStructure() {
  auto next = std::make_shared<Structure>();
  next->revision = structure->revision + 1;
  next->least_margin = options.margin;
  const BodiesBefore before(*structure, slots.size());
  std::vector<Aabb> next_sizes;
  std::vector<std::uint32_t> next_uncovered, known_bodies;
  std::vector<const BodyShape*> next_shapes;
  std::vector<std::uint32_t> next_body_of_slot(slots.size(), Structure::kNone);
  next->bodies.reserve(slot_of_name.size());
  next->ids.reserve(slot_of_name.size());
  next->margin.reserve(slot_of_name.size());
  next->first_proxy.reserve(slot_of_name.size() + 1);
  next->body_of_proxy.reserve(shapes.size());  // roughly
  known_bodies.reserve(slot_of_name.size());
  next_shapes.reserve(shapes.size());
  next_sizes.reserve(shapes.size());
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
      next_shapes.push_back(&shape);
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
  is_watched.swap(next_is_watched);
  structure = std::move(next);
  scale = GridScale::fitting(sizes);  // the smallest box counts, so the huge boxes of planes do not matter
  if (options.finest_edge > 0.0) scale.finest_edge = options.finest_edge;
  structure_changed = bodies_changed = rules_changed = sizes_changed = false;
  prepared.reset();
  name_matches.clear();
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

}  // namespace hgrid
