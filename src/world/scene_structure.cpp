// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/scene_structure.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

Aabb sizeOf(const BodyShape& shape, double margin) {
  return grown(boxOf(shape.shape, Pose::Identity(), shape.padding, Eigen::Vector3d::Zero()), 0.5 * margin);
}

/// Adds bodies to a structure one by one, in the order of their names.
class Appender {
 public:
  Appender(const SceneStructure& before, double margin, SceneStructure& next)
      : before_(before), next_(next), margin_(margin), keeps_sizes_(before.least_margin == margin) {}

  /// @param known  index of the body in the structure before, or kNone
  void append(std::shared_ptr<const Body> body, const BodyId& id, std::uint32_t known);

 private:
  const SceneStructure& before_;
  SceneStructure& next_;
  const double margin_;
  const bool keeps_sizes_;  // whether `before_` has the same margin
};

void Appender::append(std::shared_ptr<const Body> shared, const BodyId& id, std::uint32_t known) {
  const Body& body = *shared;
  const auto index = static_cast<std::uint32_t>(next_.ids.size());
  const bool is_fixed = body.mobility == Mobility::fixed;
  if (!body.covered && !body.waived) next_.uncovered.push_back(index);
  if (hasCells(body.kind)) next_.maps.push_back(index);
  next_.first_proxy.push_back(static_cast<std::uint32_t>(next_.body_of_proxy.size()));
  next_.ids.push_back(id);
  next_.margin.push_back(std::max(margin_, body.margin));
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    const BodyShape& shape = body.shapes[i];
    const auto proxy = static_cast<ProxyId>(next_.shapes.size());
    const bool is_plane = shape.shape.kind() == ShapeKind::plane;
    if (is_plane) next_.planes.push_back(proxy);
    if (is_fixed && !is_plane) next_.fixed_proxies.push_back(proxy);
    next_.body_of_proxy.push_back(index);
    next_.shapes.push_back(&shape);
    const bool has_size = known != Structure::kNone && keeps_sizes_;
    next_.sizes.push_back(has_size ? before_.sizes[before_.first_proxy[known] + i] : sizeOf(shape, margin_));
  }
  next_.bodies.push_back(std::move(shared));
}

void reserveLike(const SceneStructure& before, std::size_t more, SceneStructure& next) {
  const std::size_t bodies = before.bodies.size() + more, proxies = before.shapes.size() + more;
  next.bodies.reserve(bodies);
  next.ids.reserve(bodies);
  next.margin.reserve(bodies);
  next.first_proxy.reserve(bodies + 1);
  next.body_of_proxy.reserve(proxies);
  next.shapes.reserve(proxies);
  next.sizes.reserve(proxies);
  next.fixed_proxies.reserve(before.fixed_proxies.size() + more);
}

/// Finds the source of each body, and the required bodies that are absent.
void fillSources(const std::vector<std::string>& required, Structure& structure) {
  std::vector<std::string> found;  // the sources; successive bodies with the same source share an element
  structure.source_of.reserve(structure.bodies.size());
  for (const Body& body : structure.bodies) {
    std::string source = sourceOf(body);
    if (found.empty() || found.back() != source) found.push_back(std::move(source));
    structure.source_of.push_back(static_cast<std::uint32_t>(found.size() - 1));
  }
  const std::set<std::string> sources(found.begin(), found.end());
  structure.sources.assign(sources.begin(), sources.end());
  std::vector<std::uint32_t> sorted;  // for each element of `found`: its index in Structure::sources
  for (const std::string& source : found) {
    const auto at = std::lower_bound(structure.sources.begin(), structure.sources.end(), source);
    sorted.push_back(static_cast<std::uint32_t>(at - structure.sources.begin()));
  }
  for (std::uint32_t& source : structure.source_of) source = sorted[source];
  for (const std::string& pattern : required) {
    const bool present = std::any_of(structure.bodies.begin(), structure.bodies.end(),
                                     [&](const Body& body) { return matches(pattern, body.name); });
    if (!present) structure.absent.push_back(pattern);
  }
}

}  // namespace

std::shared_ptr<SceneStructure> nextStructure(const SceneStructure& before, const BodyChange& change, double margin,
                                              const SceneOptions& options, const FilterMaker& filter) {
  auto next = std::make_shared<SceneStructure>();
  next->revision = before.revision + 1;
  next->least_margin = margin;
  reserveLike(before, change.in.size(), *next);
  std::vector<std::uint32_t> known;
  known.reserve(before.bodies.size() + change.in.size());
  Appender appender(before, margin, *next);
  auto out = change.out.begin();
  auto in = change.in.begin();
  std::uint32_t body = 0;
  // Appends the bodies of the structure before that stay, from the next one up to the one before index `end`.
  const auto keepUntil = [&](std::uint32_t end) {
    for (; body < end; ++body) {
      if (out != change.out.end() && *out == body) {
        ++out;
        continue;
      }
      known.push_back(body);
      appender.append(before.bodies.share(body), before.ids[body], body);
    }
  };
  for (; in != change.in.end(); ++in) {
    keepUntil(before.countBefore(in->body->name));
    known.push_back(in->replaces);
    appender.append(in->body, in->id, in->replaces);
  }
  keepUntil(static_cast<std::uint32_t>(before.bodies.size()));
  next->first_proxy.push_back(static_cast<std::uint32_t>(next->body_of_proxy.size()));
  next->pair_margins = PairMargins(next->bodies, options.pair_margins);
  next->filter = filter(next->bodies, known);
  next->silenced = silencesAll(next->bodies, options.pair_kinds, next->filter);
  fillSources(options.required, *next);
  next->scale = GridScale::fitting(next->sizes);  // the smallest box counts, so the huge boxes of planes do not matter
  if (options.finest_edge > 0.0) next->scale.finest_edge = options.finest_edge;
  return next;
}

}  // namespace hgrid
