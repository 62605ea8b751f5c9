// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares checkPaths() with samples of the same motions, one per millisecond. The robots are arms of one joint, which
// carry a sphere around their base.
#include "src/node/guard/path_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/guard/guarded_joints.h"
#include "src/node/guard/path_start.h"
#include "src/node/guard/robot_path.h"
#include "test/support/models.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::Random;

const char* const kArm =
    "<robot name='r'>"
    "<link name='base'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>"
    "<link name='arm'><collision><origin xyz='0.5 0 0'/><geometry><sphere radius='0.1'/></geometry></collision></link>"
    "<joint name='shoulder' type='revolute'><parent link='base'/><child link='arm'/><axis xyz='0 0 1'/>"
    "<limit lower='-3' upper='3' effort='1' velocity='10'/></joint></robot>";
constexpr double kReach = 0.5, kRadius = 0.1;  // [m] of the sphere on the arm; all spheres have this radius
constexpr Time kNow = std::chrono::seconds(100);
constexpr double kAhead = 10.0;  // [s]

/// Arms among spheres, all at the same height.
class Arms {
 public:
  explicit Arms(std::size_t count, const std::string& urdf = kArm) {
    const auto read = std::make_shared<ReadDescription>();
    read->model = readUrdf(urdf, nullptr);
    for (RobotLink& link : read->model.links) {
      for (BodyShape& shape : link.shapes) shape.solid = narrow_phase->solidOf(shape.shape);
    }
    read->links = std::make_shared<const LinkMatrix>(test::matrixOf(read->model));
    read->joints = std::make_shared<const RobotJoints>(read->model, nullptr, DescriptionLimits{});
    tick.settings = std::make_shared<const Settings>();
    tick.world_frame = "world";
    tick.made = {kNow, std::chrono::steady_clock::now()};
    RobotEntries entries;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string name = "robot" + std::to_string(i);
      auto robot = std::make_shared<LoadedRobot>();
      robot->name = name;
      robot->root_frame = name + "/base";
      robot->read = read;
      robot->groups.resize(2);
      for (Body& body : test::bodiesOf(read->model, name, read->links)) {
        body.frame = name + "/" + read->model.links[body.link].name;
        robot->groups[body.rigid_group].frame = body.frame;
        robot->groups[body.rigid_group].members.emplace_back(robot->bodies.size(), Pose::Identity());
        robot->links[body.name] = {body.rigid_group, Pose::Identity()};
        robot->bodies.push_back(body);
      }
      entries[name].model = robot;
      RobotSpec spec;
      spec.params.tf_prefix = name;
      entries[name].spec = std::make_shared<const RobotSpec>(spec);
      robots.push_back(robot);
    }
    tick.robots = std::make_shared<const RobotEntries>(entries);
  }

  /// Puts a robot into the scene, and its transforms into the store.
  /// @param before  angle of its arm one second ago; nullopt: there is no transform of this time
  void stand(std::size_t number, const Eigen::Vector3d& base, double angle, std::optional<double> before = {}) {
    const LoadedRobot& robot = *robots[number];
    const Pose world_from_base = test::at(base.x(), base.y()), base_from_arm{Eigen::AngleAxisd(angle, axis)};
    for (const Body& body : robot.bodies) {
      test::put(scene, body, body.link == 0 ? world_from_base : world_from_base * base_from_arm, kNow);
    }
    FramePose of_base, of_arm;
    of_base.translation = base;
    of_arm.rotation = Eigen::AngleAxisd(angle, axis);
    transforms.fix(transforms.admit("world", robot.name + "/base"), "world", of_base);
    const std::uint32_t arm = transforms.admit(robot.name + "/base", robot.name + "/arm");
    if (before) {
      FramePose was;
      was.rotation = Eigen::AngleAxisd(*before, axis);
      const Time then = kNow - std::chrono::seconds(1);
      transforms.advance(arm, robot.name + "/base", {then, FrameTable::kNone, false, was}, then);
    }
    transforms.advance(arm, robot.name + "/base", {kNow, FrameTable::kNone, before.has_value(), of_arm}, kNow);
    bases.push_back(base);
    angles.push_back(angle);
  }
  void addSphere(const Eigen::Vector3d& center) {
    Body body = test::ball(std::to_string(spheres.size()), kRadius);
    for (BodyShape& shape : body.shapes) shape.solid = narrow_phase->solidOf(shape.shape);
    test::put(scene, body, test::at(center.x(), center.y()), kNow);
    spheres.push_back(center);
  }
  std::vector<PathAnswer> check(const RobotPaths& paths) {
    tick.snapshot = scene.commit(kNow, {});
    PathLimits limits;
    limits.ahead = kAhead;
    limits.deadline = std::chrono::steady_clock::now() + std::chrono::seconds(100);
    return checkPaths(paths, tick, limits, TransformLookup(transforms), joint_states, narrow_phase);
  }

  /// Returns the center of the sphere on an arm at a time.
  Eigen::Vector3d handAt(std::size_t number, const RobotPaths& paths, Time time) const {
    double angle = angles[number];
    for (const auto& path : paths) {
      if (path->robot == robots[number]->name) angle = path->positionAt(0, time);
    }
    return bases[number] + kReach * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
  }
  /// Returns the gap [m] between a robot and everything else at a time; negative: they overlap.
  double gapAt(std::size_t number, const RobotPaths& paths, Time time) const {
    const Eigen::Vector3d hand = handAt(number, paths, time);
    double least = 1e9;
    const auto meet = [&](const Eigen::Vector3d& other) {
      least = std::min({least, (hand - other).norm(), (bases[number] - other).norm()});
    };
    for (const Eigen::Vector3d& sphere : spheres) meet(sphere);
    for (std::size_t other = 0; other < bases.size(); ++other) {
      if (other == number) continue;
      meet(bases[other]);
      meet(handAt(other, paths, time));
    }
    return least - 2.0 * kRadius;
  }

  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  Scene scene{SceneOptions{}};
  TransformStore transforms{std::chrono::seconds(10), 100};
  JointStates joint_states;
  std::vector<std::shared_ptr<const LoadedRobot>> robots;
  std::vector<Eigen::Vector3d> bases, spheres;
  std::vector<double> angles;
  Tick tick;
};

