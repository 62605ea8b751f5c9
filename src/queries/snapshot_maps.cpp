// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// What queries say of maps and clouds: one hit for each, told of the cell that is nearest or met first.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "maps/map_gap.h"
#include "queries/placed_map.h"
#include "queries/probe.h"

namespace hgrid {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The hit of a question whose middle is `distance` from a voxel.
/// @param from  the middle, in the map's frame
QueryHit hitOf(const PlacedMap& map, const Voxel& voxel, const Eigen::Vector3d& from, double distance, bool exact) {
  QueryHit hit;
  hit.body = map.body;
  hit.cell_edge = map.edgeOf(voxel);
  hit.center_distance = hit.distance = distance;
  const Eigen::Vector3d point = map.nearestOf(voxel, from);
  hit.point = map.world_from_map * point;
  if (!exact) return hit;
  hit.status = distance > 0.0 ? Measure::apart : Measure::contact;
  if (distance > 0.0) hit.normal = map.world_from_map.linear() * (from - point).normalized();
  return hit;
}

/// The outward normal of the side of a cube by which a way along `way` enters it at `at`.
Eigen::Vector3d sideEntered(const Eigen::AlignedBox3d& cube, const Eigen::Vector3d& at, const Eigen::Vector3d& way) {
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(Proximity::kUnknown);
  double nearest = 1e-6 * cube.sizes().maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    if (way[axis] == 0.0) continue;
    const double off = std::abs(at[axis] - (way[axis] > 0.0 ? cube.min()[axis] : cube.max()[axis]));
    if (off > nearest) continue;
    nearest = off;
    normal = Eigen::Vector3d::Unit(axis) * (way[axis] > 0.0 ? -1.0 : 1.0);
  }
  return normal;
}

}  // namespace

std::shared_ptr<const MapCells> Snapshot::cellsOf(std::uint32_t body) const {
  const std::vector<std::uint32_t>& maps = structure_->maps;
  const auto found = std::lower_bound(maps.begin(), maps.end(), body);
  return found != maps.end() && *found == body ? cells_[static_cast<std::size_t>(found - maps.begin())] : nullptr;
}

double Snapshot::gapOf(std::uint32_t first, std::uint32_t second, double up_to) const {
  double gap = kInfinity;
  for (const std::uint32_t body : {first, second}) {
    if (poses_[body].state == Freshness::unplaced) return gap;
  }
  if (structure_->isMap(first)) std::swap(first, second);
  const auto cells = cellsOf(second);
  const Pose map_from_world = poses_[second].world_from_body.inverse();
  for (ProxyId a = structure_->first_proxy[first]; a < structure_->first_proxy[first + 1]; ++a) {
    if (cells) {
      gap = std::min(gap, gapTo(*cells->grid, boxInMap(map_from_world, boxes_[a], origin_), std::min(gap, up_to)));
    }
    for (ProxyId b = structure_->first_proxy[second]; b < structure_->first_proxy[second + 1]; ++b) {
      gap = std::min(gap, distance(boxes_[a], boxes_[b]));
    }
  }
  return gap <= up_to ? gap : kInfinity;
}

void Snapshot::addMaps(const Sphere& sphere, const QueryScope& scope, std::vector<QueryHit>& hits) const {
  const double radius = sphere.radius + touchSlack(sphere.center, sphere.radius);
  const std::size_t before = hits.size();
  addMapsNear(sphere.center, radius, scope, hits);
  for (std::size_t i = before; i < hits.size(); ++i) {
    hits[i].distance = std::max(0.0, hits[i].center_distance - sphere.radius);
  }
}

void Snapshot::addMapsNear(const Eigen::Vector3d& point, double limit, const QueryScope& scope,
                           std::vector<QueryHit>& hits) const {
  std::vector<NearVoxel> near;
  forEachMap(scope, [&](const PlacedMap& map) {
    const Eigen::Vector3d at = map.map_from_world * point;
    map.cells.grid->nearest(Eigen::AlignedBox3d(at), 1, limit, near);
    if (near.empty()) return;
    hits.push_back(hitOf(map, near.front().voxel, at, near.front().distance, scope.exact != nullptr));
  });
}

