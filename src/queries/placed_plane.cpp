// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/placed_plane.h"

namespace hgrid {

QueryHit PlacedPlane::hitOf(const Eigen::Vector3d& point, const Eigen::Vector3d& origin, bool exact) const {
  const double distance = signedDistanceOf(point);
  QueryHit hit;
  hit.body = body;
  hit.shape = shape;
  hit.center_distance = hit.distance = std::max(0.0, distance);
  hit.point = origin + point - (exact ? distance : hit.distance) * half_space.normal;
  if (!exact) return hit;
  hit.status = distance > 0.0 ? Measure::apart : Measure::contact;
  hit.normal = half_space.normal;
  return hit;
}

}  // namespace hgrid
