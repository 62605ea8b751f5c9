// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Sends messages and requests to a running node that declare more data than they contain, or more transforms than the
// node can store.
#include <hgrid_proximity/CheckEdges.h>
#include <hgrid_proximity/CheckStates.h>
#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QueryShape.h>
#include <hgrid_proximity/Verdict.h>

#include <limits>
#include <optional>

#include "test/node/support/built.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/random_message.h"
#include "test/node/support/raw_message.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// Returns how many transforms or whole messages of tf the node has accepted, refused, dropped or ignored.
std::uint64_t decided(const msg::Status& status) {
  std::uint64_t count = 0;
  for (const msg::Counter& counter : status.counters) {
    for (const char* verdict : {"tf.accepted", "tf.refused.", "tf.dropped.", "tf.ignored.", "tf.too_old"}) {
      if (counter.name.rfind(verdict, 0) == 0) count += counter.value;
    }
  }
  return count;
}

/// A robot that never becomes LOST, with a sphere of radius 0.1 m at the origin of "base". Also publishers that can
/// send any bytes.
class Lengths : public ::testing::Test {
 protected:
  void start(std::optional<int> queue_bytes = std::nullopt) {
    NodeSetup setup;
    setup.params = dict({{"late_after", 3600.0}, {"stale_after", 3600.0}, {"lost_after", 3600.0}});
    if (queue_bytes) setup.params["limits"]["tf_queue_bytes"] = *queue_bytes;
    setup.beside["robot_description"] = balls({"a"});
    node_ = std::make_unique<NodeUnderTest>(setup);
    moving_ = ros_.advertise<TransformsBytes>("/tf", 0);  // 0: the publisher drops nothing
    static_ = ros_.advertise<TransformsBytes>("/tf_static", 0);
    node_->waitUntil("the node subscribes to tf", [&](const Heard&) {
      return moving_.getNumSubscribers() == 1 && static_.getNumSubscribers() == 1;
    });
    moving_.publish(bytesWith({stamped("base", "a", at(0), ros::Time::now())}));
    node_->waitForComplete();
    memory_ = peakKilobytes(node_->process().pid());
  }
  static TransformsBytes bytesWith(const std::vector<geometry_msgs::TransformStamped>& transforms) {
    tf2_msgs::TFMessage message;
    message.transforms = transforms;
    return {serialized(message)};
  }
  /// Returns a message of 20 bytes that declares `count` transforms.
  static TransformsBytes lie(std::uint32_t count) { return {bytesOf(count) + std::string(16, '\0')}; }
  void waitForRefusals(const std::string& code, std::uint64_t count) {
    node_->waitForStatus(std::to_string(count) + " refusals with " + code,
                         [&](const msg::Status& status) { return counter(status, "tf.refused." + code) == count; });
  }
  void expectUnharmed() {
    EXPECT_LT(peakKilobytes(node_->process().pid()), memory_ + mostGrowth(8000)) << "kB";
    EXPECT_NEAR(xOf(*node_, "robot/a"), 0.0, 1e-6);
    EXPECT_TRUE(node_->heard().status.back()->world.complete);
  }
  /// Expects that a request with these bytes is refused, and that its connection stays usable.
  template <class Service>
  void expectRefused(ros::ServiceClient& client, const std::string& bytes) {
    typename Service::Response response;
    ASSERT_TRUE(client.call(RequestBytes{bytes}, response, ros::service_traits::md5sum<Service>()));
    EXPECT_EQ(codeOf(response), "TRUNCATED");
    EXPECT_TRUE(client.isValid());
  }
  /// Expects that a service refuses requests with wrong lengths, and answers a correct request.
  template <class Service>
  void expectChecked(const std::string& name) {
    SCOPED_TRACE(name);
    const std::string md5 = ros::service_traits::md5sum<Service>();
    ros::ServiceClientOptions options(node_->named(name), md5, true, ros::M_string());
    ros::ServiceClient client = ros_.serviceClient(options);
    const typename Service::Request request;
    const std::string honest = serialized(request);
    for (const std::size_t at : LengthPositions::of(request)) {
      for (const std::uint32_t length : {1u << 25, 0xffffffffu}) {
        std::string lying = honest;
        expectRefused<Service>(client, lying.replace(at, 4, bytesOf(length)));
      }
    }
    expectRefused<Service>(client, honest + "x");
    if (!honest.empty()) expectRefused<Service>(client, honest.substr(0, honest.size() - 1));
    typename Service::Response response;
    ASSERT_TRUE(client.call(RequestBytes{honest}, response, md5));
    EXPECT_NE(codeOf(response), "TRUNCATED");
  }
  template <class Response>
  static auto codeOf(const Response& response) -> decltype(response.answer.code.name) {
    EXPECT_EQ(response.answer.verdict == msg::Verdict::UNKNOWN, !response.answer.success)
        << "a refused query is UNKNOWN, never CLEAR";
    return response.answer.code.name;
  }
  template <class Response>
  static auto codeOf(const Response& response) -> decltype(response.code.name) {
    return response.code.name;
  }
  static std::string codeOf(const std_srvs::Trigger::Response& response) {
    return response.success ? "OK" : response.message.substr(0, response.message.find(':'));
  }

