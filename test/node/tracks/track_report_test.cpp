// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests what the node reads from the messages of trackers, and which messages it refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hgrid_proximity/refusal.h"
#include "src/node/tf/tf_intake.h"
#include "test/node/support/transform_views.h"
#include "test/node/tracks/tracker_messages.h"

namespace hgrid {
namespace test {
namespace {

const Moment kNow = moment(1000.0, 50.0);
const ros::Time kStamp(999.5);

template <class Message>
TrackReport read(const Message& message, const TrackerParams& tracker) {
  return readTrackReport(serialized(message), tracker, kNow, 0.5);
}

/// Returns the code with which a message is refused; ok if it is not. Checks that the sentence contains `words`.
template <class Message>
Code refused(const Message& message, const std::string& words,
             const TrackerParams& tracker = people(TrackerType::markers)) {
  try {
    read(message, tracker);
  } catch (const Refusal& refusal) {
    EXPECT_NE(std::string(refusal.what()).find(words), std::string::npos) << refusal.what();
    return refusal.code();
  }
  return Code::ok;
}

std::vector<std::string> idsOf(const TrackReport& report) {
  std::vector<std::string> ids;
  for (const auto& pose : report.poses) ids.push_back(pose.id);
  return ids;
}
using Ids = std::vector<std::string>;

TEST(TrackReport, NamesMarkersByNamespaceAndId) {
  const TrackReport report = read(markers({marker(7, 1.0, kStamp, "/eye", "legs"), marker(-3, 2.0, kStamp)}), people());
  EXPECT_EQ(idsOf(report), Ids({"-3", "legs/7"}));
  EXPECT_TRUE(report.has_ids);
  EXPECT_EQ(report.poses[1].frame, "eye") << "without the slash of tf1";
  EXPECT_EQ(report.poses[1].frame_from_track.translation().x(), 1.0);
  EXPECT_EQ(report.stamp, s(999.5));
}

TEST(TrackReport, ReadsTheMarkersOfAnArrayInTheirOrder) {
  const Marker one = marker(1, 1.0, kStamp), two = marker(2, 2.0, kStamp), moved = marker(1, 5.0, kStamp);
  EXPECT_EQ(idsOf(read(markers({one, deleting(1), two}), people())), Ids({"2"}));
  EXPECT_EQ(idsOf(read(markers({one, deletingAll(), two}), people())), Ids({"2"}));
  EXPECT_EQ(idsOf(read(markers({deleting(1), deletingAll(), one, two}), people())), Ids({"1", "2"}));
  EXPECT_EQ(read(markers({one, deleting(1), moved}), people()).poses[0].frame_from_track.translation().x(), 5.0);
}

TEST(TrackReport, OfPosesHasNoIdsAndKeepsTheirOrder) {
  const TrackReport report = read(poses({3.0, 1.0}, kStamp, "eye"), people(TrackerType::poses));
  EXPECT_FALSE(report.has_ids);
  EXPECT_EQ(idsOf(report), Ids({"", ""}));
  EXPECT_EQ(report.poses[0].frame_from_track.translation().x(), 3.0);
}

TEST(TrackReport, OfAnEmptyMessageIsACompleteSetWithoutTracks) {
  EXPECT_TRUE(read(poses({}, kStamp), people(TrackerType::poses)).poses.empty());
  const TrackReport none = read(markers({}), people());
  EXPECT_TRUE(none.poses.empty());
  EXPECT_EQ(none.stamp, kNow.ros) << "an array without markers has no stamp";
}

TEST(TrackReport, LeavesOutMarkersOfOtherNamespaces) {
  TrackerParams tracker = people();
  tracker.namespaces = {"leg*"};
  Marker path = marker(1, 9.0, kStamp, "base", "paths");
  path.type = Marker::LINE_STRIP;
  const TrackReport report = read(markers({marker(1, 1.0, kStamp, "base", "legs"), path}), tracker);
  EXPECT_EQ(idsOf(report), Ids({"legs/1"}));
  EXPECT_EQ(report.ignored, 1u);
}

TEST(TrackReport, CountsOrientationsOfFourZeros) {
  Marker zero = marker(1, 1.0, kStamp);
  zero.pose.orientation.w = 0.0;
  const TrackReport report = read(markers({zero, marker(2, 2.0, kStamp)}), people());
  EXPECT_EQ(report.unrotated, 1u);
  EXPECT_TRUE(report.poses[0].frame_from_track.linear().isIdentity());
}

TEST(TrackReport, WithoutAStampIsOfItsArrival) {
  const TrackReport report = read(poses({1.0}, ros::Time()), people(TrackerType::poses));
  EXPECT_TRUE(report.unstamped);
  EXPECT_EQ(report.poses[0].stamp, kNow.ros);
  EXPECT_FALSE(read(poses({1.0}, kStamp), people(TrackerType::poses)).unstamped);
}

TEST(TrackReport, RefusesNumbersThatAreNoPose) {
  Marker bad = marker(1, std::nan(""), kStamp);
  EXPECT_EQ(refused(markers({bad}), "marker '1': position.x is nan"), Code::nonfinite);
  bad = marker(1, 1.0, kStamp);
  bad.pose.orientation.x = 1.0;
  EXPECT_EQ(refused(markers({bad}), "squared norm"), Code::bad_rotation);
  geometry_msgs::PoseArray array = poses({1.0, 2.0}, kStamp);
  array.poses[1].orientation.w = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refused(array, "pose 1: orientation.w is inf", people(TrackerType::poses)), Code::nonfinite);
}

TEST(TrackReport, RefusesStampsInTheFuture) {
  EXPECT_EQ(refused(markers({marker(1, 1.0, ros::Time(1000.6))}), "0.6 s in the future"), Code::clock);
  EXPECT_EQ(refused(markers({marker(1, 1.0, ros::Time(1000.4))}), ""), Code::ok);
  EXPECT_EQ(refused(poses({1.0}, ros::Time(4e9)), "in the future", people(TrackerType::poses)), Code::clock);
}

/// Claim: only the publisher knows the frame of its poses. The world frame would be a guess.
TEST(TrackReport, RefusesPosesWithoutAFrame) {
  for (const std::string frame : {"", "/"}) {
    EXPECT_EQ(refused(markers({marker(1, 1.0, kStamp, frame)}), "marker '1' has no frame_id"), Code::unknown_frame);
    EXPECT_EQ(refused(poses({1.0}, kStamp, frame), "pose 0 has no frame_id", people(TrackerType::poses)),
              Code::unknown_frame);
  }
  EXPECT_EQ(refused(poses({}, kStamp, ""), "", people(TrackerType::poses)), Code::ok) << "nothing has to be placed";
}

TEST(TrackReport, RefusesWhatArrivesBeforeThereIsATime) {
  const std::string bytes = serialized(markers({}));
  EXPECT_THROW(readTrackReport(bytes, people(), moment(0.0, 50.0), 0.5), Refusal);
}

TEST(TrackReport, RefusesAnIdThatIsAddedTwice) {
  const Marker one = marker(1, 1.0, kStamp);
  EXPECT_EQ(refused(markers({one, one}), "adds marker '1' twice"), Code::dup_id);
  EXPECT_EQ(refused(markers({one, deletingAll(), one}), ""), Code::ok);
}

TEST(TrackReport, RefusesIdsThatAreNoNames) {
  EXPECT_EQ(refused(markers({marker(1, 1.0, kStamp, "", std::string(130, 'a'))}), ""), Code::bad_id);
  EXPECT_EQ(refused(markers({marker(1, 1.0, kStamp, "", "a\nb")}), ""), Code::bad_id);
}

TEST(TrackReport, RefusesMarkersThatDrawPointsAndUnknownActions) {
  Marker lines = marker(1, 1.0, kStamp);
  lines.type = Marker::LINE_LIST;
  EXPECT_EQ(refused(markers({lines}), "name the namespaces of tracks"), Code::unsupported);
  lines.type = Marker::ARROW;
  lines.points.resize(2);
  EXPECT_EQ(refused(markers({lines}), "draws points"), Code::unsupported);
  lines = marker(1, 1.0, kStamp);
  lines.action = 9;
  EXPECT_EQ(refused(markers({lines}), "has action 9"), Code::unsupported);
}

TEST(TrackReport, RefusesMoreTracksThanAreAllowed) {
  std::vector<Marker> many;
  for (int id = 0; id < 10000; ++id) many.push_back(marker(id, id, kStamp));
  EXPECT_EQ(refused(markers(many), "10000 tracks; at most 100 are allowed (max_tracks"), Code::limit);
  EXPECT_EQ(refused(poses(std::vector<double>(101), kStamp), "101 tracks", people(TrackerType::poses)), Code::limit);
  many.push_back(deletingAll());
  EXPECT_EQ(refused(markers(many), ""), Code::ok) << "only those that are left count";
}

TEST(TrackReport, RefusesBytesThatAreNoMessage) {
  for (const TrackerType type : {TrackerType::markers, TrackerType::poses}) {
    const std::string bytes =
        type == TrackerType::markers ? serialized(markers({marker(1, 1.0, kStamp)})) : serialized(poses({1.0}, kStamp));
    EXPECT_NO_THROW(readTrackReport(bytes, people(type), kNow, 0.5));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_THROW(readTrackReport(bytes.substr(0, size), people(type), kNow, 0.5), Refusal) << size;
    }
    std::string longer = bytes;
    longer.replace(type == TrackerType::markers ? 0 : 20, 4, bytesOf(std::uint32_t{0xffffffff}));
    EXPECT_THROW(readTrackReport(longer, people(type), kNow, 0.5), Refusal) << "a length beyond the message";
  }
}

/// Transforms of a camera that moves along x: at the time t it is at x = t.
class PlacedReports : public ::testing::Test {
 protected:
  PlacedReports() {
    for (const double time : {999.0, 1000.0}) {
      tf2_msgs::TFMessage message;
      message.transforms.resize(1);
      geometry_msgs::TransformStamped& transform = message.transforms[0];
      transform.header.frame_id = "world";
      transform.header.stamp = ros::Time(time);
      transform.child_frame_id = "eye";
      transform.transform.translation.x = time;
      transform.transform.rotation.x = transform.transform.rotation.w = std::sqrt(0.5);
      intake_.take(viewsOf(message), false, "/driver", moment(time, time));
    }
  }
  Code refused(const TrackReport& report, double limit = 1e6) {
    try {
      placedInWorld(report, intake_.lookup(), "world", false, limit);
    } catch (const Refusal& refusal) {
      return refusal.code();
    }
    return Code::ok;
  }

