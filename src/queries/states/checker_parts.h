// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/state_checker.h"
#include "queries/states/motion_bounds.h"
#include "queries/states/state_doubts.h"

namespace hgrid {

/// What a StateChecker prepares once for all questions. Immutable.
struct CheckerParts {
  CheckerParts(std::shared_ptr<const Snapshot> asked, const Kinematics& joints, const std::string& name,
               std::shared_ptr<const NarrowPhase> measures, const StateCheckerOptions& options);

  CheckerParts(const CheckerParts&) = delete;  // the parts refer to each other
  CheckerParts& operator=(const CheckerParts&) = delete;

  /// Returns the pose of the root link for a batch. @throws Refusal not_ready, nonfinite, out_of_range, bad_rotation
  Pose worldFromRoot(const StateBatch& batch) const;

  const std::shared_ptr<const Snapshot> snapshot;
  const Kinematics kinematics;
  const std::shared_ptr<const NarrowPhase> narrow_phase;
  const bool joined;  ///< whether the kinematics are those of joinRobots()
  const RobotShapes robot;
  const WorldShapes world;
  const std::uint32_t root_body;  ///< index of the body from which the pose of the root link follows, or kNone
  const StateDoubts doubts;
  const MotionBounds motion;
  const std::vector<bool> wraps;  ///< for each variable: whether an edge takes the shorter way around the circle
};

}  // namespace hgrid
