// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/guard/robot_path.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  static RobotPath path(const std::string& robot, const std::string& joint, int end) {
    RobotPath path;
    path.robot = robot;
    path.joints = {joint};
    path.positions = {0.0};
    path.times = {std::chrono::seconds(end)};
    return path;
  }
  /// Returns the robots and joints that are watched, such as "left: elbow shoulder".
  std::vector<std::string> watched(int now) {
    tick_.made.ros = std::chrono::seconds(now);
    std::vector<std::string> lines;
    for (const auto& path : list_.current(tick_, [this](const RobotPath&) { return arrived_; })) {
      lines.push_back(path->robot + ":");
      for (const std::string& joint : path->joints) lines.back() += " " + joint;
      if (!path->unread.empty()) lines.back() += " (" + path->unread + ")";
    }
    return lines;
  }
  using Lines = std::vector<std::string>;

  PathList list_;
  Tick tick_;
  bool arrived_ = true;
};

TEST_F(PathListTest, HasThePathsOfAllSourcesUntilTheyEnd) {
  EXPECT_TRUE(list_.empty());
  list_.put("topic", path("right", "elbow", 10), tick_);
  list_.put("", path("right", "shoulder", 20), tick_);
  list_.put("topic", path("left", "elbow", 20), tick_);
  EXPECT_EQ(watched(10), (Lines{"left: elbow", "right: shoulder elbow"}));
  EXPECT_EQ(watched(11), (Lines{"left: elbow", "right: shoulder"}));
  list_.put("", path("right", "wrist", 20), tick_);
  EXPECT_EQ(watched(11), (Lines{"left: elbow", "right: wrist"}));
  EXPECT_EQ(watched(21), Lines{});
  EXPECT_TRUE(list_.empty());
}

TEST_F(PathListTest, ForgetsWhatIsStoppedAndRobotsThatAreRemoved) {
  list_.put("topic", path("left", "elbow", 10), tick_);
  list_.put("", path("left", "shoulder", 10), tick_);
  list_.remove("other", "left");
  EXPECT_EQ(watched(1), Lines{"left: shoulder elbow"});
  list_.remove("topic", "left");
  EXPECT_EQ(watched(1), Lines{"left: shoulder"});
  list_.removeAll("left");
  EXPECT_TRUE(list_.empty());
  list_.put("", path("left", "elbow", 10), tick_);
  RobotEntries absent = *tick_.robots;
  absent["left"].absent = true;
  tick_.robots = std::make_shared<const RobotEntries>(absent);
  EXPECT_EQ(watched(1), Lines{});
  EXPECT_TRUE(list_.empty());
}

/// Claim: a robot that is not at the end of its path when the path ends is still on its way.
TEST_F(PathListTest, APathDoesNotEndBeforeItsRobotArrives) {
  list_.put("", path("left", "elbow", 10), tick_);
  arrived_ = false;
  EXPECT_EQ(watched(1000), Lines{"left: elbow"});
  arrived_ = true;
  EXPECT_EQ(watched(1000), Lines{});
}

TEST_F(PathListTest, KnowsWhetherAPathWasReplaced) {
  const auto first = list_.put("", path("left", "elbow", 10), tick_);
  EXPECT_TRUE(list_.has(first));
  EXPECT_EQ(list_.of("left"), first);
  EXPECT_EQ(list_.of("right"), nullptr);
  const auto second = list_.put("", path("left", "elbow", 10), tick_);
  EXPECT_FALSE(list_.has(first));
  EXPECT_TRUE(list_.has(second));
}

/// Claim: a path that could not be read does not end, until the same source sends another one.
TEST_F(PathListTest, KeepsThatAPathCouldNotBeRead) {
  RobotPath lost;
  lost.robot = "left";
  lost.unread = "NONFINITE";
  list_.put("topic", lost, tick_);
  list_.put("other", path("left", "elbow", 10), tick_);
  EXPECT_EQ(watched(5), Lines{"left: elbow (NONFINITE)"});
  EXPECT_EQ(watched(1000), Lines{"left: (NONFINITE)"});
  list_.put("topic", path("left", "wrist", 2000), tick_);
  EXPECT_EQ(watched(1000), Lines{"left: wrist"});
}

}  // namespace
}  // namespace hgrid
