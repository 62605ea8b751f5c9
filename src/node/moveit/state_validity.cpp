// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/state_validity.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "node/messages/to_messages.h"
#include "node/moveit/asked_state.h"
#include "node/states/robot_choice.h"

namespace hgrid {
namespace {

using moveit::ContactInformation;
using moveit::GetStateValidity;

void checkConstraints(const moveit::Constraints& constraints) {
  const char* part = !constraints.position_constraints.empty()      ? "position_constraints"
                     : !constraints.orientation_constraints.empty() ? "orientation_constraints"
                     : !constraints.visibility_constraints.empty()  ? "visibility_constraints"
                                                                    : nullptr;
  if (part == nullptr) return;
  throw Refusal(Code::unsupported,
                std::string("the request has ") + part + "; the node evaluates joint_constraints only");
}

/// Evaluates a constraint as MoveIt does: the distance is weighted, and angles of continuous joints are compared modulo
/// a full turn.
moveit::ConstraintEvalResult evaluate(const moveit::JointConstraint& constraint, const AskedState& asked) {
  const Kinematics& kinematics = *asked.robot.read->joints->kinematics;
  const int variable = kinematics.find(jointOf(constraint.joint_name, asked.robot.name));
  if (variable < 0) {
    throw Refusal(Code::unknown_id, "the joint constraint names '" + printable(constraint.joint_name) +
                                        "', which is no joint value of robot '" + asked.robot.name + "'");
  }
  const JointVariable& joint = kinematics.variables()[static_cast<std::size_t>(variable)];
  double apart = asked.batch.positions[static_cast<std::size_t>(variable)] - constraint.position;
  if (joint.is_angle && std::isinf(joint.lower)) apart = std::remainder(apart, 2.0 * M_PI);
  constexpr double kSlack = 2.0 * std::numeric_limits<float>::epsilon();
  moveit::ConstraintEvalResult result;
  result.result = apart <= constraint.tolerance_above + kSlack && apart >= -constraint.tolerance_below - kSlack;
  result.distance = constraint.weight * std::abs(apart);
  return result;
}

/// Returns the name that MoveIt has for a body, and what kind of body it is.
std::pair<std::string, std::uint32_t> moveitBody(const Structure& structure, std::uint32_t index, bool is_carried) {
  const Body& body = structure.bodies[index];
  const std::string local = body.name.substr(body.name.find('/') + 1);
  if (body.kind == BodyKind::map || body.kind == BodyKind::cloud) {
    return {"<octomap>", ContactInformation::WORLD_OBJECT};
  }
  if (body.kind != BodyKind::link) {
    return {local, is_carried ? ContactInformation::ROBOT_ATTACHED : ContactInformation::WORLD_OBJECT};
  }
  const bool is_shared = std::any_of(structure.bodies.begin(), structure.bodies.end(), [&](const Body& other) {
    return other.kind == BodyKind::link && other.robot != body.robot &&
           other.name.compare(other.name.find('/') + 1, std::string::npos, local) == 0;
  });
  return {is_shared ? body.name : local, ContactInformation::ROBOT_LINK};
}

ContactInformation contactOf(const StatePair& pair, const Snapshot& snapshot, const Tick& tick) {
  ContactInformation contact;
  contact.header.frame_id = tick.world_frame;
  contact.header.stamp = toRos(snapshot.stamp());
  std::tie(contact.contact_body_1, contact.body_type_1) = moveitBody(snapshot.structure(), pair.first, true);
  std::tie(contact.contact_body_2, contact.body_type_2) =
      moveitBody(snapshot.structure(), pair.second, snapshot.structure().isCarried(pair.second));
  const Proximity& found = pair.proximity;
  if (found.on_first.allFinite() && found.on_second.allFinite()) {
    contact.position = toPoint(0.5 * (found.on_first + found.on_second));
  }
  if (found.normal.allFinite()) contact.normal = toVector(found.normal);
  if (std::isfinite(found.depth)) contact.depth = found.depth;
  return contact;
}

}  // namespace

StateValidity stateValidity(const GetStateValidity::Request& request, const AnswerTick& tick,
                            const TransformLookup& transforms, std::shared_ptr<const NarrowPhase> narrow_phase) {
  checkConstraints(request.constraints);
  const Snapshot& snapshot = tick.snapshot();  // throws while there is no world
  const AskedState asked = askedState(request.robot_state, request.group_name, *tick.get(), transforms);
  const RobotJoints& joints = *asked.robot.read->joints;
  StateCheckerOptions options;
  if (!request.group_name.empty()) {
    const auto group = variablesOf(request.group_name, joints.groups, asked.robot.read->model);
    if (group) options.group = *group;
  }
  if (joints.kinematics->variables().empty()) {
    throw Refusal(Code::unsupported, "robot '" + asked.robot.name + "' has no joint that can move");
  }
  StateValidity result;
  bool satisfied = true;
  for (const moveit::JointConstraint& constraint : request.constraints.joint_constraints) {
    result.response.constraint_result.push_back(evaluate(constraint, asked));
    satisfied = satisfied && result.response.constraint_result.back().result;
  }
  const StateChecker checker(tick.get()->snapshot, *joints.kinematics, asked.robot.name, std::move(narrow_phase),
                             options);
  StateRequest all;
  all.all_pairs = true;
  StateScratch scratch;
  StateAnswers answers;
  checker.checkStates(asked.batch, all, scratch, answers);
  for (const StatePair& pair : answers.pairs) {
    result.response.contacts.push_back(contactOf(pair, snapshot, *tick.get()));
  }
  const StateAnswer& answer = answers.states.at(0);
  const double valid_for = tick.get()->settings->params.valid_for;
  if (answer.refused != Code::ok) throw Refusal(answer.refused, checker.sentenceOf(asked.batch, answers, 0));
  if (answer.verdict == Verdict::unknown) {
    result.unknown = checker.sentenceOf(asked.batch, answers, 0);
  } else if (answer.verdict == Verdict::clear && tick.age() > valid_for) {
    result.unknown = "the newest tick is " + secondsText(tick.age()) + " old; ticks are valid for " + text(valid_for) +
                     " s (~valid_for)";
  }
  result.response.valid = satisfied && answer.verdict == Verdict::clear && result.unknown.empty();
  return result;
}

}  // namespace hgrid
