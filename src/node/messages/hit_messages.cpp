// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/hit_messages.h"

#include <algorithm>

#include "hgrid_proximity/pairs/pair_rule.h"

namespace hgrid {

HitWriter::HitWriter(const Snapshot& snapshot, const Pose& frame_from_world, double age_since)
    : snapshot_(snapshot), frame_from_world_(frame_from_world), age_since_(age_since) {
  const Structure& structure = snapshot.structure();
  for (const PairRule& rule : structure.filter.rules()) {
    if (rule.origin == Origin::attached) carried_.push_back(structure.find(rule.first));
  }
  std::sort(carried_.begin(), carried_.end());
}

msg::Hit HitWriter::message(const QueryHit& source) const {
  msg::Hit hit;
  hit.name = snapshot_.structure().bodies[source.body].name;
  hit.shape = source.shape;
  hit.cell_edge = source.cell_edge;
  hit.status = static_cast<std::uint8_t>(source.status);
  hit.distance = source.distance;
  hit.signed_distance = source.signed_distance;
  hit.depth = source.depth;
  hit.center_distance = source.center_distance;
  hit.along = source.along;
  hit.point = point(source.point);
  hit.own_point = point(source.own_point);
  hit.normal = vector(source.normal);
  hit.state = state(source.body);
  hit.age = age(source.body);
  hit.carried = isCarried(source.body);
  return hit;
}

double HitWriter::age(std::uint32_t body) const {
  const bool is_fixed = snapshot_.structure().bodies[body].mobility == Mobility::fixed;
  return is_fixed ? 0.0 : snapshot_.poses()[body].age + age_since_;
}

bool HitWriter::isCarried(std::uint32_t body) const {
  return std::binary_search(carried_.begin(), carried_.end(), body);
}

}  // namespace hgrid