/// Claim: a path is clear exactly if the robot touches nothing on it, and a conflict is the first contact. Two paths
/// are compared at the same times.
TEST(CheckPaths, AgreesWithSamplesOfTheMotions) {
  constexpr double kDoubt = 0.01;  // [m] more than two robots move between two samples
  int hits = 0, clear = 0, of_two = 0, between = 0;
  const int rounds = std::max(20, test::countFromEnvironment("HGRID_TEST_WORLDS", 10000) / 50);
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Random random(static_cast<unsigned>(round) + 1);
    Arms arms(2);
    RobotPaths paths;
    for (std::size_t i = 0; i < 2; ++i) {
      const double angle = random.uniform(-3.0, 3.0);
      arms.stand(i, Eigen::Vector3d(i == 0 ? 0.0 : random.uniform(0.85, 1.1), 0.0, 0.0), angle);
      if (i == 1 && random.chance(0.3)) continue;  // this robot has no path: it stays where it is
      auto path = std::make_shared<RobotPath>();
      path->robot = arms.robots[i]->name;
      path->joints = {"shoulder"};
      path->positions = {angle};
      path->times = {kNow};
      for (int points = random.between(1, 4); points > 0; --points) {
        path->positions.push_back(random.uniform(-3.0, 3.0));
        path->times.push_back(path->times.back() + std::chrono::milliseconds(random.between(1000, 4000)));
      }
      paths.push_back(path);
    }
    for (int i = random.between(0, 2); i > 0; --i) {
      const double angle = random.uniform(-M_PI, M_PI), away = random.uniform(0.35, 0.9);
      arms.addSphere(away * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
    }
    const std::vector<PathAnswer> answers = arms.check(paths);
    ASSERT_EQ(answers.size(), paths.size());
    for (std::size_t i = 0; i < paths.size(); ++i) {
      SCOPED_TRACE("path " + std::to_string(i));
      const PathAnswer& answer = answers[i];
      double least = 1e9, first = kAhead;  // [s] first: when the gap is for the first time surely less than 0
      for (int ms = 0; ms <= int(1000.0 * kAhead); ++ms) {
        const double gap = arms.gapAt(i, paths, kNow + std::chrono::milliseconds(ms));
        if (gap < -kDoubt && least >= -kDoubt) first = ms / 1000.0;
        least = std::min(least, gap);
      }
      if (std::abs(least) <= kDoubt) continue;  // the samples cannot tell
      ASSERT_EQ(answer.verdict, least > 0.0 ? Verdict::clear : Verdict::hit) << least << " m: " << answer.reason;
      ASSERT_EQ(answer.conflict.has_value(), least < 0.0);
      if (!answer.conflict) {
        ++clear;
        EXPECT_DOUBLE_EQ(answer.free_for, kAhead);
        continue;
      }
      ++hits;
      const PathConflict& conflict = *answer.conflict;
      const double at = seconds(conflict.at - kNow);
      of_two += conflict.second.rfind("robot", 0) == 0 ? 1 : 0;
      EXPECT_EQ(conflict.first.rfind(paths[i]->robot + "/", 0), 0u) << conflict.first;
      EXPECT_LE(answer.free_for, at + 1e-9);
      const Eigen::Vector3d hand = arms.handAt(i, paths, conflict.at);
      if (arms.gapAt(i, paths, kNow) <= 0.0) {  // it is in contact from the beginning
        EXPECT_LE(at, 0.1);
        EXPECT_LE((hand - arms.handAt(i, paths, kNow)).norm(), kDoubt);
        continue;
      }
      ++between;
      EXPECT_LE(at, first);
      EXPECT_GE(answer.free_for, at - 0.1);
      EXPECT_LE(std::abs(arms.gapAt(i, paths, conflict.at)), kDoubt);
      const Eigen::Vector3d& point = conflict.contact.point;
      EXPECT_LE(std::min((point - hand).norm(), (point - arms.bases[i]).norm()), kRadius + kDoubt);
      EXPECT_NEAR(conflict.contact.normal.norm(), 1.0, 1e-9);
      EXPECT_GE(conflict.contact.depth, 0.0);
    }
  }
  EXPECT_GT(hits, rounds / 2);
  EXPECT_GT(clear, rounds / 10);
  EXPECT_GT(of_two, rounds / 10);
  EXPECT_GT(between, rounds / 4);
}

