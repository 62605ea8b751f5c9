// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// After an internal fault of the node, the caller receives the code INTERNAL. Nothing changes, and the node goes on.
#include <hgrid_proximity/Answer.h>
#include <hgrid_proximity/CodeNames.h>
#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/UnknownReason.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/param.h>
#include <ros/service.h>
#include <ros/topic.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include "test/node/support/built.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// Two spheres that touch. While a test has set a fault, the narrow phase of the node throws.
class Faults : public ::testing::Test {
 protected:
  Faults() : node_(setup()) {
    transforms_.stream("base", "a", at(0));
    transforms_.stream("base", "b", at(0.15));
    node_.waitForComplete();
  }
  ~Faults() override { EXPECT_TRUE(node_.process().alive()); }

 public:
  static NodeSetup setup() {
    NodeSetup setup;
    setup.command = {built(HGRID_FAULTS_NODE)};
    setup.params["watch_descriptions"] = false;
    setup.beside["robot_description"] = description({"a", "b"});
    return setup;
  }

 protected:
  static std::string description(const std::vector<std::string>& names) {
    std::string content = link("base", sphereOf(0.1, "0 0 -5"));
    for (const std::string& name : names) content += link(name, sphereOf(0.1)) + joint("base", name);
    return urdf(content);
  }
  /// Makes a function of the narrow phase throw from now on.
  /// @param function  name of the function; empty: no function throws any more
  /// @param kind      type of the exception: "int", "memory" (std::bad_alloc), otherwise std::runtime_error
  void breakDown(const std::string& function, const std::string& kind = "") {
    ros::param::set(node_.named("fault_kind"), kind);
    ros::param::set(node_.named("fault"), function);
  }
  /// Waits until the status "ticks" of /diagnostics has this level and contains these words.
  void waitForTicksStatus(int level, const std::string& words) {
    node_.waitUntil("'" + words + "' of /diagnostics", [&](const Heard& all) {
      const auto found = all.diagnostics.find("ticks");
      return found != all.diagnostics.end() && found->second.level == level && says(found->second.message, words);
    });
  }
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

TEST_F(Faults, InAQueryAreReportedOnlyToTheCaller) {
  ASSERT_EQ(exactSphere().answer.verdict, msg::Verdict::HIT);
  breakDown("measure");
  const auto answer = exactSphere().answer;
  EXPECT_FALSE(answer.success);
  EXPECT_EQ(answer.code.value, msg::CodeNames::INTERNAL);
  EXPECT_TRUE(says(answer.code.text, "a fault in measure"));
  EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN);
  EXPECT_EQ(answer.unknown_because, msg::UnknownReason::REFUSED);
  EXPECT_TRUE(answer.hits.empty());
  EXPECT_GE(counted("query.failed.INTERNAL"), 1u);
  EXPECT_EQ(node_.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT) << "boxes need no narrow phase";
  breakDown("");
  EXPECT_EQ(exactSphere().answer.verdict, msg::Verdict::HIT);
}

TEST_F(Faults, InAnExplanationAreReportedToTheCaller) {
  breakDown("measure");
  const auto response = node_.explain("robot/a", "robot/b");
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.code.value, msg::CodeNames::INTERNAL);
  breakDown("contacts");
  EXPECT_TRUE(node_.explain("robot/a", "robot/b").success) << "no contacts were asked for";
  const auto failed = node_.explain("robot/a", "robot/b", 5);
  EXPECT_FALSE(failed.success) << "an empty list of contacts would mean that there are none";
  EXPECT_EQ(failed.code.value, msg::CodeNames::INTERNAL);
  EXPECT_TRUE(says(failed.code.text, "a fault in contacts"));
  EXPECT_TRUE(failed.reported);
  EXPECT_TRUE(says(failed.explanation, "robot/a and robot/b are reported"));
  breakDown("");
  EXPECT_TRUE(node_.explain("robot/a", "robot/b", 5).success);
}

TEST_F(Faults, InAMeasurementAreCountedAndPairsGoOn) {
  const auto next = [&](double patience) {
    return ros::topic::waitForMessage<msg::Distances>(node_.named("distances"), ros::Duration(patience));
  };
  ASSERT_TRUE(next(20.0));
  breakDown("measure");
  transforms_.stream("base", "b", at(0.16));  // only a pair that moves is measured again
  EXPECT_FALSE(next(1.0));
  const std::size_t pairs = node_.heard().pairs.size();
  EXPECT_GE(counted("distances.fault.INTERNAL"), 1u);
  EXPECT_GT(node_.heard().pairs.size(), pairs);
  EXPECT_EQ(node_.heard().pairs.back()->first.size(), 1u);
  breakDown("");
  EXPECT_TRUE(next(20.0));
}