  ros::NodeHandle ros_;
  std::unique_ptr<NodeUnderTest> node_;
  ros::Publisher moving_, static_;
  std::size_t memory_ = 0;  // [kB] memory of the node at the start
};

TEST_F(Lengths, OfTransformsThatAMessageDoesNotHoldCostNoMemory) {
  start();
  std::uint64_t sent = 0;
  for (const ros::Publisher* publisher : {&moving_, &static_}) {
    for (const std::uint32_t count : {1u, 8388608u, 0x08000000u, 0xffffffffu}) {
      for (int i = 0; i < 5; ++i, ++sent) publisher->publish(lie(count));
    }
  }
  waitForRefusals("TRUNCATED", sent);
  expectUnharmed();
  EXPECT_TRUE(throttled(*node_, "tf.refused.TRUNCATED"));
  EXPECT_GE(node_->lines("tf.refused.TRUNCATED: the message on /tf from '"), 1u);
}

TEST_F(Lengths, OfRequestsThatTheirBytesDoNotHoldAreRefused) {
  start();
  expectChecked<msg::QuerySphere>("query_sphere");
  expectChecked<msg::QuerySegment>("query_segment");
  expectChecked<msg::QueryBox>("query_box");
  expectChecked<msg::QueryNearest>("query_nearest");
  expectChecked<msg::QueryShape>("query_shape");
  expectChecked<msg::CheckStates>("check_states");
  expectChecked<msg::CheckEdges>("check_edges");
  expectChecked<msg::ExplainPair>("explain_pair");
  expectChecked<msg::SetAllowed>("set_allowed");
  expectChecked<msg::GetAllowed>("get_allowed");
  expectChecked<msg::LoadOctomap>("load_octomap");
  expectChecked<msg::ClearMap>("clear_map");
  expectChecked<msg::ReloadRobot>("reload_robot");
  expectChecked<std_srvs::Trigger>("reset");
  node_->waitForComplete();
  expectUnharmed();
}

TEST_F(Lengths, OfMessagesThatExceedTheQueueAreRefusedByName) {
  start(1000);
  const geometry_msgs::TransformStamped transform = stamped("base", "b", at(1), ros::Time::now());
  moving_.publish(bytesWith(std::vector<geometry_msgs::TransformStamped>(20, transform)));
  waitForRefusals("LIMIT", 1);
  EXPECT_GE(node_->lines(" bytes; at most 1000 are accepted (~limits/tf_queue_bytes)"), 1u);
  moving_.publish(bytesWith({transform}));
  node_->waitForStatus("the short message is accepted",
                       [](const msg::Status& status) { return counter(status, "tf.accepted") == 2; });
}

