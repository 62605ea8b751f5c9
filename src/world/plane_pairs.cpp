// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "world/plane_pairs.h"

#include <algorithm>
#include <iterator>

#include "world/pair_margin.h"

namespace hgrid {
namespace {

/// Returns the range [m] of a body. A pair of bodies is reported only if its gap is at most the sum of their ranges,
/// unless the horizon is on.
double rangeOf(std::uint32_t body, const Snapshot& snapshot) {
  const Structure& structure = snapshot.structure();
  return std::max(structure.margin[body], structure.pair_margins.largestOf(body)) + snapshot.poses()[body].growth;
}

}  // namespace

/// Prepares for a new structure: lists the partners of each plane. Keeps where each plane was in the last accepted
/// tick.
void PlanePairs::renumber(const Structure& structure) {
  std::vector<OfPlane> next(structure.planes.size());
  for (std::size_t i = 0; i < next.size(); ++i) {
    const ProxyId proxy = structure.planes[i];
    const std::uint32_t body = structure.body_of_proxy[proxy];
    next[i].body = structure.ids[body];
    next[i].shape = structure.shapeOf(proxy);
    for (const OfPlane& known : planes_) {
      if (known.body != next[i].body || known.shape != next[i].shape) continue;
      next[i].before = known.before;
      next[i].was_placed = known.was_placed;
    }
    for (std::uint32_t other = 0; other < structure.bodies.size(); ++other) {
      if (structure.isMap(other) || structure.filter.allowed(body, other)) continue;
      for (ProxyId box = structure.first_proxy[other]; box < structure.first_proxy[other + 1]; ++box) {
        if (!structure.isPlane(box)) next[i].partners.push_back(box);
      }
    }
  }
  planes_.swap(next);
  revision_ = structure.revision;
}

void PlanePairs::accept() {
  for (OfPlane& plane : planes_) {
    plane.before = plane.now;
    plane.was_placed = plane.is_placed;
  }
}

/// @param body  index of the body of the plane
PlanePairs::Meeting PlanePairs::meetingOf(const OfPlane& plane, std::uint32_t body, ProxyId box,
                                          const Snapshot& snapshot, const Horizon& horizon) {
  const Structure& structure = snapshot.structure();
  const std::uint32_t other = structure.body_of_proxy[box];
  Meeting result;
  result.gap = distance(plane.now, snapshot.boxes()[box]);
  result.margin =
      pairMargin(structure, body, stalenessOf(snapshot.poses()[body]), other, stalenessOf(snapshot.poses()[other]));
  result.near = result.gap <= result.margin;
  result.soon = false;
  if (result.near || !horizon.on()) return result;
  // A distance that went from `before` to the present gap while it changed by at most `way` was never less than half of
  // before + gap - way.
  const double before = distance(plane.was_placed ? plane.before : plane.now, horizon.before(box));
  const double way = horizon.wayOf(body) + horizon.wayOf(other);
  const double least = std::min({before, result.gap, 0.5 * (before + result.gap - way)});
  result.soon = result.gap <= horizon.reachOf(body) + horizon.reachOf(other) ||
                least <= result.margin + horizon.driftOf(body) + horizon.driftOf(other);
  return result;
}

/// Returns whether a plane and a box may be near enough to be reported. If this returns false, they are too far apart,
/// or the body of the box is unplaced.
/// @param body  index of the body of the plane; it must be placed
bool PlanePairs::isNearby(const OfPlane& plane, std::uint32_t body, ProxyId box, const Snapshot& snapshot,
                          const Horizon& horizon) {
  const std::uint32_t other = snapshot.structure().body_of_proxy[box];
  if (snapshot.poses()[other].state == Freshness::unplaced) return false;
  if (horizon.on()) return true;
  return distance(plane.now, snapshot.boxes()[box]) <= rangeOf(body, snapshot) + rangeOf(other, snapshot);
}

/// Brings OfPlane::near up to date.
void PlanePairs::listNear(OfPlane& plane, std::uint32_t body, const Snapshot& snapshot, const Horizon& horizon,
                          const std::vector<std::uint32_t>& changed) {
  const auto is_nearby = [&](ProxyId box) { return isNearby(plane, body, box, snapshot, horizon); };
  const bool known = plane.near_of && *plane.near_of == plane.now && !horizon.on();
  plane.near_of.reset();  // an exception must not leave a list that is taken for valid
  if (!known || changed.size() > plane.partners.size() / 4) {
    plane.near.clear();
    std::copy_if(plane.partners.begin(), plane.partners.end(), std::back_inserter(plane.near), is_nearby);
    plane.near_of = plane.now;
    return;
  }
  const Structure& structure = snapshot.structure();
  compared_.clear();
  for (const std::uint32_t other : changed) {
    const auto first = std::lower_bound(plane.partners.begin(), plane.partners.end(), structure.first_proxy[other]);
    const auto end = std::lower_bound(first, plane.partners.end(), structure.first_proxy[other + 1]);
    compared_.insert(compared_.end(), first, end);
  }
  std::sort(compared_.begin(), compared_.end());
  unchanged_.clear();
  std::set_difference(plane.near.begin(), plane.near.end(), compared_.begin(), compared_.end(),
                      std::back_inserter(unchanged_));
  compared_.erase(std::remove_if(compared_.begin(), compared_.end(), [&](ProxyId box) { return !is_nearby(box); }),
                  compared_.end());
  plane.near.clear();
  std::merge(unchanged_.begin(), unchanged_.end(), compared_.begin(), compared_.end(), std::back_inserter(plane.near));
  plane.near_of = plane.now;
}

bool PlanePairs::find(const Snapshot& snapshot, const Horizon& horizon, const std::vector<std::uint32_t>& changed,
                      std::size_t most, const Add& add) {
  const Structure& structure = snapshot.structure();
  if (revision_ != structure.revision) renumber(structure);
  const auto bodyOf = [&](std::size_t i) { return structure.body_of_proxy[structure.planes[i]]; };
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    OfPlane& plane = planes_[i];
    plane.is_placed = snapshot.poses()[bodyOf(i)].state != Freshness::unplaced;
    plane.now = snapshot.halfSpaces()[i];
    if (plane.is_placed) listNear(plane, bodyOf(i), snapshot, horizon, changed);
  }
  std::size_t left = most;
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    if (!planes_[i].is_placed) continue;
    const std::uint32_t body = bodyOf(i);
    for (const ProxyId box : planes_[i].near) {
      const Meeting meeting = meetingOf(planes_[i], body, box, snapshot, horizon);
      if (!meeting.near && !meeting.soon) continue;
      if (left == 0) return false;
      --left;
      const std::uint32_t other = structure.body_of_proxy[box];
      add(std::min(body, other), std::max(body, other), meeting.gap, meeting.margin, meeting.near);
    }
  }
  return true;
}

bool PlanePairs::isNear(const Snapshot& snapshot, const Horizon& horizon, std::uint32_t first,
                        std::uint32_t second) const {
  const Structure& structure = snapshot.structure();
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const std::uint32_t body = structure.body_of_proxy[structure.planes[i]];
    if (body != first && body != second) continue;
    const std::uint32_t other = body == first ? second : first;
    if (snapshot.poses()[body].state == Freshness::unplaced) continue;
    if (snapshot.poses()[other].state == Freshness::unplaced) continue;
    for (ProxyId box = structure.first_proxy[other]; box < structure.first_proxy[other + 1]; ++box) {
      if (structure.isPlane(box)) continue;
      const Meeting meeting = meetingOf(planes_[i], body, box, snapshot, horizon);
      if (meeting.near || meeting.soon) return true;
    }
  }
  return false;
}

}  // namespace hgrid
