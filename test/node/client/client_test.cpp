// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The C++ client beside a running node with two obstacles.
#include "hgrid_proximity/client/client.h"

#include <gtest/gtest.h>
#include <hgrid_proximity/CodeNames.h>
#include <hgrid_proximity/ObstacleOperation.h>
#include <hgrid_proximity/RobotOperation.h>
#include <hgrid_proximity/ShapeKind.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <future>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "test/node/support/claims.h"
#include "test/node/support/node_under_test.h"
#include "test/node/support/values.h"

namespace hgrid {
namespace test {
namespace {

using hgrid_proximity::Client;
using hgrid_proximity::NoAnswer;
using hgrid_proximity::Refused;
using Clock = std::chrono::steady_clock;

class TheClient : public ::testing::Test {
 protected:
  TheClient() : node_(setup()), client_(node_.space() + "/proximity", std::chrono::seconds(20)) {
    node_.waitForTicks(2);
  }

  static NodeSetup setup() {
    NodeSetup setup;
    setup.params = dict({{"world_frame", "world"},
                         {"obstacles", list({ball("low", 0, 0, 0, 0.1), ball("high", 0, 0, 2, 0.1)})},
                         {"robots", list({dict({{"name", "none"}, {"description", "robot_description"}})})}});
    return setup;
  }
  static msg::QuerySphereRequest sphere(double z) {
    msg::QuerySphereRequest request;
    request.center.z = z;
    request.include = {"obstacle/*"};  // the robot is missing, so other questions cannot be answered with CLEAR
    return request;
  }
  template <class Response>
  static std::vector<std::string> names(const Response& response) {
    std::vector<std::string> names;
    for (const msg::Hit& hit : response.answer.hits) names.push_back(hit.name);
    return names;
  }

  NodeUnderTest node_;
  Client client_;
};

TEST_F(TheClient, AnswersEachKindOfQuestion) {
  const std::vector<std::string> low{"obstacle/low"}, both{"obstacle/low", "obstacle/high"};
  EXPECT_EQ(names(client_.ask(sphere(0))), low);
  EXPECT_TRUE(isHit(client_.ask(sphere(0)).answer));
  EXPECT_TRUE(isClear(client_.ask(sphere(1)).answer));

  msg::QuerySegmentRequest segment;
  segment.start.z = -3.0;
  segment.end.z = 3.0;
  EXPECT_EQ(names(client_.ask(segment)), both);

  msg::QueryBoxRequest box;
  box.size.x = box.size.y = box.size.z = 0.1;
  EXPECT_EQ(names(client_.ask(box)), low);

  msg::QueryShapeRequest shape;
  shape.shape.kind = msg::ShapeKind::SPHERE;
  shape.shape.dimensions = {0.1};
  EXPECT_EQ(names(client_.ask(shape)), low);

  msg::QueryNearestRequest nearest;
  nearest.point.z = 0.5;
  nearest.limit = 2;
  EXPECT_EQ(names(client_.ask(nearest)), both);

  msg::ExplainPairRequest explain;
  explain.first = "obstacle/low";
  explain.second = "obstacle/high";
  EXPECT_FALSE(client_.ask(explain).explanation.empty());
}

TEST_F(TheClient, ChangesObstacles) {
  msg::ApplyObstaclesRequest request;
  request.changes.resize(1);
  msg::Obstacle& change = request.changes[0];
  change.operation = msg::ObstacleOperation::MOVE;
  change.name = "high";
  change.pose.position.z = 1.0;
  EXPECT_EQ(client_.apply(request).code.value, msg::CodeNames::OK);
  EXPECT_EQ(names(client_.ask(sphere(1))), std::vector<std::string>{"obstacle/high"});
  EXPECT_TRUE(isClear(client_.ask(sphere(2)).answer));
  change.name = "absent";
  try {
    client_.apply(request);
    ADD_FAILURE() << "the change must be refused";
  } catch (const Refused& refused) {
    EXPECT_EQ(refused.code.value, msg::CodeNames::UNKNOWN_ID);
  }
}

TEST_F(TheClient, ChangesRobots) {
  msg::ApplyRobotsRequest request;
  request.changes.resize(1);
  request.changes[0].operation = msg::RobotOperation::ABSENT;
  request.changes[0].names = {"none"};
  EXPECT_TRUE(client_.apply(request).world.complete) << "the robot that is not loaded is not waited for any more";
  request.changes[0].operation = msg::RobotOperation::PRESENT;
  EXPECT_FALSE(client_.apply(request).world.complete);
  request.changes[0].names = {"nobody"};
  EXPECT_THROW(client_.apply(request), Refused);
}

TEST_F(TheClient, NeitherHitNorClearIsUnknown) {
  msg::QuerySphereRequest anywhere = sphere(1);
  anywhere.include.clear();
  const msg::Answer answer = client_.ask(anywhere).answer;
  EXPECT_FALSE(isHit(answer) || isClear(answer)) << answer.summary;
  msg::WorldState world;
  world.valid_until = ros::Time::now() + ros::Duration(60.0);
  EXPECT_FALSE(isUsable(world));
  world.complete = true;
  EXPECT_TRUE(isUsable(world));
  world.valid_until = ros::Time::now() - ros::Duration(1.0);
  EXPECT_FALSE(isUsable(world));
}

TEST_F(TheClient, ThrowsTheReasonOfARefusal) {
  msg::QuerySphereRequest nowhere = sphere(0);
  nowhere.header.frame_id = "nowhere";
  try {
    client_.ask(nowhere);
    FAIL() << "it is not refused";
  } catch (const Refused& refused) {
    EXPECT_EQ(refused.code.value, msg::CodeNames::UNKNOWN_FRAME);
    EXPECT_TRUE(says(refused.what(), "nowhere"));
  }
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), -1.0}) {
    msg::QuerySphereRequest request = sphere(0);
    request.max_time = wrong;
    EXPECT_THROW(client_.ask(request), Refused) << wrong;
  }
  EXPECT_THROW(client_.ask(msg::ExplainPairRequest()), Refused);
  msg::QuerySphereRequest unlimited = sphere(0);
  unlimited.max_time = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(isHit(client_.ask(unlimited).answer));
}

