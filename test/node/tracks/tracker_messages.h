// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/PoseArray.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "src/node/tracks/placed_report.h"
#include "test/node/support/moments.h"
#include "test/node/support/raw_message.h"

namespace hgrid {
namespace test {

using visualization_msgs::Marker;

inline geometry_msgs::Pose trackPoseAt(double x, double y = 0.0, double z = 0.0) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  pose.position.y = y;
  pose.position.z = z;
  pose.orientation.w = 1.0;
  return pose;
}

inline Marker marker(int id, double x, ros::Time stamp, const std::string& frame = "base", const std::string& ns = "") {
  Marker marker;
  marker.header.frame_id = frame;
  marker.header.stamp = stamp;
  marker.ns = ns;
  marker.id = id;
  marker.type = Marker::CYLINDER;
  marker.pose = trackPoseAt(x);
  return marker;
}

inline Marker deleting(int id, const std::string& ns = "") {
  Marker marker;
  marker.ns = ns;
  marker.id = id;
  marker.action = Marker::DELETE;
  return marker;
}

inline Marker deletingAll() {
  Marker marker;
  marker.action = Marker::DELETEALL;
  return marker;
}

inline visualization_msgs::MarkerArray markers(const std::vector<Marker>& list) {
  visualization_msgs::MarkerArray array;
  array.markers = list;
  return array;
}

/// Returns poses at these x [m].
inline geometry_msgs::PoseArray poses(const std::vector<double>& xs, ros::Time stamp,
                                      const std::string& frame = "base") {
  geometry_msgs::PoseArray array;
  array.header.stamp = stamp;
  array.header.frame_id = frame;
  for (const double x : xs) array.poses.push_back(trackPoseAt(x));
  return array;
}

/// Returns a tracker "people" whose tracks are capsules.
inline TrackerParams people(TrackerType type = TrackerType::markers) {
  TrackerParams tracker;
  tracker.name = "people";
  tracker.topic = "people";
  tracker.type = type;
  tracker.shapes.push_back({Shape::capsule(1.0, 0.3), Pose::Identity(), 0.0, {}, Eigen::Vector3d::Ones()});
  tracker.max_speed = 2.0;
  tracker.noise = 0.1;
  tracker.forget = 5.0;
  tracker.max_tracks = 100;
  return tracker;
}

/// Returns a report that has arrived when it was measured, at this moment [s]. `xs` are the poses [m].
inline TrackReport reportAt(double time, const std::vector<std::pair<std::string, double>>& xs, bool has_ids) {
  TrackReport report;
  report.arrival = moment(1000.0 + time, 50.0 + time);
  report.stamp = report.arrival.ros;
  report.has_ids = has_ids;
  for (const auto& [id, x] : xs) {
    TrackReport::Reported pose;
    pose.id = id;
    pose.stamp = report.stamp;
    pose.frame_from_track.translation().x() = x;
    report.poses.push_back(pose);
  }
  return report;
}

/// Returns the poses of a report whose frames are all the world frame.
inline std::vector<PlacedReport> placed(const TrackReport& report) {
  std::vector<PlacedReport> placed;
  for (const TrackReport::Reported& pose : report.poses) placed.push_back({pose.id, pose.stamp, pose.frame_from_track});
  return placed;
}

}  // namespace test
}  // namespace hgrid
