// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/guard/robot_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "src/node/guard/path_list.h"
#include "test/support/random.h"

namespace hgrid {
namespace {

using test::Random;

/// Returns a path of some of the joints a to e, with times between 0 and 100 s.
RobotPath randomPath(Random& random) {
  RobotPath path;
  path.robot = "robot";
  for (const char* joint : {"a", "b", "c", "d", "e"}) {
    if (random.chance(0.5)) path.joints.push_back(joint);
  }
  if (path.joints.empty()) path.joints.push_back("a");
  Time time(0);
  for (int i = random.between(1, 10); i > 0; --i) {
    time += std::chrono::milliseconds(random.between(1, 10000));
    path.times.push_back(time);
    for (std::size_t k = 0; k < path.joints.size(); ++k) path.positions.push_back(random.uniform(-3.0, 3.0));
  }
  return path;
}

/// Returns where a joint is at a time, found from all pairs of neighboring points; `otherwise` if the path lacks it.
double expectedAt(const RobotPath& path, const std::string& joint, Time time, double otherwise) {
  const auto found = std::find(path.joints.begin(), path.joints.end(), joint);
  if (found == path.joints.end()) return otherwise;
  const auto column = std::size_t(found - path.joints.begin());
  const auto at = [&](std::size_t point) { return path.positions[point * path.joints.size() + column]; };
  for (std::size_t k = 0; k + 1 < path.points(); ++k) {
    if (time < path.times[k] || time > path.times[k + 1]) continue;
    const double whole = seconds(path.times[k + 1] - path.times[k]), part = seconds(time - path.times[k]);
    return at(k) * (1.0 - part / whole) + at(k + 1) * (part / whole);
  }
  return time < path.times.front() ? at(0) : at(path.points() - 1);
}

/// Claim: in a merged path, each joint is at every time where the newest path that has it says.
TEST(RobotPath, MergedHasEveryJointWhereItsNewestPathHasIt) {
  Random random(1);
  for (int round = 0; round < test::countFromEnvironment("HGRID_TEST_WORLDS", 10000) / 10; ++round) {
    RobotPaths paths;
    for (int i = random.between(1, 4); i > 0; --i)
      paths.push_back(std::make_shared<const RobotPath>(randomPath(random)));
    const RobotPath merged = *mergePaths(paths);
    ASSERT_NO_THROW(checkPath(merged));
    for (int i = 0; i < 20; ++i) {
      const Time time = std::chrono::milliseconds(random.between(-1000, 101000));
      for (std::size_t joint = 0; joint < merged.joints.size(); ++joint) {
        double expected = 1e9;
        for (auto path = paths.rbegin(); path != paths.rend(); ++path) {
          expected = expectedAt(**path, merged.joints[joint], time, expected);
        }
        ASSERT_NEAR(merged.positionAt(joint, time), expected, 1e-9) << "round " << round;
      }
    }
    for (const auto& path : paths) {
      for (const std::string& joint : path->joints) {
        ASSERT_EQ(std::count(merged.joints.begin(), merged.joints.end(), joint), 1);
      }
    }
  }
}

class PathListTest : public ::testing::Test {
 protected:
  PathListTest() { setRobots({"left", "right"}); }
  void setRobots(const std::vector<std::string>& names) {
    RobotEntries robots;
    for (const std::string& name : names) robots[name].model = std::make_shared<const LoadedRobot>();
    tick_.robots = std::make_shared<const RobotEntries>(robots);
  }
  /// @param joints  names with spaces between them
  static RobotPath path(const std::string& robot, const std::string& joints, int end) {
    RobotPath path;
    path.robot = robot;
    std::istringstream names(joints);
    for (std::string name; names >> name;) path.joints.push_back(name);
    path.positions.assign(path.joints.size(), 0.0);
    path.times = {std::chrono::seconds(end)};
    return path;
  }
  /// Returns a topic of the controller "arm".
  static PathSource arm(const std::string& topic, const std::string& goal = {}) {
    PathSource source("/arm/" + topic);
    if (topic == "command") source.command_of = "/arm";
    if (topic == "goal") source.action_of = {"/arm", ""};
    source.goal = goal;
    return source;
  }
  void putGoal(const std::string& goal, const std::string& joints, int end) {
    list_.put(arm("goal", goal), path("left", joints, end), tick_, GoalPhase::sent);
  }
  void note(const std::string& goal, GoalPhase phase) { list_.note(arm("goal", goal), "left", phase, tick_); }
  /// Returns the robots and joints that are watched, such as "left: elbow shoulder".
  std::vector<std::string> watched(int now) {
    tick_.made.ros = std::chrono::seconds(now);
    std::vector<std::string> lines;
    for (const auto& path : list_.current(tick_, [this](const RobotPath&) { return arrived_; })) {
      lines.push_back(path->robot + ":");
      for (const std::string& joint : path->joints) lines.back() += " " + joint;
      if (path->doubt.find("not accepted") != std::string::npos) {
        lines.back() += " (not accepted)";
      } else if (path->doubt.find("stops or goes on") != std::string::npos) {
        lines.back() += " (stops?)";
      } else if (path->doubt.find("did not receive") != std::string::npos) {
        lines.back() += " (not received)";
      } else if (!path->doubt.empty()) {
        lines.back() += " (" + path->doubt + ")";
      }
    }
    return lines;
  }
  using Lines = std::vector<std::string>;

