// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/guard/path_message.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <string>
#include <vector>

#include "src/node/guard/action_message.h"
#include "src/node/guard/path_message_types.h"
#include "test/support/random.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using moveit::JointTrajectory;
using test::refusalOf;

constexpr const char* kTrajectory = "65b4f94a94d1ed67169da35a02f33d3f";
constexpr const char* kGoal = "cff5c1d533bf2f82dd0138d57f4304bb";
constexpr const char* kDisplay = "41936b74e168ba754279ae683ce3f121";
constexpr Time kArrival = std::chrono::seconds(1000);

template <class Message>
std::string bytesOf(const Message& message) {
  std::string bytes(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes[0]), std::uint32_t(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

struct Point {
  double time;
  std::vector<double> positions;
};

JointTrajectory trajectory(const std::vector<std::string>& joints, const std::vector<Point>& points) {
  JointTrajectory trajectory;
  trajectory.joint_names = joints;
  for (const Point& point : points) {
    trajectory.points.emplace_back();
    trajectory.points.back().positions = point.positions;
    trajectory.points.back().time_from_start = ros::Duration(point.time);
  }
  return trajectory;
}

moveit::DisplayTrajectory display(const std::vector<JointTrajectory>& parts) {
  moveit::DisplayTrajectory display;
  for (const JointTrajectory& part : parts) display.trajectory.push_back({part, {}});
  return display;
}

std::vector<double> timesOf(const RobotPath& path) {
  std::vector<double> times;
  for (const Time time : path.times) times.push_back(seconds(time - kArrival));
  return times;
}

using Numbers = std::vector<double>;

TEST(PathMessage, StartsAtItsStampOrWhenItArrives) {
  JointTrajectory message = trajectory({"a"}, {{1.0, {0.5}}, {2.5, {0.7}}});
  EXPECT_EQ(timesOf(readPathMessage(bytesOf(message), kTrajectory, kArrival).path), (Numbers{1.0, 2.5}));
  message.header.stamp = ros::Time(1003.0);
  moveit::FollowJointTrajectoryActionGoal goal;
  goal.header.stamp = ros::Time(5.0);  // when the goal was sent does not matter
  goal.trajectory = message;
  goal.path_tolerance.resize(2);
  goal.goal_id = "goal";
  for (const PathCommand& command :
       {readPathMessage(bytesOf(message), kTrajectory, kArrival), readPathMessage(bytesOf(goal), kGoal, kArrival)}) {
    EXPECT_EQ(seconds(command.start - kArrival), 3.0);
    EXPECT_EQ(timesOf(command.path), (Numbers{4.0, 5.5}));
    EXPECT_EQ(command.path.joints, std::vector<std::string>{"a"});
    EXPECT_EQ(command.path.positions, (Numbers{0.5, 0.7}));
  }
}

/// Claim: parts of a plan follow one another, and a joint stands still in the parts that do not have it.
TEST(PathMessage, PartsFollowOneAnother) {
  const RobotPath path =
      readPathMessage(bytesOf(display({trajectory({"a", "b"}, {{0.0, {1, 2}}, {2.0, {3, 4}}}), trajectory({}, {}),
                                       trajectory({"c"}, {{0.0, {7}}, {1.0, {8}}}), trajectory({"b"}, {{0.5, {9}}})})),
                      kDisplay, kArrival)
          .path;
  EXPECT_EQ(path.joints, (std::vector<std::string>{"a", "b", "c"}));
  const Time second = std::chrono::seconds(1), step(1);
  EXPECT_EQ(path.times, (std::vector<Time>{kArrival, kArrival + 2 * second, kArrival + 2 * second + step,
                                           kArrival + 3 * second, kArrival + 7 * second / 2}));
  EXPECT_EQ(path.positions, (Numbers{1, 2, 7, 3, 4, 7, 3, 4, 7, 3, 4, 8, 3, 9, 8}));
  // A part that begins elsewhere than the one before it ended takes nothing away from that one.
  EXPECT_EQ(
      readPathMessage(
          bytesOf(display({trajectory({"a"}, {{0.0, {1}}, {2.0, {3}}}), trajectory({"a"}, {{0.0, {5}}, {1.0, {6}}})})),
          kDisplay, kArrival)
          .path.positions,
      (Numbers{1, 3, 5, 6}));
  EXPECT_EQ(readPathMessage(bytesOf(display({})), kDisplay, kArrival).path.points(), 0u);
}

TEST(PathMessage, RefusesWhatItCannotRead) {
  const auto refused = [](const std::string& bytes, const char* md5) {
    return refusalOf([&] { readPathMessage(bytes, md5, kArrival); });
  };
  EXPECT_EQ(refused(bytesOf(trajectory({"a"}, {{1.0, {}}})), kTrajectory), Code::out_of_range);
  EXPECT_EQ(refused(bytesOf(trajectory({"a"}, {{-1.0, {0}}})), kTrajectory), Code::out_of_range);
  EXPECT_EQ(refused(bytesOf(trajectory({"a", "a"}, {{1.0, {0, 0}}})), kTrajectory), Code::conflict);
  EXPECT_EQ(refused(bytesOf(trajectory({"a"}, {{1.0, {0}}})), "other"), Code::unsupported);
  // Each part is short enough, but all of them together are too long.
  const JointTrajectory day = trajectory({"a"}, {{0.0, {0}}, {80000.0, {1}}});
  EXPECT_EQ(refused(bytesOf(display({day, day})), kDisplay), Code::out_of_range);
  moveit::DisplayTrajectory flying = display({day});
  flying.trajectory[0].multi_dof_joint_trajectory.points.resize(1);
  EXPECT_EQ(refused(bytesOf(flying), kDisplay), Code::unsupported);
  // Few bytes that would become a path of 10^10 positions.
  std::vector<JointTrajectory> many;
  for (int i = 0; i < 100000; ++i) many.push_back(trajectory({std::to_string(i)}, {{0.0, {0}}}));
  EXPECT_EQ(refused(bytesOf(display(many)), kDisplay), Code::limit);
}

/// Claim: a message that ends early is refused, and no byte of it can do harm.
TEST(PathMessage, RefusesEveryCutAndSurvivesRandomBytes) {
  const std::string whole = bytesOf(display({trajectory({"a", "b"}, {{0.0, {1, 2}}, {2.0, {3, 4}}})}));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_EQ(refusalOf([&] { readPathMessage(whole.substr(0, length), kDisplay, kArrival); }), Code::truncated);
  }
  test::Random random(2);
  int read = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string bytes = whole;
    for (int i = random.between(1, 3); i > 0; --i) {
      bytes[std::size_t(random.between(0, int(bytes.size()) - 1))] = char(random.between(0, 255));
    }
    read += refusalOf([&] { readPathMessage(bytes, kDisplay, kArrival); }) == Code::ok;
  }
  EXPECT_GT(read, 1000);
}