/// Claim: if one robot is not on its path, nobody knows where it will be, so no path is clear.
TEST(CheckPaths, LeavesAllUnknownIfARobotIsNotOnItsPath) {
  Arms arms(2);
  RobotPaths paths;
  for (std::size_t i = 0; i < 2; ++i) {
    arms.stand(i, Eigen::Vector3d(5.0 * double(i), 0.0, 0.0), 0.0);
    auto path = std::make_shared<RobotPath>();
    path->robot = arms.robots[i]->name;
    path->joints = {"shoulder"};
    path->positions = {i == 0 ? 0.0 : 0.2, 1.0};
    path->times = {kNow, kNow + std::chrono::seconds(1)};
    paths.push_back(path);
  }
  const std::vector<PathAnswer> answers = arms.check(paths);
  ASSERT_EQ(answers.size(), 2u);
  for (const PathAnswer& answer : answers) {
    EXPECT_EQ(answer.verdict, Verdict::unknown);
    EXPECT_NE(answer.reason.find("'robot1'"), std::string::npos) << answer.reason;
    EXPECT_EQ(answer.free_for, 0.0);
  }
}

/// An arm whose limits allow two turns stands at -2.78 rad, or at 3.5 rad, which looks the same on tf. Its path goes to
/// 3.5 rad. A sphere is in the way from -2.78 rad.
class Turns : public ::testing::Test {
 protected:
  Turns() : arms_(1, withLimits(kArm, "-6.28", "6.28")) {
    arms_.stand(0, Eigen::Vector3d::Zero(), kLooks);
    arms_.addSphere({kReach, 0.0, 0.0});
  }
  static std::string withLimits(std::string urdf, const std::string& lower, const std::string& upper) {
    urdf.replace(urdf.find("lower='-3'"), 10, "lower='" + lower + "'");
    return urdf.replace(urdf.find("upper='3'"), 9, "upper='" + upper + "'");
  }
  /// Passes a message of joint states.
  void tell(double position, const std::string& joint = "shoulder", Time stamp = kNow,
            const std::string& topic = "robot0/joint_states") {
    moveit::JointState message;
    message.header.stamp.fromNSec(std::uint64_t(stamp.count()));
    message.name = {"other", joint};
    message.position = {0.0, position};
    arms_.joint_states.take(topic, message, kNow);
  }
  /// Returns the answer for a path that begins where the arm is now.
  PathAnswer answer() {
    arms_.tick.snapshot = arms_.scene.commit(kNow, {});
    const LoadedRobot& robot = *arms_.robots[0];
    const TransformLookup lookup(arms_.transforms);
    RobotPath path;
    path.robot = robot.name;
    path.joints = {"shoulder"};
    path.positions = {3.5};
    path.times = {kNow + std::chrono::seconds(5)};
    const GuardedJoints joints = guardedJoints(robot, arms_.tick, lookup, arms_.joint_states);
    addStart(path, kNow, kNow, robot, joints.values, nullptr);
    return arms_.check({std::make_shared<const RobotPath>(path)}).front();
  }
  static constexpr double kLooks = 3.5 - 2.0 * M_PI;

