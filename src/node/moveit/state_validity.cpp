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

void checkConstraints(const moveit::Constraints& constraints, const Params& params) {
  const char* part = !constraints.position_constraints.empty()      ? "position_constraints"
                     : !constraints.orientation_constraints.empty() ? "orientation_constraints"
                     : !constraints.visibility_constraints.empty()  ? "visibility_constraints"
                                                                    : nullptr;
  if (part != nullptr) {
    throw Refusal(Code::unsupported,
                  std::string("the request has ") + part + "; the node evaluates joint_constraints only");
  }
  const auto most = 8 * static_cast<std::size_t>(params.max_links);  // a joint has up to 7 values
  if (constraints.joint_constraints.size() <= most) return;
  throw Refusal(Code::limit, "the request has " + std::to_string(constraints.joint_constraints.size()) +
                                 " joint constraints; at most " + std::to_string(most) +
                                 " are allowed (8 times ~limits/max_links)");
}

/// Evaluates a constraint as MoveIt does: angles of continuous joints are compared modulo a full turn, a position
/// beyond the limits of the joint counts as the limit, and a weight of 0 counts as 1.
moveit::ConstraintEvalResult evaluate(const moveit::JointConstraint& constraint, const AskedState& asked) {
  const Kinematics& kinematics = *asked.robot.read->joints->kinematics;
  const std::string name = printable(constraint.joint_name);
  const int variable = kinematics.find(jointOf(constraint.joint_name, asked.robot.name));
  if (variable < 0) {
    throw Refusal(Code::unknown_id, "the joint constraint names '" + name + "', which is no joint value of robot '" +
                                        asked.robot.name + "'");
  }
  if (!(constraint.tolerance_above >= 0.0 && constraint.tolerance_below >= 0.0)) {
    throw Refusal(Code::out_of_range, "the constraint of joint '" + name + "' has the tolerances " +
                                          text(constraint.tolerance_above) + " and " +
                                          text(constraint.tolerance_below) + "; both must be 0 or positive");
  }
  const JointVariable& joint = kinematics.variables()[static_cast<std::size_t>(variable)];
  double apart = asked.batch.positions[static_cast<std::size_t>(variable)] -
                 std::min(std::max(constraint.position, joint.lower), joint.upper);
  if (joint.is_continuous) apart = std::remainder(apart, 2.0 * M_PI);
  constexpr double kSlack = 2.0 * std::numeric_limits<double>::epsilon();
  moveit::ConstraintEvalResult result;
  result.result = apart <= constraint.tolerance_above + kSlack && apart >= -constraint.tolerance_below - kSlack;
  result.distance = (constraint.weight > kSlack ? constraint.weight : 1.0) * std::abs(apart);
  return result;
}

/// Returns the name that MoveIt has for a body, and what kind of body it is.
std::pair<std::string, std::uint32_t> moveitBody(const StateChecker& checker, std::uint32_t index) {
  const BodyList& bodies = checker.snapshot().structure().bodies;
  const Body& body = bodies[index];
  const std::string local = body.name.substr(body.name.find('/') + 1);
  if (hasCells(body.kind)) return {"<octomap>", ContactInformation::WORLD_OBJECT};
  if (body.kind != BodyKind::link) {
    return {local, checker.moves(index) ? ContactInformation::ROBOT_ATTACHED : ContactInformation::WORLD_OBJECT};
  }
  const bool is_shared = std::any_of(bodies.begin(), bodies.end(), [&](const Body& other) {
    return other.kind == BodyKind::link && other.robot != body.robot &&
           other.name.compare(other.name.find('/') + 1, std::string::npos, local) == 0;
  });
  return {is_shared ? body.name : local, ContactInformation::ROBOT_LINK};
}

ContactInformation contactOf(const StatePair& pair, const StateChecker& checker, const std::string& world_frame) {
  ContactInformation contact;
  contact.header.frame_id = world_frame;
  contact.header.stamp = toRos(checker.snapshot().stamp());
  std::tie(contact.contact_body_1, contact.body_type_1) = moveitBody(checker, pair.first);
  std::tie(contact.contact_body_2, contact.body_type_2) = moveitBody(checker, pair.second);
  const Contact& found = pair.contact;
  if (found.point.allFinite()) contact.position = toPoint(found.point);
  if (found.normal.allFinite()) contact.normal = toVector(found.normal);
  if (std::isfinite(found.depth)) contact.depth = found.depth;
  return contact;
}

}  // namespace

StateValidity stateValidity(const GetStateValidity::Request& request, const AnswerTick& tick,
                            const TransformLookup& transforms, std::shared_ptr<const NarrowPhase> narrow_phase) {
  tick.snapshot();  // throws while there is no world
  const Params& params = tick.get()->settings->params;
  checkConstraints(request.constraints, params);
  const AskedState asked = askedState(request.robot_state, request.group_name, *tick.get(), transforms);
  const RobotJoints& joints = *asked.robot.read->joints;
  if (joints.kinematics->variables().empty()) {
    throw Refusal(Code::unsupported, "robot '" + asked.robot.name + "' has no joint that can move");
  }
  StateCheckerOptions options;
  options.world_frame = tick.get()->world_frame;
  if (!request.group_name.empty()) {
    const auto group = variablesOf(request.group_name, joints.groups, asked.robot.read->model);
    if (group) options.group = *group;
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
  all.all_pairs = all.contacts = true;
  StateScratch scratch;
  StateAnswers answers;
  checker.checkStates(asked.batch, all, scratch, answers);
  const StateAnswer& answer = answers.states.at(0);
  if (answer.refused != Code::ok) throw Refusal(answer.refused, checker.sentenceOf(asked.batch, answers, 0));
  const std::size_t contacts = std::min(answers.pairs.size(), static_cast<std::size_t>(params.max_hits));
  for (std::size_t i = 0; i < contacts; ++i) {
    result.response.contacts.push_back(contactOf(answers.pairs[i], checker, options.world_frame));
  }
  if (answer.verdict == Verdict::unknown) {
    result.unknown = checker.sentenceOf(asked.batch, answers, 0);
  } else if (answer.verdict == Verdict::clear && !asked.doubt.empty()) {
    result.unknown = asked.doubt;
  } else if (answer.verdict == Verdict::clear) {
    result.unknown = tick.whyOutdated();
  }
  result.response.valid = satisfied && answer.verdict == Verdict::clear && result.unknown.empty();
  return result;
}

}  // namespace hgrid