TEST_F(Faults, InATickAreCountedAndPairsGoOn) {
  breakDown("measure");
  transforms_.stream("base", "b", at(5.0));  // the pair ends, and the tick measures its distance for ~events
  node_.waitUntil("a failed tick", [](const Heard& all) {
    return !all.status.empty() && counter(*all.status.back(), "tick.failed.INTERNAL") >= 1;
  });
  breakDown("");
  node_.waitUntil("the failed tick on /diagnostics", [](const Heard& all) {
    const auto found = all.diagnostics.find("ticks");
    if (found == all.diagnostics.end()) return false;
    const auto& values = found->second.values;
    return std::any_of(values.begin(), values.end(), [](const diagnostic_msgs::KeyValue& value) {
      return value.key == "failed ticks" && std::stoi(value.value) >= 1;
    });
  });
  transforms_.stream("base", "b", at(0.15));
  node_.waitUntil("the pair",
                  [](const Heard& all) { return !all.pairs.empty() && all.pairs.back()->first.size() == 1; });
}

/// Claim: no tick waits for measurements, not even for one that never ends.
TEST_F(Faults, AMeasurementThatHangsDelaysNoTick) {
  const boost::function<void(const msg::Distances::ConstPtr&)> ignore = [](const msg::Distances::ConstPtr&) {};
  const ros::Subscriber listener = ros::NodeHandle().subscribe<msg::Distances>(node_.named("distances"), 1, ignore);
  breakDown("hang");
  transforms_.stream("base", "b", at(0.16));  // only a pair that moves is measured again
  node_.waitUntil("ticks without ~distances", [](const Heard& all) {
    return !all.status.empty() && counter(*all.status.back(), "distances.skipped") >= 10;
  });
  const std::uint64_t sequence = node_.heard().pairs.back()->world.sequence;
  node_.waitForTicks(10);
  EXPECT_GE(node_.heard().pairs.back()->world.sequence, sequence + 10);
  breakDown("");
  EXPECT_TRUE(ros::topic::waitForMessage<msg::Distances>(node_.named("distances"), ros::Duration(20.0)));
}

/// Claim: a query does not wait for the queries of other clients, not even if these never end, as long as there are
/// fewer of them than ~query_threads (8 by default).
TEST_F(Faults, AQueryDoesNotWaitForQueriesThatHang) {
  breakDown("hang");
  std::vector<std::future<msg::Answer>> others;
  for (int client = 0; client < 7; ++client) {
    others.push_back(std::async(std::launch::async, [this] {
      msg::QuerySphere query;
      query.request.radius = 0.05;
      query.request.exact = true;
      ros::service::call(node_.named("query_sphere"), query);
      return query.response.answer;
    }));
  }
  const auto ended = [](std::future<msg::Answer>& other) {
    return other.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  };
  for (int hanging = 0; hanging < 7;) ros::param::get(node_.named("hanging"), hanging);
  EXPECT_EQ(node_.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT);
  EXPECT_TRUE(std::none_of(others.begin(), others.end(), ended)) << "they hang until the fault is repaired";
  breakDown("");
  for (auto& other : others) EXPECT_EQ(other.get().verdict, msg::Verdict::HIT);
}

TEST_F(Faults, InAMeasurementAreOnDiagnosticsUntilOneSucceeds) {
  waitForTicksStatus(diagnostic_msgs::DiagnosticStatus::OK, "");
  const boost::function<void(const msg::Distances::ConstPtr&)> ignore = [](const msg::Distances::ConstPtr&) {};
  const ros::Subscriber listener =  // distances are measured only while there is a subscriber
      ros::NodeHandle().subscribe<msg::Distances>(node_.named("distances"), 1, ignore);
  int b = 0;
  for (const char* kind : {"", "memory", "int"}) {
    breakDown("measure", kind);
    transforms_.stream("base", "b", at(0.15 + 0.01 * ++b));  // only a pair that moves is measured again
    waitForTicksStatus(diagnostic_msgs::DiagnosticStatus::ERROR, "the last measurement of ~distances failed");
    breakDown("");
    waitForTicksStatus(diagnostic_msgs::DiagnosticStatus::OK, "on time");
  }
}

TEST_F(Faults, OfEveryKindInAQueryAreReportedToTheCaller) {
  for (const char* kind : {"int", "memory"}) {
    breakDown("measure", kind);
    const auto answer = exactSphere().answer;
    EXPECT_FALSE(answer.success) << kind;
    EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN) << kind;
    EXPECT_FALSE(node_.explain("robot/a", "robot/b").success) << kind;
  }
  breakDown("");
  EXPECT_EQ(exactSphere().answer.verdict, msg::Verdict::HIT);
}

