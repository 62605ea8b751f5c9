// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests point clouds. The node adds the cells of a message, places them by the pose of the sensor at the stamp of the
// message, and removes them after their lifetime. A message that is refused does no harm.
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/UnknownReason.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/topic.h>
#include <sensor_msgs/PointCloud2.h>

#include <chrono>
#include <cmath>
#include <cstring>

#include "test/node/support/built.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/raw_message.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using msg::Answer;
using Names = std::vector<std::string>;
using Points = std::vector<std::array<float, 3>>;

sensor_msgs::PointCloud2 cloudOf(const std::string& frame, ros::Time stamp, const Points& points) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = frame;
  cloud.header.stamp = stamp;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(points.size());
  for (const char* name : {"x", "y", "z"}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(4 * cloud.fields.size());
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.point_step = 12;
  cloud.row_step = 12 * cloud.width;
  cloud.data.resize(cloud.row_step);
  if (!points.empty()) std::memcpy(cloud.data.data(), points.data(), cloud.data.size());
  return cloud;
}

/// A robot with a sphere of radius 0.1 m at the origin of "base", and a cloud with cells of 0.1 m. The test sends the
/// cloud repeatedly.
class Clouds : public ::testing::Test {
 protected:
  /// Starts the node. @param cloud  additional parameters of the cloud
  void start(double lifetime, const std::map<std::string, Value>& cloud = {}, Value params = dict()) {
    NodeSetup setup;
    setup.params = params;
    Value front = dict({{"name", "front"}, {"topic", "points"}, {"resolution", 0.1}, {"lifetime", lifetime}});
    for (const auto& entry : cloud) front[entry.first] = entry.second;
    setup.params["clouds"] = list({front});
    setup.beside["robot_description"] = balls({"a"});
    transforms_.stream("base", "a", at(0));
    transforms_.fix({stamped("base", "camera", at(0, 0, 1.0))});
    node_ = std::make_unique<NodeUnderTest>(setup);
    publisher_ = ros_.advertise<CloudBytes>(node_->space() + "/points", 1);
    node_->waitUntil("the node subscribes to the cloud",
                     [this](const Heard&) { return publisher_.getNumSubscribers() > 0; });
  }
  void send(const std::string& bytes) { publisher_.publish(CloudBytes{bytes}); }
  void send(const sensor_msgs::PointCloud2& cloud) { send(serialized(cloud)); }
  /// Sends points in the frame "camera", with the current time as stamp, until `holds` is true for a status.
  void sendUntil(const Points& points, const std::string& what, const std::function<bool(const msg::Status&)>& holds) {
    node_->waitUntil(what, [&](const Heard& heard) {
      if (heard.status.empty()) return false;
      if (heard.status.back()->world.sequence % 5 == 0) send(cloudOf("camera", transforms_.now(), points));
      return holds(*heard.status.back());
    });
  }
  void sendUntilComplete(const Points& points) {
    sendUntil(points, "a complete world", [](const msg::Status& status) { return status.world.complete; });
  }
  static bool isWithoutCells(const msg::Status& status) {
    return status.gauges.front().name == "cells.cloud/front" && status.gauges.front().value == 0.0;
  }
  Answer askedAt(double x, double y, double z) { return node_->sphere(x, y, z, 0.01).answer; }
  /// Sends points in the frame "camera" and asks, until the verdict is not UNKNOWN, for at most 20 s. Where there are
  /// no cells, it is UNKNOWN if the newest points are so old that the cells may have moved there.
  Answer askedWithFresh(const Points& points, double x, double y, double z) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    for (;;) {
      send(cloudOf("camera", transforms_.now(), points));
      node_->waitForTicks(2);
      const Answer answer = askedAt(x, y, z);
      if (answer.verdict != msg::Verdict::UNKNOWN || std::chrono::steady_clock::now() > end) return answer;
    }
  }

  TransformSource transforms_;
  ros::NodeHandle ros_;
  std::unique_ptr<NodeUnderTest> node_;
  ros::Publisher publisher_;
};

