// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/link_matrix.h"
#include "hgrid_proximity/geometry/pose.h"
#include "hgrid_proximity/geometry/shape.h"

namespace hgrid {

class Solid;

/// A point in time: nanoseconds since the epoch of ROS time.
using Time = std::chrono::nanoseconds;

/// Returns a duration in seconds.
inline double seconds(std::chrono::nanoseconds duration) { return std::chrono::duration<double>(duration).count(); }

/// How far the pose of a body can be trusted, from good to bad. The numbers are part of the interface: do not change
/// them.
enum class Freshness : std::uint8_t {
  fresh = 0,
  late = 1,
  stale = 2,
  lost = 3,
  frozen = 4,
  invalid = 5,
  unplaced = 6,
};

/// Returns the state as a word, such as "STALE".
const char* name(Freshness state);

/// Whether a body can move. A fixed body never moves in the world frame, and two fixed bodies are never a pair.
enum class Mobility : std::uint8_t { fixed = 0, moving = 1 };

/// The kind of a body. Maps and clouds have occupied cells instead of shapes. The cells of a cloud appear and expire,
/// and a cloud does not know which space is free. A track is a person or a vehicle that a tracker reports; it makes the
/// same pairs as a moving obstacle.
enum class BodyKind : std::uint8_t { link, obstacle, map, cloud, track };

/// Whether bodies of this kind have occupied cells instead of shapes.
inline bool hasCells(BodyKind kind) { return kind == BodyKind::map || kind == BodyKind::cloud; }

/// Whether PairKinds treats bodies of this kind as obstacles.
inline bool countsAsObstacle(BodyKind kind) { return kind == BodyKind::obstacle || kind == BodyKind::track; }

/// Handle of a body in a Scene. The scene stores each body in a slot of an array. It uses the slot of a removed body
/// again for a new body.
struct BodyId {
  std::uint32_t slot = 0;        ///< index of the slot
  std::uint32_t generation = 0;  ///< how many bodies used the slot before

  /// Whether both are the handle of the same body.
  bool operator==(const BodyId& other) const { return slot == other.slot && generation == other.generation; }
  /// Whether the handles are of different bodies.
  bool operator!=(const BodyId& other) const { return !(*this == other); }
};

/// One collision shape of a body. It becomes one proxy in the broad phase.
struct BodyShape {
  Shape shape;                                      ///< the shape in its own frame
  Pose body_from_shape = Pose::Identity();          ///< pose of the shape in the frame of the body
  double padding = 0.0;                             ///< [m] how much the shape is grown, >= 0
  std::string resource;                             ///< URI of the mesh file; empty if the shape is from no file
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< scale of the mesh file per axis
  std::shared_ptr<const Solid> solid = nullptr;     ///< the shape, prepared for exact distances; null: not measured
};

/// The description of a body, which does not change while the body moves.
struct Body {
  std::string name;                         ///< unique name of the form source/local
  std::string frame;                        ///< tf frame that the body follows
  Pose frame_from_body = Pose::Identity();  ///< pose of the body in `frame`; identity for links
  BodyKind kind = BodyKind::obstacle;       ///< link, obstacle, map, cloud or track
  Mobility mobility = Mobility::moving;     ///< whether the body can move in the world
  std::vector<BodyShape> shapes;            ///< may be empty, if no shape could be read
  double margin = 0.0;                      ///< [m] margin of this body; a larger global margin takes precedence
  double max_speed = std::numeric_limits<double>::infinity();  ///< [m/s] expected largest speed of its points
  /// [m/s] Guaranteed largest speed of its points; infinite if there is no guarantee. It bounds the time until a
  /// contact is possible. Where it is infinite, max_speed does, and the pair is flagged (NoContact::assumed).
  double speed_bound = std::numeric_limits<double>::infinity();
  bool covered = true;  ///< whether every shape in the description of the body could be read
  bool waived = false;  ///< whether the body is not covered, but the user accepts this
  std::string note;     ///< why the body is not covered, why the user accepts this, or RESTORED

  /// Name of the group, only for obstacles: obstacles of one group make no pairs with each other. Empty: no group.
  std::string group = {};

  std::string robot;                        ///< name of the robot, only for links
  std::uint32_t link = 0;                   ///< index in the robot's model, only for links
  std::uint32_t rigid_group = 0;            ///< index of the rigid group in the robot's model, only for links
  std::shared_ptr<const LinkMatrix> links;  ///< allowed pairs of the robot, only for links; equal robots share it
};

}  // namespace hgrid
