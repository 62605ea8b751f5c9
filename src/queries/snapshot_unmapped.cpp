// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Whether what a query asks about is known to be free by a map: what several know only together counts as unknown.
#include "maps/map_gap.h"
#include "queries/placed_map.h"
#include "queries/probe.h"

namespace hgrid {
namespace {

bool contains(const Eigen::AlignedBox3d& extent, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return (extent.min().array() <= low.array()).all() && (high.array() <= extent.max().array()).all();
}
bool contains(const Eigen::AlignedBox3d& extent, const Sphere& ball) {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(ball.radius);
  return contains(extent, ball.center - reach, ball.center + reach);
}

}  // namespace

/// Whether none of the maps asked about `knows(map, unmapped)`. A query that leaves out all maps does not ask this.
template <class Knows>
bool Snapshot::knownToNone(const QueryScope& scope, const Knows& knows) const {
  if (!report_unmapped_) return false;
  bool asks = false, has_maps = false;
  for (const std::uint32_t map : structure_->maps) {
    if (isCloud(structure_->bodies[map])) continue;
    has_maps = true;
    asks = asks || inScope(scope, map);
  }
  if (has_maps ? !asks : !scope.include.empty()) return false;
  bool known = false;
  forEachMap(scope, [&](const PlacedMap& map) {
    if (!known && map.cells.unmapped) known = knows(map, *map.cells.unmapped);
  });
  return !known;
}

bool Snapshot::unmapped(const Sphere& sphere, const QueryScope& scope) const {
  return knownToNone(scope, [&](const PlacedMap& map, const UnmappedSpace& space) {
    const double radius = sphere.radius + map.reach + touchSlack(sphere.center, sphere.radius);
    const Sphere ball{map.map_from_world * sphere.center, radius};
    return contains(space.extent, ball) && !space.cells.touches(ball);
  });
}

bool Snapshot::unmapped(const Segment& segment, const QueryScope& scope) const {
  return knownToNone(scope, [&](const PlacedMap& map, const UnmappedSpace& space) {
    const double radius = segment.radius + map.reach + touchSlack(segment.from, segment.radius);
    const Segment capsule{map.map_from_world * segment.from, map.map_from_world * segment.to, radius};
    return contains(space.extent, Sphere{capsule.from, radius}) && contains(space.extent, Sphere{capsule.to, radius}) &&
           !space.cells.firstAlong(capsule);
  });
}

bool Snapshot::unmapped(const QueryBox& box, const NarrowPhase& narrow_phase, const QueryScope& scope) const {
  const auto core = narrow_phase.block(box.size);
  return knownToNone(scope, [&](const PlacedMap& map, const UnmappedSpace& space) {
    const Eigen::Vector3d center = box.world_from_box.translation(), middle = map.map_from_world * center;
    const double within = map.reach + touchSlack(center, box.size.norm());
    const Pose map_from_box = map.map_from_world * box.world_from_box;
    const Eigen::Vector3d reach =
        (map_from_box.linear().cwiseAbs() * (0.5 * box.size)).array() + within;  // of the box around it
    if (!contains(space.extent, middle - reach, middle + reach)) return false;
    bool met = false;
    const double half_diagonal = 0.5 * box.size.norm() + within;
    space.cells.visitNear(Eigen::AlignedBox3d(middle), half_diagonal, [&](const Voxel& voxel, double) {
      const Pose world_from_cube = map.worldFromCube(voxel);
      const Proximity found = narrow_phase.measure({*core, box.world_from_box, 0.0},
                                                   {*map.cells.cubes[voxel.level], world_from_cube, 0.0}, within);
      met = met || found.distance <= within;
      return met ? kNoFurther : half_diagonal;
    });
    return !met;
  });
}

bool Snapshot::unmappedNear(const Eigen::Vector3d& point, double limit, const QueryScope& scope) const {
  return unmapped(Sphere{point, limit}, scope);
}

bool Snapshot::unmappedNear(std::uint32_t body, double limit, const QueryScope& scope) const {
  return knownToNone(scope, [&](const PlacedMap& map, const UnmappedSpace& space) {
    std::vector<NearVoxel> near;
    for (ProxyId proxy = structure_->first_proxy[body]; proxy < structure_->first_proxy[body + 1]; ++proxy) {
      const Eigen::AlignedBox3d own = boxInMap(map.map_from_world, boxes_[proxy], origin_);
      const double within = limit + map.reach + poses_[body].reach + touchSlack(own.center(), limit);
      const Eigen::Vector3d reach = Eigen::Vector3d::Constant(within);
      if (!contains(space.extent, own.min() - reach, own.max() + reach)) return false;
      space.cells.nearest(own, 1, within, near);
      if (!near.empty()) return false;
    }
    return true;
  });
}

}  // namespace hgrid
