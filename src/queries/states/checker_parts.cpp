// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/checker_parts.h"

#include <cmath>

#include "hgrid_proximity/queries/query.h"
#include "queries/question.h"

namespace hgrid {
namespace {

QueryScope scopeOf(const StateCheckerOptions& options) {
  QueryScope scope;
  scope.exclude = options.ignore;
  return scope;
}

/// Returns the body of the robot from which the pose of its root link follows: a link that is rigidly connected to the
/// root link. Structure::kNone if the snapshot has no pose of such a link.
std::uint32_t rootBodyOf(const Snapshot& snapshot, const RobotShapes& robot) {
  for (const RobotBody& own : robot.bodies()) {
    const bool is_link = snapshot.structure().bodies[own.body].kind == BodyKind::link;
    if (is_link && own.group == 0 && snapshot.poses()[own.body].state != Freshness::unplaced) return own.body;
  }
  return Structure::kNone;
}

/// Returns for each variable whether it turns freely.
std::vector<bool> wrapsOf(const Kinematics& kinematics) {
  std::vector<bool> wraps;
  for (const JointVariable& variable : kinematics.variables()) wraps.push_back(variable.turnsFreely());
  return wraps;
}

/// Checks the pose of a root link. @throws Refusal nonfinite, out_of_range, bad_rotation
void checkRoot(const Pose& world_from_root) {
  if (!world_from_root.matrix().allFinite()) {
    throw Refusal(Code::nonfinite, "the pose of the robot's root link is not finite; every number must be finite");
  }
  checkQueryPoint(world_from_root.translation(), "the position of the robot's root link");
  constexpr double kOrthonormal = 1e-6;
  const Eigen::Matrix3d turn = world_from_root.linear();
  if ((turn.transpose() * turn).isIdentity(kOrthonormal) && turn.determinant() > 0.0) return;
  throw Refusal(Code::bad_rotation,
                "the pose of the robot's root link has no rotation; its matrix must be orthonormal");
}

}  // namespace

CheckerParts::CheckerParts(std::shared_ptr<const Snapshot> asked, const Kinematics& joints, const std::string& name,
                           std::shared_ptr<const NarrowPhase> measures, const StateCheckerOptions& options)
    : snapshot(std::move(asked)),
      kinematics(joints),
      narrow_phase(std::move(measures)),
      joined(name.empty()),
      robot(*snapshot, joints, name, options, scopeOf(options)),
      world(*snapshot, robot, scopeOf(options)),
      root_body(joined ? Structure::kNone : rootBodyOf(*snapshot, robot)),
      doubts(*snapshot, robot, world, scopeOf(options), root_body),
      motion(kinematics, robot),
      wraps(wrapsOf(kinematics)) {
  for (std::size_t link = 0; joined && link < kinematics.links().size(); ++link) {
    if (kinematics.groupOfLink()[link] == 0) checkRoot(kinematics.groupFromLink()[link]);
  }
}

Pose CheckerParts::worldFromRoot(const StateBatch& batch) const {
  if (batch.world_from_root) {
    checkRoot(*batch.world_from_root);
    return *batch.world_from_root;
  }
  if (joined) return Pose::Identity();  // the root link is the world
  if (root_body == Structure::kNone) {
    throw Refusal(Code::not_ready, "the snapshot has no pose of the root link of robot '" +
                                       printable(kinematics.name()) + "'; give its pose with the states");
  }
  const std::uint32_t link = snapshot->structure().bodies[root_body].link;
  return snapshot->poses()[root_body].world_from_body * kinematics.groupFromLink()[link].inverse();
}

}  // namespace hgrid
