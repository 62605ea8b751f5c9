// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/bodies/source.h"

namespace hgrid {

/// What a thing is that brings bodies into the world.
enum class SourceKind { robot, obstacle, map, cloud };

/// Identifies a robot, an obstacle, a map or a cloud.
struct SourceId {
  SourceKind kind;
  std::string name;  ///< the robot's name; otherwise the name of the one body

  static SourceId ofRobot(const std::string& name) { return {SourceKind::robot, name}; }
  /// @param body  full name of the body
  static SourceId ofObstacle(const std::string& body) { return {SourceKind::obstacle, body}; }
  /// @param local  name of the map as configured, as in MapParams::name
  static SourceId ofMap(const std::string& local) { return {SourceKind::map, joined("map", local)}; }
  /// @param local  name of the cloud as configured, as in CloudParams::name
  static SourceId ofCloud(const std::string& local) { return {SourceKind::cloud, joined("cloud", local)}; }
};

/// Orders by name. No two sources have the same name, because "obstacle", "map" and "cloud" cannot name a robot.
inline bool operator<(const SourceId& a, const SourceId& b) { return a.name < b.name; }
inline bool operator==(const SourceId& a, const SourceId& b) { return a.kind == b.kind && a.name == b.name; }

/// The gap that the whole source leaves because of what `sentence` says. All obstacles are one source.
inline SourceGap gapOf(const SourceId& source, const std::string& sentence) {
  switch (source.kind) {
    case SourceKind::robot:
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
