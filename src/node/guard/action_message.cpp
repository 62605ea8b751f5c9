// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/action_message.h"

#include "node/guard/path_message_types.h"
#include "node/time/ros_time.h"

namespace hgrid {
namespace {

constexpr const char* kGoalId = "302881f31927c1df708a2dbab0e80ee8";
constexpr const char* kStatusArray = "8b2b82f13216d0a8ea88bd3af735e619";
constexpr const char* kActionResult = "c4fb3b000dc9da4fd99699380efcc5d9";

GoalStatus statusOf(const moveit::ActionGoalStatus& status) {
  return {{status.goal.id, fromRos(status.goal.stamp)}, status.status};
}

/// @throws Refusal unsupported
void checkType(const std::string& md5, const char* expected, const char* type) {
  if (md5 == expected) return;
  throw Refusal(Code::unsupported, "its type has the MD5 " + printable(md5) + "; it must be " + type);
}

}  // namespace

std::optional<GoalId> readGoalId(const std::string& bytes, const std::string& md5) {
  if (md5 != kActionGoal) return std::nullopt;
  const auto goal = readMessage<moveit::FollowJointTrajectoryActionGoal>(bytes);
  return GoalId{goal.goal_id, fromRos(goal.goal_stamp)};
}

GoalId readCancel(const std::string& bytes, const std::string& md5) {
  checkType(md5, kGoalId, "actionlib_msgs/GoalID");
  const auto cancel = readMessage<moveit::ActionGoalId>(bytes);
  return {cancel.id, fromRos(cancel.stamp)};
}

std::vector<GoalStatus> readStatus(const std::string& bytes, const std::string& md5) {
  checkType(md5, kStatusArray, "actionlib_msgs/GoalStatusArray");
  std::vector<GoalStatus> all;
  for (const moveit::ActionGoalStatus& status : readMessage<moveit::ActionGoalStatusArray>(bytes).status_list) {
    all.push_back(statusOf(status));
  }
  return all;
}

GoalStatus readResult(const std::string& bytes, const std::string& md5) {
  checkType(md5, kActionResult, "control_msgs/FollowJointTrajectoryActionResult");
  return statusOf(readMessage<moveit::FollowJointTrajectoryActionResult>(bytes).status);
}

}  // namespace hgrid