  Arms arms_;
};

/// Claim: without joint states, every turn that the limits allow is possible, so the path is not clear.
TEST_F(Turns, AreNotKnownFromTfAlone) {
  EXPECT_NE(answer().verdict, Verdict::clear);
  EXPECT_NE(answer().free_for, kAhead);
  Arms free(1, withLimits(kArm, "-6.28", "6.28"));
  free.stand(0, Eigen::Vector3d::Zero(), 3.5);
  RobotPath path;
  path.robot = "robot0";
  path.joints = {"shoulder"};
  path.positions = {3.5};
  path.times = {kNow};
  const PathAnswer unknown = free.check({std::make_shared<const RobotPath>(path)}).front();
  EXPECT_EQ(unknown.verdict, Verdict::unknown);
  EXPECT_NE(unknown.reason.find("'robot0/joint_states'"), std::string::npos) << unknown.reason;
}

/// Claim: joint states tell the turn.
TEST_F(Turns, AreToldByJointStates) {
  tell(3.5);
  EXPECT_EQ(answer().verdict, Verdict::clear) << answer().reason;
  tell(kLooks);
  EXPECT_EQ(answer().verdict, Verdict::hit);
}

/// Claim: joint states of another time, another robot or another joint, and those that are not finite, tell nothing.
TEST_F(Turns, AreNotToldByOtherMessages) {
  tell(3.5, "shoulder", kNow - std::chrono::seconds(1));
  EXPECT_NE(answer().verdict, Verdict::clear) << "too old";
  tell(3.5, "elbow");
  EXPECT_NE(answer().verdict, Verdict::clear);
  tell(1.0);
  EXPECT_NE(answer().verdict, Verdict::clear) << "tf shows another angle, so it is another robot";
  tell(3.5, "shoulder", kNow, "joint_states");
  EXPECT_NE(answer().verdict, Verdict::clear) << "another topic";
  tell(3.5);
  EXPECT_EQ(answer().verdict, Verdict::clear);
  tell(NAN);
  EXPECT_NE(answer().verdict, Verdict::clear);
}

