// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <geometry_msgs/PoseArray.h>
#include <hgrid_proximity/ApplyObstacles.h>
#include <hgrid_proximity/CheckEdges.h>
#include <hgrid_proximity/CheckStates.h>
#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/DistanceField.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/Guard.h>
#include <hgrid_proximity/ListScenes.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <hgrid_proximity/LoadScene.h>
#include <hgrid_proximity/QueryBatch.h>
#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QueryShape.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/ReloadRobot.h>
#include <hgrid_proximity/SaveScene.h>
#include <hgrid_proximity/SetAllowed.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstring>

#include "src/node/tf/transform_check.h"
#include "src/node/tracks/track_report.h"
#include "src/node/wire/checked.h"
#include "src/node/wire/from_messages.h"
#include "src/node/wire/octomap_message.h"
#include "src/node/wire/transform_slices.h"
#include "test/fuzz/byte_source.h"
#include "test/fuzz/targets.h"
#include "test/node/support/random_message.h"
#include "test/node/support/raw_message.h"
#include "test/node/support/transform_views.h"
#include "test/support/counted_allocations.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

namespace msg = ::hgrid_proximity;

constexpr std::size_t kSentence = 2048;  // [bytes] memory that an error sentence may allocate

// flawOfUse() converts an accepted message as the node does. It returns what is wrong with the result, and throws
// Refusal if the message is refused.

template <class Message>
std::string flawOfUse(const Message&, const std::string&) {
  return {};
}
std::string flawOfUse(const msg::QueryBox::Request& request, const std::string&) {
  return fromPose(request.pose, "the query's box").matrix().allFinite() ? "" : "a pose is not finite";
}
std::string flawOfUse(const msg::QueryShape::Request& request, const std::string&) {
  const Pose pose = fromPose(request.shape.pose, "the query's shape");
  const Shape shape = fromShape(request.shape, ShapeLimits{}, 1000000);
  if (!pose.matrix().allFinite()) return "a pose is not finite";
  return isValid(boxOf(shape, Pose::Identity(), 0.0, Eigen::Vector3d::Zero())) ? "" : "a shape is not valid";
}
bool isSame(const TransformView& a, const TransformView& b) {
  return a.parent == b.parent && a.child == b.child && a.stamp == b.stamp &&
         std::memcmp(a.translation.data(), b.translation.data(), sizeof a.translation) == 0 &&
         std::memcmp(a.rotation.data(), b.rotation.data(), sizeof a.rotation) == 0;
}
std::string flawOfUse(const tf2_msgs::TFMessage& message, const std::string& bytes) {
  TransformSlices slices(bytes);
  std::vector<TransformView> slice;
  std::size_t read = 0;
  while (slices.left()) {
    slices.next(slice);
    for (const TransformView& transform : slice) {
      if (read >= message.transforms.size() || !isSame(transform, test::viewOf(message.transforms[read++])))
        return "the slices are not the message";
    }
  }
  if (read != message.transforms.size()) return "the slices are not the whole message";
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    checkTransform(test::viewOf(transform), false, Moment{std::chrono::seconds(1000), {}}, 0.5);
    const geometry_msgs::Vector3& at = transform.transform.translation;
    const geometry_msgs::Quaternion& q = transform.transform.rotation;
    if (!Eigen::Vector3d(at.x, at.y, at.z).allFinite()) return "a translation is not finite";
    const double norm = Eigen::Vector4d(q.x, q.y, q.z, q.w).squaredNorm();
    if (!(std::abs(norm - 1.0) < 0.1)) return "a rotation is not normalized";
  }
  return {};
}

std::string flawOfReport(const std::string& bytes, TrackerType type) {
  TrackerParams tracker;
  tracker.name = "people";
  tracker.type = type;
  const TrackReport report = readTrackReport(bytes, tracker, Moment{std::chrono::seconds(1000), {}}, 0.5);
  if (report.poses.size() > static_cast<std::size_t>(tracker.max_tracks)) return "there are too many tracks";
  for (const TrackReport::Reported& pose : report.poses) {
    if (!pose.frame_from_track.matrix().allFinite()) return "a pose is not finite";
    if (pose.id.empty() != (type == TrackerType::poses)) return "an id is wrong";
  }
  return {};
}
std::string flawOfUse(const visualization_msgs::MarkerArray&, const std::string& bytes) {
  return flawOfReport(bytes, TrackerType::markers);
}
std::string flawOfUse(const geometry_msgs::PoseArray&, const std::string& bytes) {
  return flawOfReport(bytes, TrackerType::poses);
}