TEST_F(Clouds, MakePairsAndGoWithTheirLifetimeWhichLeavesTheWorldIncomplete) {
  start(0.5);
  node_->waitForStatus("the missing cloud is reported", [](const msg::Status& status) {
    return !status.world.reasons.empty() && status.world.reasons[0].find("NOT_READY cloud 'front'") == 0;
  });
  const Points point{{0.05f, 0.05f, -0.85f}};  // z is 0.15 m in "base"
  sendUntil(point, "a pair", [](const msg::Status& status) { return status.pair_count == 1; });
  const auto pairs = node_->waitForPairs("a pair of the sphere and the cell", [](const msg::Pairs& now) {
    return now.names == Names({"cloud/front", "robot/a"});
  });
  EXPECT_NEAR(pairs->gap[0], 0.0, 1e-6) << "the cell begins at z = 0.1 m and touches the box of the sphere";
  EXPECT_TRUE(pairs->world.complete);
  node_->waitForStatus("the cell has expired",
                       [](const msg::Status& status) { return status.pair_count == 0 && !status.world.complete; });
  const Answer answer = askedAt(0.05, 0.05, 0.15);
  EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN) << "without the sensor, the verdict is never CLEAR";
  EXPECT_TRUE(says(answer.summary, "LOST cloud/front: its newest points are"));
  sendUntilComplete(point);
}

/// Claim: a cloud without a stamp counts as stamped when it arrives. That is counted and logged, because its points are
/// wrong if the sensor moved meanwhile.
TEST_F(Clouds, WithoutAStampAreUsedAsOfTheirArrivalAndReported) {
  start(60.0);
  const std::string cloud = serialized(cloudOf("camera", ros::Time(), Points{{0.05f, 0.05f, 2.05f}}));
  node_->waitUntil("a complete world", [&](const Heard& heard) {
    if (heard.status.empty()) return false;
    if (heard.status.back()->world.sequence % 5 == 0) send(cloud);
    return heard.status.back()->world.complete != 0;
  });
  EXPECT_EQ(askedAt(0.05, 0.05, 3.05).verdict, msg::Verdict::HIT);
  const auto status = node_->waitForStatus("the cloud is counted", [](const msg::Status& s) {
    return counter(s, "cloud/front.accepted") >= 1;  // counted after the tick that uses it
  });
  EXPECT_GE(counter(*status, "cloud/front.unstamped.CLOCK"), counter(*status, "cloud/front.accepted"));
  EXPECT_TRUE(throttled(*node_, "cloud 'front' of points has no stamp; its time of arrival is used instead"));
}

TEST_F(Clouds, ThatAreAnnouncedAndNeverSentCostOnlyAddressSpace) {
  start(60.0);
  const Points point{{0.05f, 0.05f, 2.05f}};
  sendUntilComplete(point);
  const auto before = memoryOf(node_->process().pid());
  ChildProcess silent({"/usr/bin/python3", HGRID_PROJECT_DIR "/test/node/support/silent_publisher.py",
                       node_->space() + "/points", CloudKind::kType, CloudKind::kMd5},
                      "/dev/null", {});
  node_->waitUntil("the announcement", [&](const Heard&) { return hasReserved(node_->process().pid(), before); });
  const std::uint64_t accepted = counter(*node_->heard().status.back(), "cloud/front.accepted");
  sendUntil(point, "the clouds of another publisher",
            [&](const msg::Status& status) { return counter(status, "cloud/front.accepted") > accepted; });
  EXPECT_TRUE(costsOnlyAddressSpace(node_->process().pid(), before));
}

