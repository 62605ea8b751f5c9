// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/state_values.h"

#include <algorithm>
#include <cmath>

#include "geometry/sine_cosine.h"

namespace hgrid {
namespace {

constexpr double kLargestLength = 1e6;             // [m]
constexpr std::uint32_t kIncomplete = 0xffffffff;  // StateAnswer::detail of a state that lacks values

double largestOf(const JointVariable& variable) { return variable.is_angle ? kLargestAngle : kLargestLength; }

/// Returns the number of values that one state of the batch has.
std::size_t widthOf(const Kinematics& kinematics, const StateBatch& batch) {
  return batch.joints.empty() ? kinematics.variables().size() : batch.joints.size();
}

/// Returns the column of a variable in the batch; -1: it has none.
std::int64_t columnOf(const Kinematics& kinematics, const StateBatch& batch, std::size_t variable) {
  if (batch.joints.empty()) return static_cast<std::int64_t>(variable);
  const auto found = std::find(batch.joints.begin(), batch.joints.end(), kinematics.variables()[variable].name);
  return found == batch.joints.end() ? -1 : found - batch.joints.begin();
}

void checkJoints(const Kinematics& kinematics, const StateBatch& batch) {
  for (std::size_t i = 0; i < batch.joints.size(); ++i) {
    const std::string& joint = batch.joints[i];
    if (kinematics.find(joint) < 0) {
      throw Refusal(Code::unknown_id, "joint '" + printable(joint) + "' of the states is not a variable of robot '" +
                                          printable(kinematics.name()) +
                                          "'; fixed joints and joints that mimic others have none");
    }
    if (std::find(batch.joints.begin() + static_cast<std::ptrdiff_t>(i) + 1, batch.joints.end(), joint) !=
        batch.joints.end()) {
      throw Refusal(Code::dup_id,
                    "joint '" + printable(joint) + "' occurs twice in the states; each joint must occur once");
    }
  }
}

void checkOthers(const Kinematics& kinematics, const StateBatch& batch) {
  if (batch.others.empty()) return;
  const std::vector<JointVariable>& variables = kinematics.variables();
  if (batch.others.size() != variables.size()) {
    throw Refusal(Code::out_of_range, "the states have " + std::to_string(batch.others.size()) +
                                          " values for the other joints; there must be one for each of the " +
                                          std::to_string(variables.size()) + " variables, or none");
  }
  for (std::size_t i = 0; i < variables.size(); ++i) {
    if (std::abs(batch.others[i]) <= largestOf(variables[i])) continue;
    throw Refusal(Code::nonfinite, "the value of joint '" + printable(variables[i].name) +
                                       "' among the other joints is " + text(batch.others[i]) +
                                       "; it must be finite and at most " + text(largestOf(variables[i])));
  }
}

/// Checks the quaternions of which no part is in the batch.
void checkOtherQuaternions(const Kinematics& kinematics, const StateBatch& batch) {
  const std::vector<JointVariable>& variables = kinematics.variables();
  for (std::size_t i = 0; !batch.others.empty() && i + 3 < variables.size(); ++i) {
    if (variables[i].quaternion != static_cast<int>(i)) continue;
    double squared = 0.0;
    bool given = false;
    for (std::size_t k = i; k < i + 4; ++k) {
      squared += batch.others[k] * batch.others[k];
      given = given || columnOf(kinematics, batch, k) >= 0;
    }
    if (given || std::abs(squared - 1.0) <= kQuaternionTolerance) continue;
    throw Refusal(Code::bad_rotation, "the quaternion of joint '" + printable(variables[i].joint) +
                                          "' among the other joints has the squared norm " + text(squared) +
                                          "; it must be a unit quaternion");
  }
}

}  // namespace

StateValues::StateValues(const Kinematics& kinematics, const RobotShapes& robot, const StateBatch& batch,
                         StateMemory& scratch)
    : kinematics_(kinematics),
      batch_(batch),
      scratch_(scratch),
      width_(std::max<std::size_t>(1, widthOf(kinematics, batch))) {
  checkJoints(kinematics, batch);
  checkOthers(kinematics, batch);
  checkOtherQuaternions(kinematics, batch);
  const std::vector<JointVariable>& variables = kinematics.variables();
  scratch.columns.clear();
  scratch.values.resize(variables.size());
  for (std::uint32_t i = 0; i < variables.size(); ++i) {
    const std::int64_t column = columnOf(kinematics, batch, i);
    if (column >= 0) {
      scratch.columns.push_back({i, static_cast<std::uint32_t>(column)});
    } else if (!batch.others.empty()) {
      scratch.values[i] = fourDoubles(batch.others[i]);
      if (batch.others[i] < variables[i].lower || batch.others[i] > variables[i].upper) others_beyond_ = true;
    } else {
      throw Refusal(Code::not_ready, "the states have no value for joint '" + printable(variables[i].name) +
                                         "'; name all joints, or give values for the other joints");
    }
  }
  findMimics();
  findChanges(robot);
}

std::size_t StateValues::sizeOf(const Kinematics& kinematics, const StateBatch& batch) {
  const std::size_t width = std::max<std::size_t>(1, widthOf(kinematics, batch));
  return (batch.positions.size() + width - 1) / width;
}

/// Finds the joints that mimic a variable of the batch. They are checked in each state. Joints that mimic another
/// variable have the same position in all states; they are checked here.
void StateValues::findMimics() {
  scratch_.mimics.clear();
  const std::vector<JointMotion>& joints = kinematics_.state().groups;
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].mimics) continue;
    const bool in_batch = std::any_of(scratch_.columns.begin(), scratch_.columns.end(),
                                      [&](const auto& column) { return column.variable == joints[i].variable; });
    if (in_batch) {
      scratch_.mimics.push_back(i);
    } else if (!checkMimic(joints[i], 0, others_beyond_)) {
      other_refused_ = joints[i].variable;
    }
  }
}