constexpr const char* kCancel = "302881f31927c1df708a2dbab0e80ee8";
constexpr const char* kStatus = "8b2b82f13216d0a8ea88bd3af735e619";
constexpr const char* kResult = "c4fb3b000dc9da4fd99699380efcc5d9";

moveit::ActionGoalStatus statusOf(const std::string& id, int second, GoalStatus::Value value) {
  moveit::ActionGoalStatus status;
  status.goal.id = id;
  status.goal.stamp = ros::Time(double(second));
  status.status = value;
  status.text = "why";
  return status;
}

TEST(ActionMessage, IsReadFromAllTopicsOfAnAction) {
  moveit::FollowJointTrajectoryActionGoal goal;
  goal.goal_id = "a";
  goal.goal_stamp = ros::Time(2.0);
  goal.trajectory = trajectory({"elbow"}, {{1.0, {0.5}}});
  EXPECT_EQ(readGoalId(bytesOf(goal), kGoal)->id, "a");
  EXPECT_EQ(readGoalId(bytesOf(goal), kGoal)->stamp, std::chrono::seconds(2));
  EXPECT_FALSE(readGoalId(bytesOf(goal.trajectory), kTrajectory).has_value());
  const moveit::ActionGoalStatus status = statusOf("b", 3, GoalStatus::PREEMPTED);
  EXPECT_EQ(readCancel(bytesOf(status.goal), kCancel).id, "b");
  EXPECT_EQ(readCancel(bytesOf(status.goal), kCancel).stamp, std::chrono::seconds(3));
  moveit::FollowJointTrajectoryActionResult result;
  result.status = status;
  EXPECT_EQ(readResult(bytesOf(result), kResult).goal.id, "b");
  EXPECT_EQ(readResult(bytesOf(result), kResult).status, GoalStatus::PREEMPTED);
  moveit::ActionGoalStatusArray array;
  array.status_list = {status, statusOf("c", 4, GoalStatus::ACTIVE)};
  const std::vector<GoalStatus> all = readStatus(bytesOf(array), kStatus);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1].goal.id, "c");
  EXPECT_EQ(all[1].status, GoalStatus::ACTIVE);
}

TEST(ActionMessage, OfAnotherTypeOrCutIsRefused) {
  moveit::ActionGoalStatusArray array;
  array.status_list = {statusOf("b", 3, GoalStatus::PREEMPTED)};
  const std::string bytes = bytesOf(array);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_EQ(refusalOf([&] { readStatus(bytes.substr(0, length), kStatus); }), Code::truncated);
    EXPECT_EQ(refusalOf([&] { readResult(bytes.substr(0, length), kResult); }), Code::truncated);
  }
  EXPECT_EQ(refusalOf([&] { readStatus(bytes, kCancel); }), Code::unsupported);
  EXPECT_EQ(refusalOf([&] { readCancel(bytes, kStatus); }), Code::unsupported);
  EXPECT_EQ(refusalOf([&] { readResult(bytes, ""); }), Code::unsupported);
}

}  // namespace
}  // namespace hgrid