TEST_F(Clouds, WithoutFinitePointsDoNotKeepTheCloudFresh) {
  start(1.0);
  const float nan = std::nanf("");
  const Points wall{{0.05f, 0.05f, 2.05f}};  // z is 3.05 m in "base"
  const Points beams_without_return(441, {0.0f, 0.0f, 0.0f}), beams_without_end(441, {0.0f, 0.0f, 1e10f});
  for (const Points& blind :
       {Points{}, Points{{nan, nan, nan}, {nan, 0.0f, 0.0f}}, beams_without_return, beams_without_end}) {
    SCOPED_TRACE(std::to_string(blind.size()) + " points");
    EXPECT_EQ(askedWithFresh(wall, 0.05, 0.05, 3.05).verdict, msg::Verdict::HIT);
    sendUntilComplete(wall);
    sendUntil(blind, "the cloud is lost", [](const msg::Status& status) {
      return status.world.incomplete == Names({"cloud/front"}) && isWithoutCells(status);
    });
    const Answer answer = askedAt(0.05, 0.05, 3.05);
    EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN) << "the wall may still be there";
    EXPECT_EQ(answer.unknown_because, msg::UnknownReason::INCOMPLETE);
    EXPECT_TRUE(says(answer.summary, "has 0 points; it needs at least 1 (min_points)"));
  }
}

TEST_F(Clouds, BeamsWithoutReturnAreNotAtTheSensor) {
  start(20.0);
  const Points points{{0, 0, 0}, {0.05f, 0.05f, 2.05f}, {0, 0, 0}};
  EXPECT_EQ(askedWithFresh(points, 0.05, 0.05, 3.05).verdict, msg::Verdict::HIT);
  EXPECT_EQ(askedWithFresh(points, 0.0, 0.0, 1.0).verdict, msg::Verdict::CLEAR);
  node_->waitForStatus("they are counted", [](const msg::Status& status) {
    return counter(status, "cloud/front.points_without_return") >= 2;
  });
}

/// Claim: where points say that something is nearer than the sensor can see, nothing near the lens is CLEAR.
TEST_F(Clouds, WithPointsThatAreTooNearAreNotClearBeforeTheLens) {
  start(20.0, {{"blind_range", 0.4}});
  const float inf = INFINITY;
  const Points wall{{0.05f, 0.05f, 2.05f}};
  Points blind(9, {-inf, -inf, -inf});
  blind.push_back(wall[0]);
  sendUntil(blind, "the sensor is blind near its lens", [](const msg::Status& status) {
    return status.world.incomplete == Names({"cloud/front"}) && !status.world.reasons.empty() &&
           status.world.reasons[0].find("TOO_NEAR cloud/front: 9 points") == 0;
  });
  EXPECT_EQ(askedWithFresh(blind, 0.05, 0.05, 3.05).verdict, msg::Verdict::HIT);
  EXPECT_EQ(askedWithFresh(blind, 0.0, 0.0, 1.5).verdict, msg::Verdict::CLEAR) << "this is 0.5 m before the lens";
  send(cloudOf("camera", transforms_.now(), blind));
  node_->waitForTicks(2);
  const Answer answer = askedAt(0.0, 0.0, 1.3);
  EXPECT_EQ(answer.verdict, msg::Verdict::UNKNOWN);
  EXPECT_TRUE(says(answer.summary, "TOO_NEAR cloud/front: 9 points of its newest message are -inf"));
  sendUntilComplete(wall);
  EXPECT_EQ(askedWithFresh(wall, 0.0, 0.0, 1.3).verdict, msg::Verdict::CLEAR);
}

TEST_F(Clouds, WithTooFewPointsAddTheirCellsButDoNotKeepTheCloudFresh) {
  start(1.0, {{"min_points", 2}});
  const Points both{{0.05f, 0.05f, 2.05f}, {0.05f, 1.05f, 2.05f}};
  sendUntilComplete(both);
  bool seen = false;  // even too few points add their cells
  sendUntil({{0.05f, 2.05f, 2.05f}}, "new cells, and the cloud is lost", [&](const msg::Status& status) {
    seen = seen || askedAt(0.05, 2.05, 3.05).verdict == msg::Verdict::HIT;
    return seen && status.world.incomplete == Names({"cloud/front"});
  });
}