TEST_F(Faults, OfEveryKindInAReloadLeaveTheOldModel) {
  node_.setBeside("robot_description", description({"a"}));
  breakDown("solidOf", "int");
  EXPECT_EQ(node_.reload("robot").code.value, msg::CodeNames::INTERNAL);
  breakDown("solidOf", "memory");
  EXPECT_EQ(node_.reload("robot").code.value, msg::CodeNames::LIMIT);
  breakDown("");
  EXPECT_TRUE(node_.reload("robot").success);
}

TEST_F(Faults, InTheFirstLoadAreTriedAgain) {
  NodeSetup late = setup();
  late.beside.clear();
  NodeUnderTest node(late);
  ros::param::set(node.named("fault_kind"), "int");
  ros::param::set(node.named("fault"), "solidOf");
  node.setBeside("robot_description", description({"a", "b"}));
  node.waitUntil("the fault in the status 'robots' of /diagnostics", [](const Heard& all) {
    const auto found = all.diagnostics.find("robots");
    return found != all.diagnostics.end() && says(found->second.message, "INTERNAL robot 'robot'");
  });
  ros::param::set(node.named("fault"), "");
  node.waitForComplete();
}

/// Claim: if the system cannot create all threads of ~threads, the node works with those that it has, and says so.
TEST(MissingThreads, OfATickAreReportedAndTheNodeWorksWithTheOthers) {
  NodeSetup setup;
  setup.command = {HGRID_FAULTS_NODE};
  setup.environment["HGRID_MOST_THREADS"] = "16";  // the node needs 13, apart from those of ~threads
  setup.environment["ROSCONSOLE_STDOUT_LINE_BUFFERED"] = "1";
  setup.params = dict({{"world_frame", "world"},
                       {"threads", 32},
                       {"query_threads", 2},
                       {"obstacles", list({ball("post", 0, 0, 0, 0.1)})},
                       {"robots", list({dict({{"name", "none"}, {"description", "robot_description"}})})}});
  NodeUnderTest node(setup);
  node.waitUntil("the threads in the status 'ticks' of /diagnostics", [](const Heard& all) {
    const auto found = all.diagnostics.find("ticks");
    return found != all.diagnostics.end() && found->second.level == diagnostic_msgs::DiagnosticStatus::WARN &&
           says(found->second.message, "of the 32 threads of ~threads");
  });
  EXPECT_GE(node.lines("of the 32 threads of ~threads"), 1u) << node.output();
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::HIT);
}

/// Claim: without a thread for its callbacks, the node does not start: it ends with a sentence and exit code 1. It does
/// not destroy what threads that were already started still use.
TEST(MissingThreads, OfCallbacksEndTheNode) {
  // One each for the audit, the history, ~bodies, ~distances, ~conflicts and timers; six for callbacks.
  constexpr int kNeeded = 12;
  const auto with = [](int most) {
    NodeSetup setup = Faults::setup();
    setup.environment["HGRID_MOST_THREADS"] = std::to_string(most);
    setup.params["rate"] = 1000.0;  // so that a tick begins at once
    setup.params["query_threads"] = 2;
    return setup;
  };
  for (int most = 0; most < kNeeded; ++most) {
    SCOPED_TRACE("only " + std::to_string(most) + " threads");
    NodeUnderTest node(with(most), false);
    EXPECT_EQ(node.process().waitForEnd(20.0).value_or(-1), 1) << node.output();
  }
  const NodeUnderTest node(with(kNeeded));  // waits until the node works
}

TEST_F(Faults, InAReloadLeaveTheOldModel) {
  node_.setBeside("robot_description", description({"a"}));
  breakDown("solidOf");
  const auto refused = node_.reload("robot");
  EXPECT_FALSE(refused.success);
  EXPECT_EQ(refused.code.value, msg::CodeNames::INTERNAL);
  EXPECT_TRUE(says(refused.code.text, "a fault in solidOf"));
  node_.waitForTicks(2);
  EXPECT_EQ(node_.heard().status.back()->body_count, 3u);
  EXPECT_TRUE(oneSays(node_.heard().status.back()->world.reasons, "REFUSED 'robot': its newest description"));
  breakDown("");
  ASSERT_TRUE(node_.reload("robot").success);
  node_.waitForTicks(2);
  EXPECT_EQ(node_.heard().status.back()->body_count, 2u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
