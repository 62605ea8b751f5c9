// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tracks/track_report.h"

#include <geometry_msgs/PoseArray.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <map>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/text/frame_names.h"
#include "node/time/ros_time.h"
#include "node/wire/checked.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

using visualization_msgs::Marker;

template <class Message>
Checked<Message> checked(const std::string& bytes) {
  Checked<Message> message;
  message.read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  return message;
}

/// Reads one message. Its functions throw as readTrackReport().
class Reader {
 public:
  Reader(const TrackerParams& tracker, const Moment& arrival, double max_future)
      : tracker_(tracker), max_future_(max_future) {
    if (arrival.ros.count() == 0) {
      throw Refusal(Code::clock, "it arrived while there was no ROS time yet (no message on /clock)");
    }
    report_.arrival = arrival;
  }

  TrackReport read(const geometry_msgs::PoseArray& message) {
    checkRoom(message.poses.size());
    const Time stamp = report_.stamp = checkedStamp(message.header.stamp, "the message");
    for (std::size_t i = 0; i < message.poses.size(); ++i) {
      add("", message.header.frame_id, stamp, message.poses[i], "pose " + std::to_string(i));
    }
    return std::move(report_);
  }

  TrackReport read(const visualization_msgs::MarkerArray& message) {
    std::map<std::string, const Marker*> newest;  // the markers that are there after the message, by id
    for (const Marker& marker : message.markers) take(marker, newest);
    checkRoom(newest.size());
    for (const auto& [id, marker] : newest) {
      const std::string what = "marker '" + printable(id) + "'";
      checkKind(*marker, what);
      const Time stamp = checkedStamp(marker->header.stamp, what);
      add(id, marker->header.frame_id, stamp, marker->pose, what);
      report_.stamp = std::max(report_.stamp, stamp);
    }
    report_.has_ids = true;
    if (newest.empty()) report_.stamp = report_.arrival.ros;
    return std::move(report_);
  }

 private:
  void checkRoom(std::size_t count) const {
    if (count <= static_cast<std::size_t>(tracker_.max_tracks)) return;
    throw Refusal(Code::limit, "it has " + std::to_string(count) + " tracks; at most " +
                                   std::to_string(tracker_.max_tracks) + " are allowed (max_tracks of this tracker)");
  }

  Time checkedStamp(const ros::Time& given, const std::string& what) {
    if (given.isZero()) {
      report_.unstamped = true;
      return report_.arrival.ros;
    }
    const Time stamp = fromRos(given);
    const double ahead = seconds(stamp - report_.arrival.ros);
    if (ahead <= max_future_) return stamp;
    throw Refusal(Code::clock, what + " is stamped " + secondsText(ahead) +
                                   " in the future; at most ~limits/max_future, " + secondsText(max_future_) +
                                   ", is allowed");
  }

  void take(const Marker& marker, std::map<std::string, const Marker*>& newest) {
    if (marker.action == Marker::DELETEALL) return newest.clear();
    if (!tracker_.namespaces.empty() && !matchesAny(tracker_.namespaces, marker.ns)) {
      ++report_.ignored;
      return;
    }
    const std::string id = (marker.ns.empty() ? "" : marker.ns + "/") + std::to_string(marker.id);
    if (marker.action == Marker::DELETE) {
      newest.erase(id);
    } else if (marker.action != Marker::ADD) {  // MODIFY is the same
      throw Refusal(Code::unsupported, "marker '" + printable(id) + "' has action " + std::to_string(marker.action) +
                                           "; it must be ADD (0), DELETE (2) or DELETEALL (3)");
    } else if (!newest.emplace(id, &marker).second) {
      throw Refusal(Code::dup_id, "it adds marker '" + printable(id) + "' twice; an id must be there only once");
    } else {
      checkLocal(joined(tracker_.name, id), "the id of a marker, after the name of the tracker,");
    }
  }

  /// Refuses markers that draw their points or many things, because their pose is not that of a person or a vehicle.
  static void checkKind(const Marker& marker, const std::string& what) {
    const bool is_list =
        (marker.type >= Marker::LINE_STRIP && marker.type <= Marker::POINTS) || marker.type == Marker::TRIANGLE_LIST;
    if (!is_list && marker.points.empty()) return;
    throw Refusal(Code::unsupported, what + " of type " + std::to_string(marker.type) +
                                         " draws points, so its pose is not that of a track; name the namespaces of "
                                         "tracks in 'namespaces' of this tracker");
  }

  void add(const std::string& id, const std::string& frame, Time stamp, const geometry_msgs::Pose& pose,
           const std::string& what) {
    const geometry_msgs::Quaternion& q = pose.orientation;
    if (q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0) ++report_.unrotated;
    report_.poses.push_back({id, frameOfData(frame, what), stamp, fromPose(pose, what)});
  }

  const TrackerParams& tracker_;
  const double max_future_;
  TrackReport report_;
};

}  // namespace

TrackReport readTrackReport(const std::string& bytes, const TrackerParams& tracker, const Moment& arrival,
                            double max_future) {
  Reader reader(tracker, arrival, max_future);
  if (tracker.type == TrackerType::poses) return reader.read(checked<geometry_msgs::PoseArray>(bytes).value());
  return reader.read(checked<visualization_msgs::MarkerArray>(bytes).value());
}

}  // namespace hgrid