TEST_F(Clouds, WithoutPointsAreClearWhereThatIsConfigured) {
  start(0.5, {{"empty", "clear"}});
  sendUntilComplete({});
  EXPECT_EQ(askedAt(0.05, 0.05, 3.05).verdict, msg::Verdict::CLEAR);
}

TEST_F(Clouds, AnOlderStampNeverMakesTheCloudOlder) {
  start(2.0);
  const Points wall{{0.05f, 0.05f, 2.05f}};
  sendUntilComplete(wall);
  send(cloudOf("camera", transforms_.now() - ros::Duration(3.0), wall));
  const auto late = node_->waitForStatus("the late message is counted", [](const msg::Status& status) {
    return counter(status, "cloud/front.out_of_order") > 0;
  });
  EXPECT_LT(stateOf(*late, "cloud/front"), msg::BodyState::LOST);
  EXPECT_TRUE(late->world.complete);
  EXPECT_EQ(askedAt(0.05, 0.05, 3.05).verdict, msg::Verdict::HIT);
}

TEST_F(Clouds, ThatAreLostLeaveQuestionsAboutTheRobotClear) {
  start(0.5, {{"range", 4.0}});
  sendUntilComplete({{0.05f, 0.05f, 2.05f}});
  node_->waitForStatus("the cloud is lost",
                       [](const msg::Status& status) { return !status.world.complete && isWithoutCells(status); });
  msg::QuerySphere::Request request;
  request.center.z = 3.0;
  request.radius = 0.1;
  EXPECT_EQ(node_->ask(request).answer.verdict, msg::Verdict::UNKNOWN);
  request.include = {"robot/*"};
  const Answer robot = node_->ask(request).answer;
  EXPECT_EQ(robot.verdict, msg::Verdict::CLEAR);
  EXPECT_TRUE(says(robot.summary, "CLEAR"));
  request.include = {};
  request.center.z = 3000.0;
  EXPECT_EQ(node_->ask(request).answer.verdict, msg::Verdict::CLEAR) << "this place is beyond the range of the sensor";
}

TEST_F(Clouds, LieWhereTheSensorWasAtTheirStamp) {
  start(20.0);
  const ros::Time before = transforms_.now() - ros::Duration(0.5), later = transforms_.now();
  transforms_.send({stamped("base", "arm", at(3.0), before), stamped("base", "arm", at(7.0), later)});
  node_->waitForTransforms(2);
  send(cloudOf("arm", before, {{0.05f, 0.05f, 0.05f}}));
  node_->waitUntil("a hit", [&](const Heard&) { return askedAt(3.05, 0.05, 0.05).verdict == msg::Verdict::HIT; });
  EXPECT_EQ(askedAt(7.05, 0.05, 0.05).hits.size(), 0u);
  send(cloudOf("arm", later, {{0.05f, 0.05f, 0.05f}}));
  node_->waitUntil("a hit", [&](const Heard&) { return askedAt(7.05, 0.05, 0.05).verdict == msg::Verdict::HIT; });
  EXPECT_EQ(askedAt(3.05, 0.05, 0.05).verdict, msg::Verdict::HIT) << "this cell has not expired yet";
}

TEST_F(Clouds, PointsThatAreNotFiniteAreLeftOut) {
  start(20.0);
  const float nan = std::nanf(""), infinity = INFINITY;
  sendUntilComplete({{nan, nan, nan}, {0.05f, 0.05f, -0.95f}, {0.0f, infinity, 0.0f}, {infinity, nan, 0.0f}});
  EXPECT_EQ(askedAt(0.05, 0.05, 0.05).verdict, msg::Verdict::HIT);
  sendUntil({{nan, nan, nan}}, "all points that are not finite are counted",
            [](const msg::Status& status) { return counter(status, "cloud/front.points_not_finite") >= 4; });
  EXPECT_EQ(counter(*node_->heard().status.back(), "cloud/front.refused.NONFINITE"), 0u);
}

