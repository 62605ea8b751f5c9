// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares bounds of motion with how far points of shapes move.
#include "queries/states/motion_bounds.h"

#include <gtest/gtest.h>

#include "test/queries/states/edge_worlds.h"

namespace hgrid {
namespace {

using namespace test;

/// The corners of a shape's box, in the frame of its rigid group.
std::vector<Eigen::Vector3d> cornersOf(const RobotShape& shape) {
  const Eigen::AlignedBox3d box =
      inDouble(boxOf(shape.what->shape, Pose::Identity(), shape.what->padding, Eigen::Vector3d::Zero()));
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(shape.group_from_shape * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));
  }
  return corners;
}

/// Where the corners of all shapes are, at some places of an edge.
class Corners {
 public:
  Corners(const StateWorld& world, const RobotShapes& robot, const EdgeOracle& edge, double place) {
    const Kinematics kinematics = world.kinematics();
    const JointOracle joints(world.model, kinematics, edge.at(place));
    for (const RobotShape& shape : robot.shapes()) {
      const Pose pose = joints.rootFromLink(int(kinematics.state().groups[shape.group].link));
      points_.emplace_back();
      for (const Eigen::Vector3d& corner : cornersOf(shape)) points_.back().push_back(pose * corner);
    }
  }
  /// Returns the largest distance of a corner of a shape from where it is in other corners [m].
  double wayOf(std::size_t shape, const Corners& other) const {
    double longest = 0.0;
    for (std::size_t i = 0; i < 8; ++i) {
      longest = std::max(longest, (points_[shape][i] - other.points_[shape][i]).norm());
    }
    return longest;
  }
  /// Returns how much the distance between a corner of one shape and a corner of another differs at most [m].
  double changeOf(const SelfPair& pair, const Corners& other) const {
    double largest = 0.0;
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < 8; ++b) {
        const double before = (points_[pair.first][a] - points_[pair.second][b]).norm();
        const double after = (other.points_[pair.first][a] - other.points_[pair.second][b]).norm();
        largest = std::max(largest, std::abs(after - before));
      }
    }
    return largest;
  }

 private:
  std::vector<std::vector<Eigen::Vector3d>> points_;  // by shape and corner
};

/// A robot, an edge, and the bounds of the parts of the edge.
struct Bounded {
  Bounded(const StateWorld& world, const RobotShapes& shapes, const EdgeOracle& tested)
      : kinematics(world.kinematics()), robot(shapes), bounds(kinematics, robot), edge(tested) {
    std::vector<FourDoubles> from, to, difference;
    for (std::size_t k = 0; k < kinematics.variables().size(); ++k) {
      from.push_back(fourDoubles(edge.at(0)[k]));
      to.push_back(fourDoubles(edge.at(1)[k]));
      difference.push_back(fourDoubles(edge.at(1)[k] - edge.at(0)[k]));
    }
    largest = double{bounds.find(from, to, difference, 2, memory)};
  }
  /// Computes the bounds for a part. The origin of the boxes is somewhere.
  void findPart(double middle, double half) {
    std::vector<FourDoubles> values;
    for (const double value : edge.at(middle)) values.push_back(fourDoubles(value));
    GroupPoses groups;
    std::vector<FourShapes> placed(robot.shapes().size());
    const Eigen::Vector3d origin(0.3, -2.0, 1.0);
    forwardKinematics(kinematics, values, Pose::Identity(), nullptr, groups);
    robot.place(groups.in_world, nullptr, origin, placed);
    for (std::size_t i = 0; i < placed.size(); ++i)
      bounds.findPart(i, {groups.in_world, placed, origin, 1, half}, memory);
  }

  const Kinematics kinematics;
  const RobotShapes& robot;
  const MotionBounds bounds;
  const EdgeOracle& edge;
  MotionBounds::Memory memory;
  double largest = 0.0;
};

/// How much of the bounds the motion uses, at most.
struct Use {
  int count = 0;
  double most = 0.0;

  void add(double way, double bound) {
    if (way < 1e-6) return;
    ++count;
    most = std::max(most, way / bound);
  }
};

/// Claim: within a part, no point moves farther from where it is in the middle of the part than the bound. If one joint
/// turns one link, the bound is nearly exact.
TEST(MotionBounds, NoPointMovesFartherAndNoDistanceChangesMore) {
  constexpr int kSteps = 20;
  Use shapes, pairs;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.links = random.between(2, 7);
    plan.obstacles = 0;
    const StateWorld world = randomStateWorld(random, plan);
    if (world.kinematics().variables().empty()) continue;
    const RobotShapes robot(*world.snapshot, world.kinematics(), "robot", {}, {});
    const RandomEdges edges(random, world.checker(), world.model, 2);
    for (std::size_t i = 0; i < edges.edges.size(); ++i) {
      Bounded bounded(world, robot, edges.oracle(i));
      const double half = random.chance(0.3) ? 0.5 : random.chance(0.5) ? 0.01 : random.uniform(0.001, 0.5);
      const double middle = random.uniform(half, 1.0 - half);
      bounded.findPart(middle, half);
      const Corners center(world, robot, bounded.edge, middle);
      for (int step = -kSteps; step <= kSteps; ++step) {
        const Corners moved(world, robot, bounded.edge, middle + half * step / kSteps);
        for (std::size_t k = 0; k < robot.shapes().size(); ++k) {
          const double way = center.wayOf(k, moved), bound = double{bounded.bounds.reachOf(k, bounded.memory)};
          ASSERT_LE(way, bound + 1e-9) << "shape " << k;
          ASSERT_LE(bound, bounded.largest * half * 1.001);
          shapes.add(way, bound);
        }
        for (std::size_t k = 0; k < robot.selfPairs().size(); ++k) {
          const double change = center.changeOf(robot.selfPairs()[k], moved);
          const double bound = double{bounded.bounds.reachOfPair(k, bounded.memory)};
          ASSERT_LE(change, bound + 1e-9) << "pair " << k;
          ASSERT_LE(bound, bounded.largest * half * 1.001);
          pairs.add(change, bound);
        }
      }
    }
  }
  EXPECT_GT(shapes.count, 10000);
  EXPECT_GT(pairs.count, 10000);
  EXPECT_GT(shapes.most, 0.99);
  EXPECT_GT(pairs.most, 0.8);
}

}  // namespace
}  // namespace hgrid
