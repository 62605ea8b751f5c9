// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/world_shapes.h"

#include <numeric>

#include "geometry/rounding.h"

namespace hgrid {

WorldShapes::WorldShapes(const Snapshot& snapshot, const RobotShapes& robot, const QueryScope& scope) {
  const Structure& structure = snapshot.structure();
  for (std::uint32_t body = 0; body < structure.bodies.size(); ++body) {
    const BodyPose& pose = snapshot.poses()[body];
    if (robot.moves(body) || structure.isMap(body) || pose.state == Freshness::unplaced) continue;
    if (!inScope(snapshot, scope, body)) continue;
    const std::vector<BodyShape>& shapes = structure.bodies[body].shapes;
    for (std::uint32_t i = 0; i < shapes.size(); ++i) {
      const std::uint32_t proxy = structure.first_proxy[body] + i;
      if (structure.isPlane(proxy)) continue;
      Pose local_from_shape = pose.world_from_body * shapes[i].body_from_shape;
      local_from_shape.translation() -= snapshot.origin();
      addSpheres(shapes[i], local_from_shape);
      shapes_.push_back({body, i, tiltedBoxOf(shapes[i], local_from_shape, kFloatRounding),
                         static_cast<std::uint32_t>(spheres_.size())});
      bounds_.push_back(snapshot.boxes()[proxy]);
    }
  }
  if (!isSmall()) {
    std::vector<ProxyId> ids(shapes_.size());
    std::iota(ids.begin(), ids.end(), 0u);
    grid_ = HGrid(GridScale::fitting(bounds_));
    grid_.setFixed(ids);
    grid_.update(ids, bounds_);
  }
  forEachMap(snapshot, scope, [&](const PlacedMap& map) {
    maps_.push_back(map);
    clearances_.emplace_back(map, snapshot.origin());
  });
  forEachPlane(snapshot, scope, [&](const PlacedPlane& plane) { planes_.push_back(plane); });
}

void WorldShapes::addSpheres(const BodyShape& shape, const Pose& local_from_shape) {
  for (const Sphere& sphere : spheresInside(shape, local_from_shape)) {
    spheres_.push_back(smallSphere(sphere.center, sphere.radius));
  }
}

}  // namespace hgrid