TEST_F(Clouds, ThatCannotBePlacedAreRefusedAndReportedAsMissing) {
  start(20.0);
  send(cloudOf("nowhere", transforms_.now(), {{0, 0, 0}}));
  const auto refused = [&](const std::string& code) {
    return [code](const msg::Status& status) { return counter(status, "cloud/front.refused." + code) > 0; };
  };
  node_->waitUntil("a refusal", [&](const Heard& heard) {
    send(cloudOf("nowhere", transforms_.now(), {{0, 0, 0}}));
    return !heard.status.empty() && refused("UNKNOWN_FRAME")(*heard.status.back());
  });
  const auto status = node_->waitForStatus("the reason", [](const msg::Status& now) {
    return !now.world.reasons.empty() && now.world.reasons[0].find("UNKNOWN_FRAME cloud 'front' of points") == 0;
  });
  EXPECT_TRUE(says(status->world.reasons[0], "the pose of its frame 'nowhere' in 'base' at its stamp"));
  node_->waitUntil("only the publisher knows the frame of its points", [&](const Heard& heard) {
    send(cloudOf("", transforms_.now(), {{1, 1, 1}}));
    const std::vector<std::string>& reasons = heard.status.back()->world.reasons;
    return !reasons.empty() && says(reasons[0], "cloud 'front' of points has no frame_id");
  });
  send(cloudOf("camera", transforms_.now() + ros::Duration(100.0), {{0, 0, 0}}));
  node_->waitForStatus("a refusal", refused("CLOCK"));
  transforms_.send({stamped("base", "arm", at(3.0), transforms_.now())});
  node_->waitUntil("a refusal", [&](const Heard& heard) {
    send(cloudOf("arm", transforms_.now() - ros::Duration(100.0), {{0, 0, 0}}));
    return refused("EXTRAPOLATION")(*heard.status.back());
  });
}

/// The lifetime is so long that cells of a message that should be refused would still be there at the end.
TEST_F(Clouds, WithWrongLengthsLeaveTheCloudAsItWas) {
  start(300.0, {}, dict({{"limits/max_map_bytes", 100000}}));
  sendUntilComplete({{0.05f, 0.05f, -0.95f}});
  const std::string whole = serialized(cloudOf("camera", transforms_.now(), {{1, 1, 1}, {2, 2, 2}}));
  const std::size_t before = residentKilobytes(node_->process().pid());
  std::uint64_t sent = 0;
  const auto refuse = [&](const std::string& bytes, const std::string& code) {
    send(bytes);
    ++sent;
    node_->waitForStatus("refusal " + std::to_string(sent) + " with " + code, [&](const msg::Status& status) {
      std::uint64_t all = 0;
      for (const char* each : {"TRUNCATED", "PARSE", "UNSUPPORTED", "LIMIT"}) {
        all += counter(status, std::string("cloud/front.refused.") + each);
      }
      return all == sent && counter(status, "cloud/front.refused." + code) > 0;
    });
  };
  const std::size_t frame_at = 12, fields_at = frame_at + 4 + 6 + 8;  // positions of frame_id and of the fields [bytes]
  const auto with = [&](std::size_t at, std::uint32_t number) {
    return whole.substr(0, at) + bytesOf(number) + whole.substr(at + 4);
  };
  refuse(with(frame_at, 0xffffffff), "TRUNCATED");   // declares a frame_id of 4 GB
  refuse(with(fields_at, 0x08000000), "TRUNCATED");  // declares 134 million fields
  refuse(with(fields_at + 4, 0xfffffff0), "TRUNCATED");
  for (std::size_t cut = 0; cut < whole.size(); cut += 7) refuse(whole.substr(0, cut), "TRUNCATED");
  refuse(whole + "x", "TRUNCATED");
  refuse(with(frame_at + 10, 0xffffffff), "TRUNCATED");  // declares 4 billion rows
  auto cloud = cloudOf("camera", transforms_.now(), {{1, 1, 1}});
  cloud.fields.pop_back();
  refuse(serialized(cloud), "UNSUPPORTED");
  refuse(serialized(cloudOf("camera", transforms_.now(), Points(9000))), "LIMIT");
  EXPECT_EQ(askedAt(0.05, 0.05, 0.05).verdict, msg::Verdict::HIT);
  const Answer beside = askedWithFresh({{0.05f, 0.05f, -0.95f}}, 1.05, 1.05, 2.05);
  EXPECT_EQ(beside.verdict, msg::Verdict::CLEAR) << "a refused message adds no cells: " << beside.summary;
  EXPECT_LT(residentKilobytes(node_->process().pid()), before + mostGrowth(4000)) << "kB";
}

