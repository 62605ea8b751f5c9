// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Runs the node with UR5, Panda and PR2 at once, with the real robot_state_publisher and tf. An independent brute force
// reference must find the same pairs and the same hits of queries as the node.
#include "test/support/robots.h"

#include <gtest/gtest.h>
#include <hgrid_proximity/Bodies.h>
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/Status.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/ros.h>

#include <cstdio>
#include <cstdlib>
#include <limits>

#include "robots_cell.h"

namespace hgrid {
namespace test {
namespace {

using hgrid_proximity::Hit;
using hgrid_proximity::WorldState;

constexpr double kTolerance = 1e-5;  // [m] covers rounding to float, and quaternions in tf messages

class Robots : public RobotsTest {
 protected:
  /// Chooses a random state of all joints. Waits until the node uses it: all poses are FRESH and newer than the state.
  void holdAnother() {
    const ros::Time from = cell_->puppeteer->holdAnother() + ros::Duration(0.2);
    near_ = cell_->pairs->waitFor(
        [&](const hgrid_proximity::Pairs& pairs) {
          return pairs.header.stamp >= from && pairs.world.worst_state == hgrid_proximity::BodyState::FRESH;
        },
        kPatience);
    ASSERT_TRUE(near_) << "no tick had FRESH poses of all links within 30 s";
    EXPECT_TRUE(near_->world.complete);
    frames_ = {{"world", Eigen::Isometry3d::Identity()}};
    bodies_.clear();
    for (const Robot& robot : cell_->robots) {
      const auto poses = robot.witness->posesAt(cell_->puppeteer->positions(robot.name), robot.worldFromRoot());
      for (const auto& named : poses) frames_[robot.name + "/" + named.first] = named.second;
      for (const auto& named : robot.witness->bodiesAt(poses)) bodies_[robot.name + "/" + named.first] = named.second;
    }
  }

  bool mayTouch(const std::string& a, const std::string& b) const {
    for (const Robot& robot : cell_->robots) {
      const std::string source = robot.name + "/";
      if (a.rfind(source, 0) != 0 || b.rfind(source, 0) != 0) continue;
      return robot.witness->mayTouch(a.substr(source.size()), b.substr(source.size()));
    }
    return false;
  }

  /// Moves each face of the boxes of a body outward by `by` [m]. Returns the smallest `measure(box)` of these boxes.
  template <class Measure>
  static double least(const WitnessBody& body, double by, Measure&& measure) {
    double result = std::numeric_limits<double>::infinity();
    for (const WitnessBox& box : body) result = std::min(result, measure(grown(box, by)));
    return result;
  }
  static double gapOf(const WitnessBody& a, const WitnessBody& b) {
    return least(a, 0.0,
                 [&](const WitnessBox& x) { return least(b, 0.0, [&](const WitnessBox& y) { return gap(x, y); }); });
  }

  void comparePairs();
  template <class Measure>
  void compareAnswer(const hgrid_proximity::Answer& answer, double limit, double Hit::*member, Measure&& measure);
  template <class Query>
  void ask(const std::string& service, Query& query);
  void askSphere(const std::string& frame);
  void askSegment(const std::string& frame, double radius);
  Eigen::Vector3d somewhere() { return {random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-0.5, 1)}; }