  Ledger ledger_;
  TfIntake intake_{0.5, 10.0, 100, false, ledger_};
};

TEST_F(PlacedReports, AreWhereTheirFrameWasAtTheirStamp) {
  const TrackReport report =
      read(markers({marker(1, 5.0, ros::Time(999.5), "eye"), marker(2, 7.0, ros::Time(999.25), "world")}), people());
  const auto placed = placedInWorld(report, intake_.lookup(), "world", false, 1e6);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_NEAR(placed[0].world_from_track.translation().x(), 1004.5, 1e-9);
  EXPECT_NEAR(placed[0].world_from_track(2, 1), 1.0, 1e-9) << "turned with the camera";
  EXPECT_EQ(placed[1].world_from_track.translation().x(), 7.0);
  EXPECT_EQ(placed[1].stamp, s(999.25));
  const auto upright = placedInWorld(report, intake_.lookup(), "world", true, 1e6);
  EXPECT_TRUE(upright[0].world_from_track.linear().isIdentity());
  EXPECT_NEAR(upright[0].world_from_track.translation().x(), 1004.5, 1e-9);
}

TEST_F(PlacedReports, AreRefusedIfTheirPlaceIsNotKnown) {
  EXPECT_EQ(refused(read(markers({marker(1, 5.0, kStamp, "nowhere")}), people())), Code::unknown_frame);
  EXPECT_EQ(refused(read(markers({marker(1, 5.0, ros::Time(1000.25), "eye")}), people())), Code::extrapolation);
  EXPECT_EQ(refused(read(markers({marker(1, 5.0, ros::Time(900.0), "eye")}), people())), Code::extrapolation);
  EXPECT_EQ(refused(read(markers({marker(1, 200.0, kStamp, "world")}), people()), 100.0), Code::out_of_range);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
