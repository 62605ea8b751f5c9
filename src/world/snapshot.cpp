// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/world/snapshot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "maps/map_gap.h"
#include "world/pair_margin.h"

namespace hgrid {

void Snapshot::fillHalfSpaces() {
  half_spaces_.clear();
  for (const std::uint32_t plane : structure_->planes) {
    const std::uint32_t body = structure_->body_of_proxy[plane];
    const Body& of_plane = structure_->bodies[body];
    const BodyShape& shape = of_plane.shapes[structure_->shapeOf(plane)];
    half_spaces_.push_back(
        hgrid::halfSpaceOf(poses_[body].world_from_body * shape.body_from_shape, shape.padding, origin_));
  }
}

void Snapshot::clearSummary() {
  watched_.clear();
  worst_state_ = Freshness::fresh;
  max_age_ = max_growth_ = max_reach_ = 0.0;
}

void Snapshot::addToSummary(std::uint32_t body) {
  const BodyPose& pose = poses_[body];
  if (pose.state == Freshness::fresh && pose.age == 0.0 && pose.reach == 0.0) return;
  watched_.push_back(body);
  worst_state_ = std::max(worst_state_, pose.state);
  max_growth_ = std::max(max_growth_, pose.growth);
  max_reach_ = std::max(max_reach_, pose.reach);
  if (pose.state != Freshness::unplaced) max_age_ = std::max(max_age_, pose.age);
}

std::shared_ptr<const MapCells> Snapshot::cellsOf(std::uint32_t body) const {
  const std::vector<std::uint32_t>& maps = structure_->maps;
  const auto found = std::lower_bound(maps.begin(), maps.end(), body);
  return found != maps.end() && *found == body ? cells_[static_cast<std::size_t>(found - maps.begin())] : nullptr;
}

const HalfSpace& Snapshot::halfSpaceOf(std::uint32_t plane) const {
  const std::vector<std::uint32_t>& planes = structure_->planes;
  const auto found = std::lower_bound(planes.begin(), planes.end(), plane);
  return half_spaces_[static_cast<std::size_t>(found - planes.begin())];
}

double Snapshot::gapOfProxies(std::uint32_t first, std::uint32_t second) const {
  const bool plane_first = structure_->isPlane(first), plane_second = structure_->isPlane(second);
  if (plane_first && plane_second) return std::numeric_limits<double>::infinity();
  if (plane_first) return distance(halfSpaceOf(first), boxes_[second]);
  if (plane_second) return distance(halfSpaceOf(second), boxes_[first]);
  return distance(boxes_[first], boxes_[second]);
}

bool Snapshot::areWithin(std::uint32_t first, std::uint32_t second, double margin) const {
  if (structure_->isPlane(first) || structure_->isPlane(second)) return gapOfProxies(first, second) <= margin;
  return withinDistance(boxes_[first], boxes_[second], margin);
}

double Snapshot::gapOf(std::uint32_t first, std::uint32_t second, double up_to) const {
  double gap = std::numeric_limits<double>::infinity();
  for (const std::uint32_t body : {first, second}) {
    if (poses_[body].state == Freshness::unplaced) return gap;
  }
  if (structure_->isMap(first)) std::swap(first, second);
  const auto cells = cellsOf(second);
  const Pose map_from_world = poses_[second].world_from_body.inverse();
  for (ProxyId a = structure_->first_proxy[first]; a < structure_->first_proxy[first + 1]; ++a) {
    if (cells && !structure_->isPlane(a)) {
      gap = std::min(gap, gapTo(*cells->grid, boxInMap(map_from_world, boxes_[a], origin_), std::min(gap, up_to)));
    }
    for (ProxyId b = structure_->first_proxy[second]; b < structure_->first_proxy[second + 1]; ++b) {
      gap = std::min(gap, gapOfProxies(a, b));
    }
  }
  return gap <= up_to ? gap : std::numeric_limits<double>::infinity();
}

double Snapshot::marginOf(std::uint32_t first, std::uint32_t second) const {
  return configuredMargin(*structure_, first, second);
}

double Snapshot::growthOf(std::uint32_t first, std::uint32_t second) const {
  return widening(*structure_, first, stalenessOf(poses_[first]), second, stalenessOf(poses_[second]));
}

double Snapshot::reachBetween(std::uint32_t first, std::uint32_t second) const {
  const BodyPose &a = poses_[first], &b = poses_[second];
  const bool rigid = structure_->bodies[first].rigid_group == structure_->bodies[second].rigid_group;
  if (rigid && movedTogether(*structure_, first, a.cohort, second, b.cohort)) return 0.0;
  return a.reach + b.reach;
}

bool Snapshot::hasGap(const std::string& body) const {
  return std::any_of(gaps_.begin(), gaps_.end(), [&](const SourceGap& gap) { return gap.bodies == body; });
}

NoContact Snapshot::noContactBefore(std::uint32_t first, std::uint32_t second, double distance) const {
  NoContact result;
  double speed = 0.0, left = distance;
  for (const std::uint32_t i : {first, second}) {
    const Body& body = structure_->bodies[i];
    if (body.mobility == Mobility::fixed) continue;
    const bool is_bounded = std::isfinite(body.speed_bound);
    const double limit = is_bounded ? body.speed_bound : body.max_speed;
    if (!std::isfinite(limit)) return {};
    result.assumed = result.assumed || !is_bounded;
    speed += limit;
    left -= limit * std::abs(seconds(stamp_ - poses_[i].stamp));
  }
  const double infinity = std::numeric_limits<double>::infinity();
  result.before = left <= 0.0 ? 0.0 : speed > 0.0 ? left / speed : infinity;
  return result;
}

}  // namespace hgrid