  PathList list_;
  Tick tick_;
  std::optional<bool> arrived_ = true;
};

TEST_F(PathListTest, HasThePathsOfAllSourcesUntilTheyEnd) {
  EXPECT_TRUE(list_.empty());
  list_.put({"topic"}, path("right", "elbow", 10), tick_);
  list_.put({""}, path("right", "shoulder", 20), tick_);
  list_.put({"topic"}, path("left", "elbow", 20), tick_);
  EXPECT_EQ(watched(10), (Lines{"left: elbow", "right: shoulder elbow"}));
  EXPECT_EQ(watched(11), (Lines{"left: elbow", "right: shoulder"}));
  list_.put({""}, path("right", "wrist", 20), tick_);
  EXPECT_EQ(watched(11), (Lines{"left: elbow", "right: wrist"}));
  EXPECT_EQ(watched(21), Lines{});
  EXPECT_TRUE(list_.empty());
}

TEST_F(PathListTest, ForgetsWhatIsStoppedAndRobotsThatAreRemoved) {
  list_.put({"topic"}, path("left", "elbow", 10), tick_);
  list_.put({""}, path("left", "shoulder", 10), tick_);
  list_.stop({"other"}, "left");
  EXPECT_EQ(watched(1), Lines{"left: shoulder elbow"});
  list_.stop({"topic"}, "left");
  EXPECT_EQ(watched(1), Lines{"left: shoulder"});
  list_.removeAll("left");
  EXPECT_TRUE(list_.empty());
  list_.put({""}, path("left", "elbow", 10), tick_);
  RobotEntries absent = *tick_.robots;
  absent["left"].absent = true;
  tick_.robots = std::make_shared<const RobotEntries>(absent);
  EXPECT_EQ(watched(1), Lines{});
  EXPECT_TRUE(list_.empty());
}

/// Claim: a robot that is not at the end of its path when the path ends is still on its way.
TEST_F(PathListTest, APathDoesNotEndBeforeItsRobotArrives) {
  list_.put({""}, path("left", "elbow", 10), tick_);
  arrived_ = false;
  EXPECT_EQ(watched(1000), Lines{"left: elbow"});
  arrived_ = true;
  EXPECT_EQ(watched(1000), Lines{});
}

TEST_F(PathListTest, KnowsWhetherAPathWasReplaced) {
  const auto first = list_.put({""}, path("left", "elbow", 10), tick_);
  EXPECT_TRUE(list_.has(first));
  EXPECT_EQ(list_.of("left"), first);
  EXPECT_EQ(list_.of("right"), nullptr);
  const auto second = list_.put({""}, path("left", "elbow", 10), tick_);
  EXPECT_FALSE(list_.has(first));
  EXPECT_TRUE(list_.has(second));
}

/// Claim: a path that could not be read does not end, until the same source sends another one.
TEST_F(PathListTest, KeepsThatAPathCouldNotBeRead) {
  RobotPath lost;
  lost.robot = "left";
  lost.doubt = "NONFINITE";
  list_.put({"topic"}, lost, tick_);
  list_.put({"other"}, path("left", "elbow", 10), tick_);
  EXPECT_EQ(watched(5), Lines{"left: elbow (NONFINITE)"});
  EXPECT_EQ(watched(1000), Lines{"left: (NONFINITE)"});
  list_.put({"topic"}, path("left", "wrist", 2000), tick_);
  EXPECT_EQ(watched(1000), Lines{"left: wrist"});
}

/// Claim: a message replaces the paths of the joints that it names, and of no others, whatever its topic is.
TEST_F(PathListTest, AMessageReplacesThePathsOfItsJointsOnly) {
  list_.put({"topic"}, path("left", "a b c", 10), tick_);
  list_.put({"topic"}, path("left", "a", 5), tick_);
  EXPECT_EQ(watched(1), Lines{"left: a b c"});
  list_.put({"other"}, path("left", "b", 5), tick_);
  EXPECT_EQ(watched(7), Lines{"left: c"}) << "the earlier paths of a and b do not come back";
  list_.put({"other"}, path("right", "c", 5), tick_);
  EXPECT_EQ(watched(4), (Lines{"left: c", "right: c"}));
}

/// Claim: a plan says nothing about joints that a command moves, and replaces the plan before it.
TEST_F(PathListTest, APlanDoesNotHideACommand) {
  PathSource plan("plans");
  plan.is_plan = true;
  list_.put({"topic"}, path("left", "a", 10), tick_);
  list_.put(plan, path("left", "a b", 20), tick_);
  EXPECT_EQ(watched(1), Lines{"left: b a"});
  EXPECT_EQ(watched(15), Lines{"left: b"});
  list_.put(plan, path("left", "c", 20), tick_);
  EXPECT_EQ(watched(15), Lines{"left: c"});
  list_.put({"topic"}, path("left", "c", 30), tick_);
  EXPECT_EQ(watched(25), Lines{"left: c"});
  list_.put(plan, path("left", "c", 40), tick_);
  EXPECT_EQ(watched(35), Lines{});
}

/// Claim: a goal that is refused leaves the robot on its earlier path.
TEST_F(PathListTest, ARefusedGoalGivesBackTheEarlierPath) {
  list_.put(arm("command"), path("left", "a b", 20), tick_);
  putGoal("1", "a", 10);
  EXPECT_EQ(watched(1), Lines{"left: a b (not accepted)"});
  EXPECT_EQ(list_.of("left")->times.size(), 2u);
  note("1", GoalPhase::refused);
  EXPECT_EQ(watched(1), Lines{"left: a b"});
  EXPECT_EQ(list_.of("left")->times, std::vector<Time>{std::chrono::seconds(20)});
  putGoal("2", "a", 10);
  note("2", GoalPhase::followed);
  EXPECT_EQ(watched(1), Lines{"left: a b"});
  EXPECT_EQ(watched(15), Lines{"left: b"});
}

/// Claim: a command replaces a goal, which does not come back when the command has ended.
TEST_F(PathListTest, ACommandReplacesAGoal) {
  putGoal("1", "a b", 20);
  note("1", GoalPhase::followed);
  list_.put(arm("command"), path("left", "a b", 5), tick_);
  note("1", GoalPhase::ending);
  EXPECT_EQ(watched(1), Lines{"left: a b"});
  EXPECT_EQ(watched(6), Lines{});
}

/// Claim: if a newer goal names only some joints of a goal, the robot may still move the other joints along the older
/// path. The older path ends when the robot has left it.
TEST_F(PathListTest, TheOtherJointsOfAReplacedGoalMayGoOn) {
  putGoal("1", "a b", 20);
  note("1", GoalPhase::followed);
  putGoal("2", "a", 30);
  note("1", GoalPhase::ending);
  note("2", GoalPhase::followed);
  EXPECT_EQ(watched(1), Lines{"left: a b (stops?)"});
  arrived_ = std::nullopt;  // nobody knows where the robot is
  EXPECT_EQ(watched(1), Lines{"left: a b (stops?)"});
  arrived_ = false;
  EXPECT_EQ(watched(1), Lines{"left: a"});
}

/// Claim: the cancel of a goal ends its path, and makes earlier paths of the same controller doubtful.
TEST_F(PathListTest, ACanceledGoalStopsItsController) {
  list_.put({"/hand/command"}, path("left", "c", 20), tick_);
  list_.put(arm("command"), path("left", "a b", 20), tick_);
  putGoal("1", "a", 20);
  note("1", GoalPhase::followed);
  putGoal("2", "a", 20);
  note("1", GoalPhase::stopped);
  note("2", GoalPhase::followed);
  EXPECT_EQ(watched(1), Lines{"left: a b c (stops?)"});
  note("2", GoalPhase::stopped);
  arrived_ = false;
  EXPECT_EQ(watched(1), Lines{"left: c"});
}

/// Claim: a message without points ends the paths of its topic. A goal of the same controller may go on, until the
/// server or tf tells that it does not. Other controllers go on.
TEST_F(PathListTest, AMessageWithoutPointsStopsItsController) {
  PathSource other = arm("other/goal", "1");
  other.action_of = {"/arm/other", ""};
  list_.put(other, path("left", "c", 20), tick_);
  list_.put(arm("command"), path("left", "b", 20), tick_);
  putGoal("1", "a", 20);
  note("1", GoalPhase::followed);
  list_.stop(arm("command"), "left");
  EXPECT_EQ(watched(1), Lines{"left: a c (stops?)"});
  arrived_ = false;
  EXPECT_EQ(watched(1), Lines{"left: c"});
}

/// Claim: a goal whose path this node has not received makes the robot's path unknown until the goal ends.
TEST_F(PathListTest, AGoalThatWasNotReceivedIsUnknown) {
  note("1", GoalPhase::unseen);
  note("1", GoalPhase::unseen);
  EXPECT_EQ(watched(1000), Lines{"left: (not received)"});
  list_.put(arm("goal", "1"), path("left", "a", 2000), tick_, GoalPhase::followed);
  EXPECT_EQ(watched(1000), Lines{"left: a"}) << "the goal arrives later than its status";
  note("2", GoalPhase::unseen);
  EXPECT_EQ(watched(1000), Lines{"left: a (not received)"});
  note("2", GoalPhase::over);
  EXPECT_EQ(watched(1000), Lines{"left: a"});
}

/// Claim: a goal of which the server says nothing is forgotten when its path is over; one that waits is kept.
TEST_F(PathListTest, AGoalWaitsAsLongAsItsServerHasIt) {
  putGoal("1", "a", 10);
  EXPECT_EQ(watched(11), Lines{});
  putGoal("2", "a", 10);
  note("2", GoalPhase::waiting);
  EXPECT_EQ(watched(11), Lines{"left: a (not accepted)"});
  const auto waiting = list_.waiting(arm("goal", "2"), "left");
  ASSERT_NE(waiting, nullptr);
  list_.replace(waiting, path("left", "a", 30));
  note("2", GoalPhase::followed);
  EXPECT_EQ(list_.waiting(arm("goal", "2"), "left"), nullptr);
  EXPECT_EQ(watched(29), Lines{"left: a"});
  EXPECT_EQ(watched(31), Lines{});
}

/// Claim: a command that came while a goal waited may be older or newer than the beginning of the goal.
TEST_F(PathListTest, AGoalThatBeginsAfterACommandIsDoubtful) {
  putGoal("1", "a b", 20);
  note("1", GoalPhase::waiting);
  list_.put(arm("command"), path("left", "a b", 20), tick_);
  EXPECT_EQ(watched(1), Lines{"left: a b (not accepted)"});
  note("1", GoalPhase::followed);
  EXPECT_EQ(watched(1), Lines{"left: a b (stops?)"});
  note("1", GoalPhase::ending);
  EXPECT_EQ(watched(1), Lines{"left: a b"});
}

/// Claim: a goal that could not be read makes the path unknown until the server refuses it.
TEST_F(PathListTest, AGoalThatCannotBeReadEndsWhenItIsRefused) {
  list_.put(arm("command"), path("left", "a", 20), tick_);
  RobotPath lost;
  lost.robot = "left";
  lost.doubt = "NONFINITE";
  list_.put(arm("goal", "1"), lost, tick_, GoalPhase::sent);
  EXPECT_EQ(watched(1), Lines{"left: a (NONFINITE)"});
  note("1", GoalPhase::followed);
  EXPECT_EQ(watched(1), Lines{"left: a (NONFINITE)"});
  putGoal("2", "a", 20);
  note("2", GoalPhase::refused);
  EXPECT_EQ(watched(1), Lines{"left: a (NONFINITE)"});
  note("1", GoalPhase::refused);
  EXPECT_EQ(watched(1), Lines{"left: a"});
}

}  // namespace
}  // namespace hgrid
