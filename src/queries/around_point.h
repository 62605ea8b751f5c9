// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "queries/question.h"

namespace hgrid {

/// A question about the bodies around a point. Its region is a sphere.
class AroundPoint : public Question {
 public:
  AroundPoint(const Snapshot& asked, const QueryScope& given, const Sphere& region)
      : Question(asked, given),
        region_(region),
        local_{region.center - origin(), region.radius},
        radius_(region.radius + touchSlack(region.center, region.radius)) {}

  bool isBoxWithin(ProxyId proxy, double distance) const final {
    return touches({local_.center, local_.radius + distance}, boxOf(proxy));
  }
  bool isShapeWithin(ProxyId proxy, double distance, const NarrowPhase& exact) const final {
    return isWithin(center(exact).measure(snapshot, proxy, radius_ + distance), radius_ + distance);
  }
  bool isCellWithin(const PlacedMap& map, double distance) const final {
    std::vector<NearVoxel> near;
    map.cells.grid->nearest(Eigen::AlignedBox3d(map.map_from_world * region_.center), 1, radius_ + distance, near);
    return !near.empty();
  }
  bool isTouchedBy(const Sphere& sphere) const final {
    return (sphere.center - region_.center).norm() <= radius_ + sphere.radius;
  }
  bool isFreeIn(const PlacedMap& map, const UnmappedSpace& unmapped) const final {
    const double radius = region_.radius + map.reach + touchSlack(region_.center, region_.radius);
    const Sphere in_map{map.map_from_world * region_.center, radius};
    return unmapped.extent.contains(grown(Eigen::AlignedBox3d(in_map.center), radius)) &&
           !unmapped.cells.touches(in_map);
  }

 protected:
  /// Returns a probe that measures the center of the sphere against shapes.
  Probe center(const NarrowPhase& narrow_phase) const {
    return {narrow_phase, *narrow_phase.point(), Pose(Eigen::Translation3d(region_.center))};
  }
  // The functions below set the distances of a hit: those of the surface of a sphere of `radius` [m] around the center.

  /// Returns whether a cell is at most `limit` [m] from the center. If so, sets `hit` to the nearest cell.
  bool hitsNearestCell(const PlacedMap& map, double limit, double radius, QueryHit& hit) const {
    const Eigen::Vector3d in_map = map.map_from_world * region_.center;
    std::vector<NearVoxel> near;
    map.cells.grid->nearest(Eigen::AlignedBox3d(in_map), 1, limit, near);
    if (near.empty()) return false;
    const Voxel& voxel = near.front().voxel;
    hit = map.hitOf(voxel, in_map, near.front().distance, isExact());
    setDistance(hit, signedDistance(map.cubeOf(voxel), Eigen::AlignedBox3d(in_map), hit.center_distance) - radius);
    return true;
  }
  /// Returns whether a plane is at most `limit` [m] from the center. If so, sets `hit`.
  bool hitsNearPlane(const PlacedPlane& plane, double limit, double radius, QueryHit& hit) const {
    const double distance = plane.signedDistanceOf(local_.center);
    if (!(distance <= limit)) return false;
    hit = plane.hitOf(local_.center, origin(), isExact());
    setDistance(hit, distance - radius);
    return true;
  }
  /// Sets the distances and the nearest point of `hit` from the box of a proxy.
  void measureBox(ProxyId proxy, double radius, QueryHit& hit) const {
    const Eigen::AlignedBox3d box = inDouble(boxOf(proxy)), point(local_.center);
    hit.center_distance = distance(boxOf(proxy), local_.center);
    hit.point = nearestPoint(box, local_.center) + origin();
    setDistance(hit, signedDistance(box, point, hit.center_distance) - radius);
  }
  /// Copies a measurement from the center of the region into `hit`.
  static void take(const Proximity& from_center, double radius, QueryHit& hit) {
    describe(hit, from_center);
    hit.center_distance = from_center.distance;
    setDistance(hit, signedDistanceOf(from_center) - radius);
  }

  const Sphere region_;  // in the world frame
  const Sphere local_;   // the same sphere, relative to the origin of the snapshot
  const double radius_;  // [m] radius of the region, enlarged by the rounding error
};

}  // namespace hgrid