template <class Message>
FuzzResult readBytes(const std::string& bytes) {
  Checked<Message> message;
  const std::size_t before = allocatedBytes();
  message.read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (allocatedBytes() - before > 64 * bytes.size() + kSentence) return {false, "too much memory was allocated"};
  try {
    if (serialized(message.value()) != bytes) return {true, "it was read as another message"};
    return {true, flawOfUse(message.value(), bytes)};
  } catch (const Refusal& refusal) {
    return {false, flawOfRefusal(refusal)};
  }
}

/// Fills the fields of a message from the input, serializes it and reads it. The lengths in such a message are correct,
/// so the reader must accept them.
template <class Message>
FuzzResult readFilled(std::string_view input) {
  const std::string bytes = serialized(FilledMessage<ByteSource>(ByteSource(input)).make<Message>());
  if (!flawOf<Message>(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()).empty()) {
    return {false, "a valid message was refused"};
  }
  return readBytes<Message>(bytes);
}

template <class Message>
FuzzResult readAs(std::string_view input, bool filled) {
  return filled ? readFilled<Message>(input) : readBytes<Message>(std::string(input));
}

FuzzResult readOctomap(std::string_view input, bool) {
  const std::string bytes(input);
  const std::size_t before = allocatedBytes();
  const OctomapMessage message = readOctomapMessage(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (allocatedBytes() - before > 64 * bytes.size() + kSentence) return {false, "too much memory was allocated"};
  if (!message.flaw.empty()) return {false, flawOfSentence(message.flaw)};
  const std::size_t at_binary = 16 + message.frame.size();
  const std::string copy = bytes.substr(0, 4) + bytesOf(message.stamp.sec) + bytesOf(message.stamp.nsec) +
                           stringOf(message.frame) + bytes.substr(at_binary, 1) + stringOf(message.id) +
                           bytesOf(message.resolution) + stringOf(message.data);
  const bool same = copy == bytes && message.binary == (bytes[at_binary] != 0);
  return {true, same ? "" : "it was read as another message"};
}

using Read = FuzzResult (*)(std::string_view input, bool filled);

constexpr Read kKinds[] = {
    readAs<tf2_msgs::TFMessage>,
    readOctomap,
    readAs<msg::ApplyObstacles::Request>,
    readAs<msg::CheckEdges::Request>,
    readAs<msg::CheckStates::Request>,
    readAs<msg::ClearMap::Request>,
    readAs<msg::DistanceField::Request>,
    readAs<msg::ExplainPair::Request>,
    readAs<msg::GetAllowed::Request>,
    readAs<msg::Guard::Request>,
    readAs<msg::LoadOctomap::Request>,
    readAs<msg::LoadScene::Request>,
    readAs<msg::QueryBatch::Request>,
    readAs<msg::QueryBox::Request>,
    readAs<msg::QueryNearest::Request>,
    readAs<msg::QuerySegment::Request>,
    readAs<msg::QueryShape::Request>,
    readAs<msg::QuerySphere::Request>,
    readAs<msg::ReloadRobot::Request>,
    readAs<msg::SaveScene::Request>,
    readAs<msg::SetAllowed::Request>,
    readAs<std_srvs::Trigger::Request>,
    readAs<visualization_msgs::MarkerArray>,
    readAs<geometry_msgs::PoseArray>,
    readAs<msg::ListScenes::Request>,
};

}  // namespace

FuzzResult fuzzWire(std::string_view input) {
  if (input.empty()) return {};
  const auto bits = static_cast<unsigned char>(input[0]);
  const std::size_t kind = bits & 0x7f;
  if (kind >= std::size(kKinds)) return {};
  return kKinds[kind](input.substr(1), bits & 0x80);
}

}  // namespace test
}  // namespace hgrid
