// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "node/audit/audit_case.h"

namespace hgrid {

/// The boxes of one body in double precision. They are computed without code of the folder geometry, which the audit
/// checks.
struct RealBoxes {
  std::vector<Eigen::AlignedBox3d> shapes;  // [m, world frame] for each shape: its AABB, padding included
  Eigen::AlignedBox3d all;                  // box around all boxes in `shapes`; empty if there are none
  /// The surfaces of its planes, padding included. A plane has no box in `shapes`.
  std::vector<Eigen::Hyperplane<double, 3, Eigen::DontAlign>> planes;

  /// Whether the body has neither boxes nor planes, as maps and clouds.
  bool empty() const { return shapes.empty() && planes.empty(); }

  /// Returns the least distance [m] of the boxes of two bodies, or of a plane of one and a box of the other; infinite
  /// if there are none.
  double gapTo(const RealBoxes& other) const;
  /// Returns the least distance [m] of the boxes and planes from a point; infinite if there are none.
  double distanceTo(const Eigen::Vector3d& point) const;
  /// Returns the least distance [m] of the boxes and planes from a line segment; infinite if there are none.
  double distanceTo(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

/// Computes the boxes of a body at a pose.
RealBoxes realBoxesOf(const Body& body, const Pose& world_from_body);

/// Returns the least distance [m] of the cells from a point; infinite if there are no cells.
/// @param point  [m, frame of the map or cloud]
double distanceTo(const RecordedCells& cells, const Eigen::Vector3d& point);

/// [m] Twice the largest error of a position that an audit accepts. Distances of two bodies may differ by this.
inline constexpr double kPoseSlack = 2e-6;

/// Returns the largest error [m] that an audit accepts in a distance that the node computed for these boxes. It
/// includes kPoseSlack, and the rounding of the node's boxes to single precision.
double roundingOf(const AuditCase& audited, const RealBoxes& boxes);

}  // namespace hgrid