/// Claim: limits of less than a turn tell the turn.
TEST_F(Turns, AreKnownIfTheLimitsAllowOnlyOne) {
  Arms arms(1, withLimits(kArm, "0", "6"));
  arms.stand(0, Eigen::Vector3d::Zero(), 3.5);
  RobotPath path;
  path.robot = "robot0";
  path.joints = {"shoulder"};
  path.positions = {3.5};
  path.times = {kNow};
  EXPECT_EQ(arms.check({std::make_shared<const RobotPath>(path)}).front().verdict, Verdict::clear);
}

TEST(JointStatesTopic, IsWhereTheDescriptionIs) {
  const auto topic = [](const std::string& description, const std::string& prefix, const std::string& given = {}) {
    RobotParams params;
    params.description = description;
    params.tf_prefix = prefix;
    params.joint_states = given;
    return jointStatesTopic(params);
  };
  EXPECT_EQ(topic("robot_description", ""), "joint_states");
  EXPECT_EQ(topic("/robot_description", ""), "/joint_states");
  EXPECT_EQ(topic("left/robot_description", "l"), "left/joint_states");
  EXPECT_EQ(topic("/left/robot_description", ""), "/left/joint_states");
  EXPECT_EQ(topic("robot_description", "left"), "left/joint_states");
  EXPECT_EQ(topic("left/robot_description", "left", "states"), "states");
}

/// Claim: a joint that no path moves must rest, as tf shows; if tf does not show it, nobody knows.
TEST(UnplannedMotion, IsSeenOnTf) {
  const auto motion = [](std::optional<double> before, double now, const std::vector<std::string>& joints = {}) {
    Arms arms(1);
    arms.stand(0, Eigen::Vector3d::Zero(), now, before);
    arms.tick.snapshot = arms.scene.commit(kNow, {});
    RobotPath path;
    path.robot = "robot0";
    path.joints = joints;
    return unplannedMotionOf(path, *arms.robots[0], arms.tick, TransformLookup(arms.transforms));
  };
  EXPECT_EQ(motion(0.5, 0.5), "");
  EXPECT_EQ(motion(0.5, 0.509), "") << "noise of a sensor";
  EXPECT_NE(motion(0.5, 0.52).find("'shoulder' of robot 'robot0' has no path, but it moves"), std::string::npos);
  EXPECT_NE(motion(std::nullopt, 0.5).find("tf does not tell"), std::string::npos);
  EXPECT_EQ(motion(0.5, 1.5, {"shoulder"}), "");
}

/// Claim: while a joint that has no path moves, no path is clear.
TEST(CheckPaths, IsUnknownWhileAJointWithoutPathMoves) {
  for (const double before : {0.0, -0.5}) {
    Arms arms(2);
    arms.stand(0, Eigen::Vector3d::Zero(), 0.0, before);
    arms.stand(1, Eigen::Vector3d(5.0, 0.0, 0.0), 0.0);
    auto none = std::make_shared<RobotPath>(), rests = std::make_shared<RobotPath>();
    none->robot = "robot0";
    none->times = {kNow};
    rests->robot = "robot1";
    rests->joints = {"shoulder"};
    rests->positions = {0.0};
    rests->times = {kNow};
    const std::vector<PathAnswer> answers = arms.check({none, rests});
    for (const PathAnswer& answer : answers) {
      EXPECT_EQ(answer.verdict, before == 0.0 ? Verdict::clear : Verdict::unknown) << answer.reason;
    }
  }
}

}  // namespace
}  // namespace hgrid
