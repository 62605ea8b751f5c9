// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/distances_messages.h"

#include <algorithm>

#include "node/messages/pair_points.h"

namespace hgrid {
namespace {

/// Appends to `names` the names of all bodies of the first `shown` pairs, sorted, each once.
/// @returns the indices of these bodies in Structure::bodies, in the same order
std::vector<std::uint32_t> fillNames(const Structure& structure, const PairDistances& distances, std::size_t shown,
                                     std::vector<std::string>& names) {
  std::vector<std::uint32_t> numbers;
  for (std::size_t i = 0; i < shown; ++i) {
    numbers.push_back(distances.pairs[i].first);
    numbers.push_back(distances.pairs[i].second);
  }
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (const std::uint32_t body : numbers) names.push_back(structure.bodies[body].name);
  return numbers;
}

}  // namespace

boost::shared_ptr<msg::Distances> distancesMessage(const Tick& tick, const msg::WorldState& world,
                                                   const PairDistances* distances, const Params& params) {
  auto message = boost::make_shared<msg::Distances>();
  message->header = headerOf(tick);
  message->world = world;
  if (!tick.snapshot || distances == nullptr) return message;
  const Snapshot& snapshot = *tick.snapshot;
  const std::size_t shown = std::min(distances->pairs.size(), static_cast<std::size_t>(params.max_pairs));
  message->total = static_cast<std::uint32_t>(distances->pairs.size());
  message->truncated = shown < distances->pairs.size() || snapshot.truncated();
  message->longest_wait = distances->longest_wait;
  const std::vector<std::uint32_t> named = fillNames(snapshot.structure(), *distances, shown, message->names);
  const auto number = [&](std::uint32_t body) {
    return static_cast<std::uint32_t>(std::lower_bound(named.begin(), named.end(), body) - named.begin());
  };
  for (std::size_t i = 0; i < shown; ++i) {
    const PairDistance& pair = distances->pairs[i];
    message->first.push_back(number(pair.first));
    message->second.push_back(number(pair.second));
    message->status.push_back(static_cast<std::uint8_t>(pair.proximity.status));
    message->distance.push_back(pair.proximity.distance);
    message->lower_bound.push_back(pair.lower_bound);
    message->gap.push_back(pair.gap);
    message->measured.push_back(toRos(pair.measured));
    const PairPoints points = pointsOf(pair);
    message->point_on_first.push_back(toPoint(points.on_first));
    message->point_on_second.push_back(toPoint(points.on_second));
    message->contact_point.push_back(toPoint(pair.contact.point));
    message->normal.push_back(toVector(points.normal));
    message->depth.push_back(pair.contact.depth);
    message->approach.push_back(static_cast<std::uint8_t>(pair.approach));
    message->closing_speed.push_back(pair.closing_speed);
    message->time_to_contact.push_back(pair.time_to_contact);
    message->no_contact_before.push_back(pair.no_contact_before);
    message->flags.push_back(pair.flags);
    message->first_shape.push_back(pair.first_shape);
    message->second_shape.push_back(pair.second_shape);
    message->first_state.push_back(static_cast<std::uint8_t>(snapshot.poses()[pair.first].state));
    message->second_state.push_back(static_cast<std::uint8_t>(snapshot.poses()[pair.second].state));
    for (const NearCell& cell : pair.cells) {
      message->cell_center.push_back(toPoint(cell.center));
      message->cell_edge.push_back(cell.edge);
      message->cell_distance.push_back(cell.distance);
    }
    message->cells_end.push_back(static_cast<std::uint32_t>(message->cell_edge.size()));
  }
  return message;
}

}  // namespace hgrid