void Snapshot::addMaps(const Segment& segment, const QueryScope& scope, std::vector<QueryHit>& hits) const {
  const double length = (segment.to - segment.from).norm();
  forEachMap(scope, [&](const PlacedMap& map) {
    const Segment in_map{map.map_from_world * segment.from, map.map_from_world * segment.to, segment.radius};
    const auto first = map.cells.grid->firstAlong(in_map);
    if (!first) return;
    const Eigen::Vector3d way = in_map.to - in_map.from;
    const Eigen::Vector3d at = in_map.from + (length > 0.0 ? first->along / length : 0.0) * way;
    const double away = (map.nearestOf(first->voxel, at) - at).norm();
    const bool exact = scope.exact != nullptr;
    QueryHit hit = hitOf(map, first->voxel, at, away, exact);
    hit.along = first->along;
    hit.distance = std::max(0.0, away - segment.radius);
    if (exact && (segment.radius == 0.0 || hit.normal.hasNaN())) {
      hit.normal = map.world_from_map.linear() * sideEntered(map.cubeOf(first->voxel), at, way);
    }
    hits.push_back(hit);
  });
}

/// Cells are tried as they are near to the box's centre: the first that the box touches is the one that is told of.
void Snapshot::addMaps(const QueryBox& box, const NarrowPhase& narrow_phase, const QueryScope& scope,
                       std::vector<QueryHit>& hits) const {
  const Eigen::Vector3d center = box.world_from_box.translation();
  const double slack = touchSlack(center, box.size.norm());
  const auto core = narrow_phase.block(box.size);
  forEachMap(scope, [&](const PlacedMap& map) {
    const Eigen::Vector3d middle = map.map_from_world * center;
    std::optional<NearVoxel> met;
    const double half_diagonal = 0.5 * box.size.norm() + slack;
    map.cells.grid->visitNear(Eigen::AlignedBox3d(middle), half_diagonal, [&](const Voxel& voxel, double distance) {
      const Pose world_from_cube = map.worldFromCube(voxel);
      const Proximity found = narrow_phase.measure({*core, box.world_from_box, 0.0},
                                                   {*map.cells.cubes[voxel.level], world_from_cube, 0.0}, slack);
      if (found.distance <= slack && (!met || distance < met->distance)) met = NearVoxel{voxel, distance};
      return !met ? half_diagonal : met->distance > 0.0 ? met->distance : kNoFurther;
    });
    if (!met) return;
    QueryHit hit = hitOf(map, met->voxel, middle, met->distance, scope.exact != nullptr);
    hit.distance = 0.0;
    if (scope.exact != nullptr) hit.status = Measure::contact;
    hits.push_back(hit);
  });
}

void Snapshot::addMapsNear(std::uint32_t from, double limit, const QueryScope& scope,
                           std::vector<QueryHit>& hits) const {
  const Body& asking = structure_->bodies[from];
  forEachMap(scope, [&](const PlacedMap& map) {
    QueryHit best;
    best.distance = kInfinity;
    for (std::uint32_t i = 0; i < asking.shapes.size(); ++i) {
      const BodyShape& shape = asking.shapes[i];
      const Pose world_from_shape = poses_[from].world_from_body * shape.body_from_shape;
      const Eigen::AlignedBox3d own = boxInMap(map.map_from_world, boxes_[structure_->first_proxy[from] + i], origin_);
      const auto most = [&] { return best.distance > 0.0 ? std::min(limit, best.distance) : kNoFurther; };
      if (most() < 0.0) break;
      map.cells.grid->visitNear(own, most(), [&](const Voxel& voxel, double gap) {
        Proximity found;
        if (scope.exact != nullptr && shape.solid) {
          const Pose world_from_cube = map.worldFromCube(voxel);
          found = scope.exact->measure({*shape.solid, world_from_shape, shape.padding},
                                       {*map.cells.cubes[voxel.level], world_from_cube, 0.0}, most());
        } else {
          const Eigen::AlignedBox3d cube = map.cubeOf(voxel);
          const Eigen::Vector3d low = own.min().cwiseMax(cube.min()), high = own.max().cwiseMin(cube.max());
          for (int axis = 0; axis < 3; ++axis) {  // nearest points of two boxes; in the middle of what they share
            const bool apart = low[axis] > high[axis], own_first = own.max()[axis] < cube.min()[axis];
            found.on_first[axis] = !apart ? 0.5 * (low[axis] + high[axis]) : own_first ? high[axis] : low[axis];
            found.on_second[axis] = !apart ? 0.5 * (low[axis] + high[axis]) : own_first ? low[axis] : high[axis];
          }
          found.on_first = map.world_from_map * found.on_first;
          found.on_second = map.world_from_map * found.on_second;
          found.distance = gap;
        }
        if (found.distance < best.distance) {
          best.body = map.body;
          best.cell_edge = map.edgeOf(voxel);
          best.distance = best.center_distance = found.distance;
          best.status = found.status;
          best.own_point = found.on_first;
          best.point = found.on_second;
          best.normal = -found.normal;
        }
        return most();
      });
    }
    if (best.distance <= limit) hits.push_back(best);
  });
}

}  // namespace hgrid