/// Checks the position of a joint that mimics another one. Sets `beyond` if it is beyond its limits. @returns whether
/// it is small enough to be used
bool StateValues::checkMimic(const JointMotion& joint, std::size_t lane, bool& beyond) const {
  const double position = joint.multiplier * scratch_.values[joint.variable][lane] + joint.offset;
  if (position < joint.lower || position > joint.upper) beyond = true;
  return std::abs(position) <= (joint.kind == JointKind::revolute ? kLargestAngle : kLargestLength);
}

/// Finds the rigid groups that move when the variables in the batch change. Groups without shapes are left out.
void StateValues::findChanges(const RobotShapes& robot) {
  const std::vector<JointMotion>& joints = kinematics_.state().groups;
  std::vector<GroupChange>& changes = scratch_.changes;
  changes.assign(joints.size(), GroupChange::none);
  for (std::size_t i = 1; i < joints.size(); ++i) {
    if (!robot.carriesShapes(i)) continue;
    const std::uint32_t first = joints[i].variable, end = first + joints[i].variables();
    const bool moves = std::any_of(scratch_.columns.begin(), scratch_.columns.end(), [&](const auto& column) {
      return column.variable >= first && column.variable < end;
    });
    if (moves) {
      changes[i] = GroupChange::joint;
    } else if (changes[joints[i].parent] != GroupChange::none) {
      changes[i] = GroupChange::parent;
    }
  }
}

void StateValues::read(std::size_t state, std::size_t lane, StateAnswer& answer) {
  if (isComplete(state)) {
    const double* const positions = batch_.positions.data() + state * width_;
    for (const auto& [variable, column] : scratch_.columns) scratch_.values[variable].set(lane, positions[column]);
    check(lane, answer);
  } else {
    answer.refused = Code::bad_geometry;
    answer.detail = kIncomplete;
  }
  if (answer.refused == Code::ok) return;
  answer.because = Unknown::refused;
  clear(lane);
}

void StateValues::restoreOthers(std::size_t lane) {
  for (std::size_t i = 0; i < batch_.others.size(); ++i) {
    const bool is_given = std::any_of(scratch_.columns.begin(), scratch_.columns.end(),
                                      [&](const auto& column) { return column.variable == i; });
    if (!is_given) scratch_.values[i].set(lane, batch_.others[i]);
  }
}

void StateValues::clear(std::size_t lane) {
  for (const auto& [variable, column] : scratch_.columns) scratch_.values[variable].set(lane, 0.0);
}

/// Checks the values of a lane, and sets `refused`, `detail` and `beyond_limits`.
void StateValues::check(std::size_t lane, StateAnswer& answer) const {
  const std::vector<JointVariable>& variables = kinematics_.variables();
  const auto refuse = [&](Code code, std::size_t variable) {
    answer.refused = code;
    answer.detail = static_cast<std::uint32_t>(variable);
  };
  answer.beyond_limits = others_beyond_;
  for (const auto& [i, column] : scratch_.columns) {
    const double position = scratch_.values[i][lane];
    if (!std::isfinite(position)) return refuse(Code::nonfinite, i);
    if (!(std::abs(position) <= largestOf(variables[i]))) return refuse(Code::out_of_range, i);
    if (position < variables[i].lower || position > variables[i].upper) answer.beyond_limits = true;
    if (variables[i].quaternion < 0) continue;
    const auto first = static_cast<std::size_t>(variables[i].quaternion);
    double squared = 0.0;
    for (std::size_t k = first; k < first + 4; ++k) squared += scratch_.values[k][lane] * scratch_.values[k][lane];
    if (!(std::abs(squared - 1.0) <= kQuaternionTolerance)) return refuse(Code::bad_rotation, i);
  }
  for (const std::uint32_t mimic : scratch_.mimics) {
    const JointMotion& joint = kinematics_.state().groups[mimic];
    if (!checkMimic(joint, lane, answer.beyond_limits)) return refuse(Code::out_of_range, joint.variable);
  }
  if (other_refused_) refuse(Code::out_of_range, *other_refused_);
}

std::string refusalOf(const Kinematics& kinematics, const StateBatch& batch, std::size_t state,
                      const StateAnswer& answer) {
  const std::size_t width = std::max<std::size_t>(1, widthOf(kinematics, batch));
  const std::string what = "state " + std::to_string(state);
  if (answer.detail == kIncomplete) {
    return what + " has " + std::to_string(batch.positions.size() - state * width) + " values; it must have " +
           std::to_string(width) + ", one for each joint";
  }
  const JointVariable& variable = kinematics.variables()[answer.detail];
  const std::int64_t column = columnOf(kinematics, batch, answer.detail);
  const double value =
      column < 0 ? batch.others[answer.detail] : batch.positions[state * width + static_cast<std::size_t>(column)];
  const std::string joint = what + ": joint '" + printable(variable.joint) + "' ";
  if (answer.refused == Code::bad_rotation) {
    return joint + "has a quaternion whose squared norm differs from 1 by more than " + text(kQuaternionTolerance) +
           "; it must be a unit quaternion";
  }
  if (answer.refused == Code::nonfinite) {
    return joint + "has the value " + text(value) + "; it must be finite";
  }
  return joint + "has the value " + text(value) + "; its size, and that of joints that mimic it, must be at most " +
         text(largestOf(variable));
}

}  // namespace hgrid