/// Claim: messages with a million entries are refused as a whole, and the node stores none of the entries.
TEST_F(Lengths, OfAMillionEntriesExceedTheLimits) {
  start();
  constexpr std::uint32_t kEntries = 1000000;
  moving_.publish(TransformsBytes{bytesOf(kEntries) + std::string(kEntries * std::size_t{76}, '\0')});
  waitForRefusals("LIMIT", 1);
  const std::uint32_t before = node_->getAllowed().total;
  msg::SetAllowed::Request rules;
  rules.rules.resize(kEntries);
  const auto refused = node_->setAllowed(rules);
  EXPECT_FALSE(refused.success);
  EXPECT_EQ(refused.code.name, "LIMIT") << refused.code.text;
  EXPECT_EQ(node_->getAllowed().total, before);
  EXPECT_NEAR(xOf(*node_, "robot/a"), 0.0, 1e-6);
  EXPECT_TRUE(node_->heard().status.back()->world.complete);
}

/// Claim: a publisher of /tf that announces 999,999,999 bytes and sends none costs only address space. The transforms
/// of other publishers are used.
TEST_F(Lengths, OfTransformsThatAreAnnouncedAndNeverSentCostOnlyAddressSpace) {
  start();
  const auto before = memoryOf(node_->process().pid());
  ChildProcess silent({"/usr/bin/python3", HGRID_PROJECT_DIR "/test/node/support/silent_publisher.py", "/tf",
                       TransformsKind::kType, TransformsKind::kMd5},
                      "/dev/null", {});
  node_->waitUntil("the announcement", [&](const Heard&) { return hasReserved(node_->process().pid(), before); });
  moving_.publish(bytesWith({stamped("base", "a", at(1), ros::Time::now())}));
  node_->waitUntil("the transform of another publisher",
                   [&](const Heard&) { return std::abs(xOf(*node_, "robot/a") - 1.0) < 1e-6; });
  EXPECT_TRUE(costsOnlyAddressSpace(node_->process().pid(), before));
  EXPECT_TRUE(node_->heard().status.back()->world.complete);
}

TEST_F(Lengths, OfLongMessagesDoNotStopTheTicks) {
  start();
  constexpr std::uint32_t kTransforms = 200000;  // they have no names, so each of them is refused
  moving_.publish(TransformsBytes{bytesOf(kTransforms) + std::string(kTransforms * std::size_t{76}, '\0')});
  waitForRefusals("BAD_ID", kTransforms);
  bool ticked = false;
  for (const auto& status : node_->heard().status) {
    const std::uint64_t refused = counter(*status, "tf.refused.BAD_ID");
    ticked = ticked || (refused > 0 && refused < kTransforms);
  }
  EXPECT_TRUE(ticked) << "no tick was made while the message was read";
}

TEST_F(Lengths, ManyMessagesAreEachAcceptedRefusedOrDropped) {
  for (const std::optional<int> queue_bytes : {std::optional<int>(), std::optional<int>(1000)}) {
    SCOPED_TRACE(queue_bytes ? "1000 bytes" : "the default");
    start(queue_bytes);
    const std::uint64_t before = decided(*node_->heard().status.back());
    constexpr int kMessages = 20000;
    const ros::Time begin = ros::Time::now() - ros::Duration(5.0);
    for (int i = 0; i < kMessages; ++i) {
      const bool good = i % 3 != 0;
      const double x = good ? 1.0 : std::numeric_limits<double>::quiet_NaN();
      moving_.publish(i % 10 == 0 ? lie(7) : bytesWith({stamped("base", "b", at(x), begin + ros::Duration(1e-4 * i))}));
    }
    const auto status = node_->waitForStatus(
        "all messages were handled", [&](const msg::Status& now) { return decided(now) - before == kMessages; });
    EXPECT_GT(counter(*status, "tf.accepted"), 1u);
    node_->waitForTicks(2);
    EXPECT_EQ(decided(*node_->heard().status.back()) - before, kMessages);
    expectUnharmed();
    node_.reset();
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