TEST_F(Clouds, ThatAreLostSayWhatWasWrongWithTheLastMessage) {
  start(0.3, {}, dict({{"limits/max_map_leaves", 2}}));
  sendUntilComplete({{0.05f, 0.05f, 1.0f}});
  const auto refused = [&](const sensor_msgs::PointCloud2& cloud, const std::string& words) {
    node_->waitUntil(words, [&](const Heard& heard) {
      if (heard.status.back()->world.sequence % 5 == 0) send(cloud);
      for (const std::string& reason : heard.status.back()->world.reasons) {
        if (reason.find(words) != std::string::npos) return true;
      }
      return false;
    });
  };
  refused(cloudOf("nowhere", ros::Time(), {{0, 0, 0}}), "UNKNOWN_FRAME cloud 'front' of points: the pose of its frame");
  refused(cloudOf("camera", ros::Time(), {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}),
          "LIMIT cloud 'front' of points: there would be 3 cells; at most 2 are allowed by ~limits/max_map_leaves");
  for (const auto& status : node_->heard().status) {
    if (status->gauges.front().name != "cells.cloud/front" || status->gauges.front().value > 0.0) continue;
    ASSERT_FALSE(status->world.complete) << "a refused message does not keep the cloud fresh";
  }
  sendUntilComplete({{0.05f, 0.05f, 1.0f}});
}

TEST_F(Clouds, AreStaleAsSoonAfterAnOutageAsBeforeIt) {
  start(2.0);  // ~stale_after is 0.25 s
  const Points point{{0.05f, 0.05f, 1.0f}};
  sendUntilComplete(point);
  std::uint64_t accepted = 0;
  sendUntil(point, "messages at 10 Hz",
            [&](const msg::Status& status) { return (accepted = counter(status, "cloud/front.accepted")) >= 10; });
  node_->waitForTicks(200);  // an outage of 4 s
  const std::size_t begin = node_->heard().status.size();
  send(cloudOf("camera", transforms_.now(), point));
  node_->waitUntil("STALE after that message", [&](const Heard& heard) {
    const auto& status = *heard.status.back();
    if (heard.status.size() <= begin || counter(status, "cloud/front.accepted") <= accepted) return false;
    return !status.bodies.empty() && status.bodies[0].state == msg::BodyState::STALE;
  });
  EXPECT_LT(node_->heard().status.back()->bodies[0].age, 1.0) << "s";
}

TEST_F(Clouds, DoNotContainTheRobotItself) {
  start(20.0, {}, dict({{"map", dict({{"self_filter", list({dict({{"pattern", "robot/a"}, {"padding", 0.09}})})}})}}));
  Points points;
  for (int i = 0; i < 200; ++i) {  // points on the sphere of the robot, as a camera sees them
    const float angle = 0.0314f * static_cast<float>(i);
    points.push_back({0.1f * std::cos(angle), 0.1f * std::sin(angle), -1.0f});
  }
  points.push_back({0.0f, 0.35f, -1.0f});  // a point that does not belong to the robot
  sendUntilComplete(points);
  EXPECT_EQ(askedAt(0.05, 0.35, 0.05).verdict, msg::Verdict::HIT);
  EXPECT_EQ(namesOf(askedAt(0.1, 0.0, 0.0)), Names({"robot/a"}));
  EXPECT_GT(counter(*node_->heard().status.back(), "cloud/front.own_cells"), 3u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
