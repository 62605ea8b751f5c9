// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A fault of the node's own: whoever asked hears INTERNAL, nothing is changed, and the node goes on.
#include <hgrid_proximity/Distances.h>
#include <ros/param.h>
#include <ros/topic.h>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// Two balls that touch; the narrow phase throws while a fault is set.
class Faults : public ::testing::Test {
 protected:
  Faults() : node_(setup()) {
    transforms_.stream("base", "a", at(0));
    transforms_.stream("base", "b", at(0.15));
    node_.waitForComplete();
  }
  ~Faults() override { EXPECT_TRUE(node_.process().alive()); }
  static NodeSetup setup() {
    NodeSetup setup;
    setup.command = {HGRID_FAULTS_NODE};
    setup.beside["robot_description"] = description({"a", "b"});
    return setup;
  }
  static std::string description(const std::vector<std::string>& names) {
    std::string content = link("base", sphereOf(0.1, "0 0 -5"));
    for (const std::string& name : names) content += link(name, sphereOf(0.1)) + joint("base", name);
    return urdf(content);
  }
  /// @param function  of the narrow phase; empty: none
  void breakDown(const std::string& function) { ros::param::set(node_.named("fault"), function); }
  msg::QuerySphere::Response exactSphere() {
    msg::QuerySphere::Request request;
    request.radius = 0.05;
    request.exact = true;
    return node_.ask(request);
  }
  std::uint64_t counted(const std::string& name) {
    node_.waitForTicks(2);
    return counter(*node_.heard().status.back(), name);
  }

  TransformSource transforms_;
  NodeUnderTest node_;
};

TEST_F(Faults, InAQueryAreSaidToWhoAskedAndNobodyElse) {
  ASSERT_EQ(exactSphere().answer.verdict, msg::Answer::HIT);
  breakDown("measure");
  const auto answer = exactSphere().answer;
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.code.value, msg::Code::INTERNAL);
  EXPECT_TRUE(says(answer.code.text, "a fault in measure"));
  EXPECT_EQ(answer.verdict, msg::Answer::UNKNOWN);
  EXPECT_EQ(answer.unknown_because, msg::Answer::REFUSED);
  EXPECT_TRUE(answer.hits.empty());
  EXPECT_GE(counted("query.failed.INTERNAL"), 1u);
  EXPECT_EQ(node_.sphere(0, 0, 0, 0.05).answer.verdict, msg::Answer::HIT) << "by boxes all is well";
  breakDown("");
  EXPECT_EQ(exactSphere().answer.verdict, msg::Answer::HIT);
}

TEST_F(Faults, InAnExplanationAreSaidToWhoAsked) {
  breakDown("measure");
  const auto response = node_.explain("robot/a", "robot/b");
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.code.value, msg::Code::INTERNAL);
  breakDown("contacts");
  EXPECT_TRUE(node_.explain("robot/a", "robot/b").success) << "no contacts were asked for";
  EXPECT_EQ(node_.explain("robot/a", "robot/b", 5).code.value, msg::Code::INTERNAL);
  breakDown("");
  EXPECT_TRUE(node_.explain("robot/a", "robot/b", 5).success);
}

TEST_F(Faults, InATickAreCountedAndPairsGoOn) {
  const auto next = [&](double patience) {
    return ros::topic::waitForMessage<msg::Distances>(node_.named("distances"), ros::Duration(patience));
  };
  ASSERT_TRUE(next(20.0));
  breakDown("measure");
  transforms_.stream("base", "b", at(0.16));  // what does not move is not measured again
  EXPECT_FALSE(next(1.0));
  const std::size_t pairs = node_.heard().pairs.size();
  EXPECT_GE(counted("tick.failed.INTERNAL"), 1u);
  EXPECT_GT(node_.heard().pairs.size(), pairs);
  EXPECT_EQ(node_.heard().pairs.back()->first.size(), 1u);
  breakDown("");
  EXPECT_TRUE(next(20.0));
}

TEST_F(Faults, InAReloadLeaveTheOldModel) {
  node_.setBeside("robot_description", description({"a"}));
  breakDown("solidOf");
  const auto refused = node_.reload("robot");
  EXPECT_FALSE(refused.success);
  EXPECT_EQ(refused.code.value, msg::Code::INTERNAL);
  EXPECT_TRUE(says(refused.code.text, "a fault in solidOf"));
  node_.waitForTicks(2);
  EXPECT_EQ(node_.heard().status.back()->body_count, 3u);
  EXPECT_TRUE(node_.heard().status.back()->world.complete);
  breakDown("");
  ASSERT_TRUE(node_.reload("robot").success);
  node_.waitForTicks(2);
  EXPECT_EQ(node_.heard().status.back()->body_count, 2u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