  Random random_{11};
  hgrid_proximity::PairsConstPtr near_;
  std::map<std::string, Eigen::Isometry3d> frames_;  // world_from_frame: the pose in the world frame, by frame
  std::map<std::string, WitnessBody> bodies_;
  std::size_t pairs_seen_ = 0, pairs_of_two_robots_ = 0, hits_seen_ = 0;
};

void Robots::comparePairs() {
  std::map<std::pair<std::string, std::string>, double> told;
  for (std::size_t i = 0; i < near_->first.size(); ++i) {
    const std::string &a = near_->names.at(near_->first[i]), &b = near_->names.at(near_->second[i]);
    EXPECT_LT(a, b);
    EXPECT_TRUE(told.emplace(std::make_pair(a, b), near_->gap[i]).second) << a << " " << b << " is listed twice";
    pairs_of_two_robots_ += a.substr(0, a.find('/')) != b.substr(0, b.find('/'));
  }
  pairs_seen_ += told.size();
  EXPECT_EQ(near_->total, told.size());
  EXPECT_FALSE(near_->truncated);
  for (auto a = bodies_.begin(); a != bodies_.end(); ++a) {
    for (auto b = std::next(a); b != bodies_.end(); ++b) {
      SCOPED_TRACE(a->first + " with " + b->first);
      const auto found = told.find({a->first, b->first});
      const double gap = gapOf(a->second, b->second);
      if (mayTouch(a->first, b->first) || gap > kMargin + kTolerance) {
        EXPECT_EQ(found, told.end()) << "gap " << gap;
      } else if (found != told.end()) {
        EXPECT_NEAR(found->second, gap, kTolerance);
      } else {
        EXPECT_GT(gap, kMargin - kTolerance) << "the pair is missing";
      }
    }
  }
  for (const auto& named : told) {
    EXPECT_EQ(bodies_.count(named.first.first) + bodies_.count(named.first.second), 2u)
        << "a pair names a body that is not in the URDFs";
  }
}

/// Compares the hits of a query with a brute force search over the boxes of the witness (the reference). Makes the
/// boxes a little smaller and a little larger to allow for rounding.
/// @param limit   [m] a body is hit if `measure(box)` is at most this for one of its boxes
/// @param member  field of Hit that must equal the least `measure(box)` of the body
template <class Measure>
void Robots::compareAnswer(const hgrid_proximity::Answer& answer, double limit, double Hit::*member,
                           Measure&& measure) {
  ASSERT_TRUE(answer.success) << answer.code.text;
  EXPECT_FALSE(answer.truncated);
  EXPECT_EQ(answer.total, answer.hits.size());
  EXPECT_EQ(answer.verdict, answer.hits.empty() ? hgrid_proximity::Verdict::CLEAR : hgrid_proximity::Verdict::HIT);
  std::map<std::string, const Hit*> told;
  for (std::size_t i = 0; i < answer.hits.size(); ++i) {
    const Hit& hit = answer.hits[i];
    EXPECT_TRUE(told.emplace(hit.name, &hit).second) << hit.name << " is listed twice";
    EXPECT_EQ(hit.distance, 0.0) << hit.name;
    EXPECT_LE(answer.hits[i == 0 ? 0 : i - 1].*member, hit.*member) << "hits are not sorted";
  }
  hits_seen_ += told.size();
  for (const auto& named : bodies_) {
    SCOPED_TRACE(named.first);
    const double at_least = least(named.second, kTolerance, measure),
                 at_most = least(named.second, -kTolerance, measure);
    const auto found = told.find(named.first);
    if (found == told.end()) {
      EXPECT_GT(at_most, limit) << "the hit is missing";
      continue;
    }
    EXPECT_LE(at_least, limit) << "the hit body is too far away";
    EXPECT_GE(found->second->*member, at_least - kTolerance);
    EXPECT_LE(found->second->*member, at_most + kTolerance);
    EXPECT_LT(found->second->shape, named.second.size());
  }
}

/// Calls a service. Tries again up to nine times, because a busy machine delays ticks and the answer is then UNKNOWN.
/// Also, roscpp sometimes loses a call.
template <class Query>
void Robots::ask(const std::string& service, Query& query) {
  for (int i = 0; i < 10; ++i) {
    const bool answered = ros::service::call(service, query);
    if (answered && query.response.answer.verdict != hgrid_proximity::Verdict::UNKNOWN) return;
  }
}

void Robots::askSphere(const std::string& frame) {
  hgrid_proximity::QuerySphere query;
  query.request.header.frame_id = frame;
  const Eigen::Vector3d center = somewhere();
  query.request.center.x = center.x();
  query.request.center.y = center.y();
  query.request.center.z = center.z();
  query.request.radius = random_.uniform(0.0, 0.5);
  SCOPED_TRACE("a sphere in " + frame);
  ask("/proximity/query_sphere", query);
  EXPECT_TRUE(query.response.world.complete);
  EXPECT_EQ(query.response.header.frame_id, frame);
  const Eigen::Vector3d in_world = frames_.at(frame) * center;
  compareAnswer(query.response.answer, query.request.radius, &Hit::center_distance,
                [&](const WitnessBox& box) { return gap(box, in_world); });
}

void Robots::askSegment(const std::string& frame, double radius) {
  hgrid_proximity::QuerySegment query;
  query.request.header.frame_id = frame;
  const Eigen::Vector3d start = somewhere(), end = somewhere();
  query.request.start.x = start.x();
  query.request.start.y = start.y();
  query.request.start.z = start.z();
  query.request.end.x = end.x();
  query.request.end.y = end.y();
  query.request.end.z = end.z();
  query.request.radius = radius;
  SCOPED_TRACE("a segment in " + frame);
  ask("/proximity/query_segment", query);
  EXPECT_TRUE(query.response.world.complete);
  const Eigen::Vector3d from = frames_.at(frame) * start, to = frames_.at(frame) * end;
  compareAnswer(query.response.answer, (to - from).norm(), &Hit::along,
                [&](const WitnessBox& box) { return firstTouch(box, from, to, radius); });
}

TEST_F(Robots, EveryShapeIsThere) {
  const auto status = ros::topic::waitForMessage<hgrid_proximity::Status>("/proximity/status", ros::Duration(10));
  const auto bodies = ros::topic::waitForMessage<hgrid_proximity::Bodies>("/proximity/bodies", ros::Duration(10));
  ASSERT_TRUE(status && bodies);
  EXPECT_TRUE(status->world.complete);  // even though many links of the PR2 have no <collision>
  EXPECT_GT(status->without_collision.size(), 40u);
  EXPECT_TRUE(status->uncovered.empty());
  EXPECT_EQ(status->robots, 3u);
  EXPECT_EQ(status->body_count, 8u + 11u + 32u);
  EXPECT_EQ(status->shape_count, 8u + 17u + 32u);
  for (const Robot& robot : cell_->robots) {
    std::size_t count = 0, shapes = 0;
    for (const hgrid_proximity::Body& body : bodies->bodies) {
      if (body.robot != robot.name) continue;
      ++count;
      shapes += body.shapes.size();
      EXPECT_TRUE(body.covered) << body.name;
    }
    EXPECT_EQ(count, robot.bodies) << robot.name;
    EXPECT_EQ(shapes, robot.shapes) << robot.name;
    EXPECT_EQ(shapes, robot.witness->shapeCount()) << robot.name;
  }
}

TEST_F(Robots, NearPairsAndHitsAreThoseOfBruteForce) {
  for (int state = 0; state < 20; ++state) {
    SCOPED_TRACE("state " + std::to_string(state));
    ASSERT_NO_FATAL_FAILURE(holdAnother());
    comparePairs();
    for (const char* frame :
         {"world", "world", "pr2/base_footprint", "pr2/base_footprint", "ur5/tool0", "panda/panda_hand"}) {
      askSphere(frame);
      askSegment(frame, 0.0);
      askSegment(frame, random_.uniform(0.0, 0.3));
    }
  }
  std::fprintf(stderr, "%zu pairs, %zu of them between two robots; %zu hits\n", pairs_seen_, pairs_of_two_robots_,
               hits_seen_);
  EXPECT_GT(pairs_seen_, 100u);
  EXPECT_GT(pairs_of_two_robots_, 50u);
  EXPECT_GT(hits_seen_, 300u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const std::string data = hgrid::test::sharedData();
  if (!data.empty()) {  // the node then finds the meshes in the package example-robot-data
    const char* others = std::getenv("ROS_PACKAGE_PATH");
    setenv("ROS_PACKAGE_PATH", (data + ":" + (others ? others : "")).c_str(), 1);
  }
  ros::init(argc, argv, "robots_test");
  return RUN_ALL_TESTS();
}
