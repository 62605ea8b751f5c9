// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <tuple>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/bodies/source.h"

namespace hgrid {

/// The kinds of sources, which bring bodies into the world.
enum class SourceKind { robot, obstacle, map, cloud, tracker };

/// Identifies a robot, an obstacle, a map, a cloud or a tracker.
struct SourceId {
  SourceKind kind;
  std::string name;  ///< name of the robot, "track/name" for a tracker, or full name of the one body of another source
  /// Which group of obstacles it is; empty: a single source. The obstacle "*" has the name of a group, but no group.
  std::string group{};

  static SourceId ofRobot(const std::string& name) { return {SourceKind::robot, name}; }
  /// @param body  full name of the body, for example "obstacle/post"
  static SourceId ofObstacle(const std::string& body) { return {SourceKind::obstacle, body}; }
  /// Returns the obstacles of which some may be missing, but nobody knows which. @param group  where they come from
  static SourceId ofObstacles(const std::string& group) { return {SourceKind::obstacle, "obstacle/*", group}; }
  /// @param local  configured name of the map, as in MapParams::name
  static SourceId ofMap(const std::string& local) { return {SourceKind::map, joined("map", local)}; }
  /// @param local  configured name of the cloud, as in CloudParams::name
  static SourceId ofCloud(const std::string& local) { return {SourceKind::cloud, joined("cloud", local)}; }
  /// @param local  configured name of the tracker, as in TrackerParams::name
  static SourceId ofTracker(const std::string& local) { return {SourceKind::tracker, joined("track", local)}; }
};

/// Compares by name and group. No two sources have both in common, because no robot has one of the reserved names, such
/// as "map".
inline bool operator<(const SourceId& a, const SourceId& b) {
  return std::tie(a.name, a.group) < std::tie(b.name, b.group);
}
inline bool operator==(const SourceId& a, const SourceId& b) {
  return a.kind == b.kind && a.name == b.name && a.group == b.group;
}

/// Returns the SourceGap of a whole source that is missing or cannot be trusted. `sentence` says why. All obstacles
/// together are one source.
inline SourceGap gapOf(const SourceId& source, const std::string& sentence) {
  switch (source.kind) {
    case SourceKind::robot:
    case SourceKind::tracker:
      return {source.name, joined(source.name, "*"), sentence};
    case SourceKind::obstacle:
      return {"obstacle", source.name, sentence};
    case SourceKind::map:
    case SourceKind::cloud:
      break;
  }
  return {source.name, source.name, sentence};
}

}  // namespace hgrid