TEST_F(TheClient, ThrowsIfThereIsNoNode) {
  for (const double wrong : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), 1e7}) {
    EXPECT_THROW(Client("any", std::chrono::duration<double>(wrong)), std::invalid_argument) << wrong;
  }
  Client absent(node_.space() + "/absent", std::chrono::milliseconds(200));
  try {
    absent.ask(sphere(0));
    FAIL() << "there is an answer";
  } catch (const NoAnswer& error) {
    EXPECT_TRUE(says(error.what(), "/absent/query_sphere does not exist. Check the node: `rosnode ping "))
        << error.what();
  }
}

/// Claim: a node that hangs costs the caller no more than the time limit, with an open connection and with a new one.
/// When the node works again, so does the same client.
TEST_F(TheClient, ThrowsInTimeIfTheNodeHangs) {
  Client hasty(node_.space() + "/proximity", std::chrono::seconds(2));
  const auto hits = [&] {
    try {
      return isHit(hasty.ask(sphere(0)).answer);
    } catch (const NoAnswer&) {
      return false;
    }
  };
  const auto hitsSoon = [&] {
    for (int i = 0; i < 10; ++i) {
      if (hits()) return true;
    }
    return false;
  };
  EXPECT_TRUE(hitsSoon());
  ASSERT_EQ(kill(node_.process().pid(), SIGSTOP), 0);
  siginfo_t stopped;  // waitid() returns when all threads of the node have stopped
  ASSERT_EQ(waitid(P_PID, static_cast<id_t>(node_.process().pid()), &stopped, WSTOPPED), 0);
  const auto begin = Clock::now();
  for (int i = 0; i < 3; ++i) EXPECT_THROW(hasty.ask(sphere(0)), NoAnswer);
  EXPECT_LT(Clock::now() - begin, std::chrono::seconds(20));
  ASSERT_EQ(kill(node_.process().pid(), SIGCONT), 0);
  EXPECT_TRUE(hitsSoon());
}

TEST_F(TheClient, MayBeSharedByThreads) {
  std::vector<std::future<int>> wrong;
  for (const auto& [z, hit] : {std::pair(0.0, true), std::pair(1.0, false), std::pair(2.0, true)}) {
    wrong.push_back(std::async(std::launch::async, [this, z = z, hit = hit] {
      int count = 0;
      for (int i = 0; i < 100; ++i) count += isHit(client_.ask(sphere(z)).answer) != hit;
      return count;
    }));
  }
  for (auto& each : wrong) EXPECT_EQ(each.get(), 0);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
