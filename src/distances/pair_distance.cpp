// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/distances/pair_distance.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "distances/map_meter.h"
#include "distances/nearest_shapes.h"
#include "hgrid_proximity/geometry/float_environment.h"
#include "narrow/measured_contact.h"

namespace hgrid {
namespace {

/// Collects the pairs of shapes whose boxes are at most `up_to` [m] apart, nearest boxes first.
void collectShapePairs(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second, double up_to,
                       std::vector<ShapePair>& shape_pairs) {
  const std::vector<ProxyId>& begin = snapshot.structure().first_proxy;
  shape_pairs.clear();
  for (ProxyId a = begin[first]; a < begin[first + 1]; ++a) {
    for (ProxyId b = begin[second]; b < begin[second + 1]; ++b) {
      const double gap = snapshot.gapOfProxies(a, b);
      if (gap <= up_to) shape_pairs.push_back({gap, a - begin[first], b - begin[second]});
    }
  }
  std::sort(shape_pairs.begin(), shape_pairs.end(), [](const ShapePair& a, const ShapePair& b) {
    return std::tie(a.gap, a.first, a.second) < std::tie(b.gap, b.first, b.second);
  });
}

/// Calls `ask` with the placed solids of a pair of shapes. Does nothing if one of the shapes has no solid.
template <class Ask>
void placed(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second, const ShapePair& shapes, Ask&& ask) {
  const BodyList& bodies = snapshot.structure().bodies;
  const BodyShape &a = bodies[first].shapes[shapes.first], &b = bodies[second].shapes[shapes.second];
  if (!a.solid || !b.solid) return;
  const Pose world_from_a = snapshot.poses()[first].world_from_body * a.body_from_shape;
  const Pose world_from_b = snapshot.poses()[second].world_from_body * b.body_from_shape;
  ask(PlacedSolid{*a.solid, world_from_a, a.padding}, PlacedSolid{*b.solid, world_from_b, b.padding});
}

}  // namespace

NearestShapes nearestShapes(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                            std::uint32_t second, double up_to, std::vector<ShapePair>& shape_pairs) {
  NearestShapes nearest;
  if (snapshot.structure().isMap(first) || snapshot.structure().isMap(second)) {
    MapProximity found = measureMap(narrow_phase, snapshot, first, second, up_to);
    (snapshot.structure().isMap(first) ? nearest.second : nearest.first) = found.shape;
    nearest.proximity = found.proximity;
    nearest.contact = found.contact;
    nearest.cells = std::move(found.cells);
    return nearest;
  }
  const BodyList& bodies = snapshot.structure().bodies;
  if (bodies[first].shapes.empty() || bodies[second].shapes.empty()) return nearest;  // nothing to measure
  collectShapePairs(snapshot, first, second, up_to, shape_pairs);
  nearest.proximity.status = Measure::apart;
  nearest.proximity.distance = std::numeric_limits<double>::infinity();
  double least = up_to, least_bound = nearest.proximity.distance;
  for (const ShapePair& shapes : shape_pairs) {
    if (shapes.gap > least) break;
    Proximity found;
    Contact contact;
    placed(snapshot, first, second, shapes, [&](const PlacedSolid& a, const PlacedSolid& b) {
      found = narrow_phase.measure(a, b, least);
      contact = measuredContact(narrow_phase, a, b, found.status);
    });
    if (found.status == Measure::not_measured || found.distance < nearest.proximity.distance) {
      nearest = {shapes.first, shapes.second, found, contact, {}};
    }
    least_bound = std::min(least_bound, found.lower_bound);
    if (found.status != Measure::apart) break;  // no other pair of shapes can be nearer
    least = std::min(least, found.distance);
  }
  if (nearest.proximity.status == Measure::apart) nearest.proximity.lower_bound = least_bound;
  return nearest;
}

PairDistance measurePair(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                         std::uint32_t second, double up_to) {
  const DefaultFloatEnvironment environment;
  std::vector<ShapePair> shape_pairs;
  const NearestShapes nearest = nearestShapes(narrow_phase, snapshot, first, second, up_to, shape_pairs);
  PairDistance result;
  result.first = first;
  result.second = second;
  result.first_shape = nearest.first;
  result.second_shape = nearest.second;
  result.proximity = nearest.proximity;
  result.contact = nearest.contact;
  result.cells = nearest.cells;
  return result;
}

std::vector<PairContact> contactsOf(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                    std::uint32_t second, std::size_t most) {
  const DefaultFloatEnvironment environment;
  std::vector<PairContact> contacts;
  std::vector<ShapePair> shape_pairs;
  if (snapshot.structure().isMap(first) || snapshot.structure().isMap(second)) {
    contacts = contactsWithMap(narrow_phase, snapshot, first, second, most);
  } else {
    collectShapePairs(snapshot, first, second, 0.0, shape_pairs);
  }
  for (const ShapePair& shapes : shape_pairs) {
    placed(snapshot, first, second, shapes, [&](const PlacedSolid& a, const PlacedSolid& b) {
      for (const Contact& contact : narrow_phase.contacts(a, b, most - contacts.size())) {
        contacts.push_back({shapes.first, shapes.second, contact});
      }
    });
  }
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const PairContact& a, const PairContact& b) { return deeper(a.contact, b.contact); });
  return contacts;
}

}  // namespace hgrid
