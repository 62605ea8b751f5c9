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

/// The state as a word, as in "STALE".
const char* name(Freshness state);

/// A fixed body never moves in the world frame: two fixed bodies make no pair.
enum class Mobility : std::uint8_t { fixed = 0, moving = 1 };

/// What a body is, by its source.
enum class BodyKind : std::uint8_t { link, obstacle, map };

/// Handle of a body in a Scene: a slot, and how often the slot was used before.
struct BodyId {
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;
  bool operator==(const BodyId& other) const { return slot == other.slot && generation == other.generation; }
  bool operator!=(const BodyId& other) const { return !(*this == other); }
};

/// One collision shape of a body; it becomes one proxy in the grid.
struct BodyShape {
  Shape shape;
  Pose body_from_shape = Pose::Identity();
  double padding = 0.0;                             ///< [m] >= 0
  std::string resource;                             ///< URI of a mesh file; empty otherwise
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();  ///< of the mesh file
  std::shared_ptr<const Solid> solid = nullptr;     ///< for exact distances; null: none of this shape are measured
};

/// What is known of a body and does not change while it moves.
struct Body {
  std::string name;                         ///< source/local, unique
  std::string frame;                        ///< tf frame that it follows
  Pose frame_from_body = Pose::Identity();  ///< in that frame; identity for links
  BodyKind kind = BodyKind::obstacle;
  Mobility mobility = Mobility::moving;
  std::vector<BodyShape> shapes;  ///< may be empty: every shape was unreadable
  double margin = 0.0;            ///< [m] its own margin; the global one where that is larger
  double max_speed = std::numeric_limits<double>::infinity();  ///< [m/s] bound of the speed of its points
  /// [m/s] the same where somebody vouches for it; bounds of time to contact rest on it alone. Infinite: nobody does.
  double speed_bound = std::numeric_limits<double>::infinity();
  bool covered = true;  ///< every shape that its description has was read
  bool waived = false;  ///< not covered, but accepted by the user
  std::string note;     ///< why it is not covered, or the reason of the waiver

  std::string robot;                        ///< links: name of the robot
  std::uint32_t link = 0;                   ///< links: index in the robot's model
  std::uint32_t rigid_group = 0;            ///< links: those with equal numbers move as one
  std::shared_ptr<const LinkMatrix> links;  ///< links: the model's matrix; equal robots share it
};

/// Whether a body of kind map is a cloud, whose cells come and go and say nothing of space that is free.
inline bool isCloud(const Body& body) { return body.name.compare(0, 6, "cloud/") == 0; }

}  // namespace hgrid
