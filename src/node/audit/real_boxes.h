// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "node/audit/audit_case.h"

namespace hgrid {

/// The boxes of one body, computed in double precision and apart from the folder geometry, which the audit checks.
struct RealBoxes {
  std::vector<Eigen::AlignedBox3d> shapes;  // [m, world] tight box of each shape with its padding
  Eigen::AlignedBox3d all;                  // box around all of them; empty if there is none

  /// Returns the least distance [m] of the boxes of two bodies; infinite if one has none.
  double gapTo(const RealBoxes& other) const;
  /// Returns the least distance [m] from a point; infinite if there is no box.
  double distanceTo(const Eigen::Vector3d& point) const;
  /// Returns the least distance [m] from a line segment.
  double distanceTo(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
};

/// Computes the boxes of a body at a pose.
RealBoxes realBoxesOf(const Body& body, const Pose& world_from_body);

/// Returns the least distance [m] from a point [m, frame of the map] to the cells; infinite if there are none.
double distanceTo(const RecordedCells& cells, const Eigen::Vector3d& point);

/// [m] Twice the largest difference of two positions that an audit takes for equal.
inline constexpr double kPoseSlack = 2e-6;

/// Returns how much [m] the distances of these boxes may differ from those that the node computed. It covers
/// kPoseSlack, and the rounding of the node's boxes to single precision.
double roundingOf(const AuditCase& audited, const RealBoxes& boxes);

}  // namespace hgrid
