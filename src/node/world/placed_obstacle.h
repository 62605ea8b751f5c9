// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/robots/robot_entry.h"
#include "node/sources/obstacle_change.h"
#include "node/tf/transform_lookup.h"

namespace hgrid {

/// What is needed to place an obstacle.
struct Surroundings {
  const Params& params;
  const std::string& world_frame;
  const TransformLookup& lookup;
  const RobotEntries& robots;
  Time now;  ///< ROS time
};

/// An obstacle of the world, and where it is.
struct PlacedObstacle {
  std::shared_ptr<const RequestedObstacle> what;
  std::string owner;
  ObstaclePlace asked;                      ///< its place as requested
  std::string frame;                        ///< the frame that it follows
  Pose frame_from_body = Pose::Identity();  ///< its pose in that frame
  Time ends = Time::max();                  ///< end of its lifetime [ROS time]; max: never
  bool lost = false;                        ///< whether its lifetime has ended, but it stays in the world
  bool restored = false;  ///< whether an earlier run of the node stored it, and nothing has confirmed it since
  std::shared_ptr<const Attachment> attachment;  ///< the link that it is attached to, and its pose there; null: none
  std::vector<std::string> touch;  ///< while it is attached: names and globs of the bodies that may touch it
  /// [m/s] Expected largest speed of its points, because they move with the link that it is attached to, or whose frame
  /// it follows. 0: there is no such link.
  double carrier_speed = 0.0;
};

/// Returns the tf frame that an obstacle follows. @param frame  as requested; empty: the world frame; see kPosesFrame
std::string followedFrame(const std::string& frame, const std::string& obstacle, const std::string& world_frame);

/// Returns the end of a lifetime that begins at `now` [ROS time]; Time::max(): never.
Time endOf(const RequestedObstacle& obstacle, Time now);

/// Returns the obstacle as a body of the scene.
Body bodyOf(const PlacedObstacle& obstacle, const std::string& world_frame);

///@{
/// Returns whether two obstacles are the same, apart from their places and owners.
bool isSame(const RequestedObstacle& a, const RequestedObstacle& b);
/// Returns whether both requests give the same place; false if the second has the stamp 0.
bool isSame(const ObstaclePlace& first, const ObstaclePlace& second);
/// Returns whether two obstacles are at the same place of the same frame.
bool isAtSamePlace(const PlacedObstacle& a, const PlacedObstacle& b);
///@}

///@{
/// Changes the place of an obstacle.
/// @throws Refusal out_of_range (~limits/world_limit); unknown_frame or extrapolation if the pose of a frame is not
/// known at the time for which it is needed, or older than ~stale_after
void put(PlacedObstacle& obstacle, const ObstaclePlace& place, const Surroundings& around);
/// @throws also bad_id, unknown_id if no robot has the link, and conflict if several robots have a link of this name
void attach(PlacedObstacle& obstacle, const Attachment& attachment, const Surroundings& around);
/// Adds the shapes of another obstacle, at its place. Later, both move as one body.
void append(PlacedObstacle& obstacle, const RequestedObstacle& added, const Surroundings& around);
/// @throws also conflict if the obstacle is not attached
void detach(PlacedObstacle& obstacle, const Surroundings& around);
///@}

/// @throws Refusal conflict unless both obstacles of a group follow the same frame, or are attached to the same link
void checkMoveTogether(const PlacedObstacle& added, const PlacedObstacle& other);

/// Moves an obstacle as one rigid body with another one of its group: to another place, or to or from a link.
/// @param before  the other obstacle before its change; it moves together with `obstacle`
/// @param after   the other obstacle after its change
/// @throws Refusal out_of_range (~limits/world_limit), bad_id if a name that is a glob would be attached
void carry(PlacedObstacle& obstacle, const PlacedObstacle& before, const PlacedObstacle& after,
           const Surroundings& around);

/// @throws Refusal unsupported if the obstacle has a plane and is not fixed in the world frame
void checkPlanes(const PlacedObstacle& obstacle, const std::string& world_frame);

/// Gives all shapes other poses in the frame of the body. @throws Refusal bad_geometry if there are more or fewer poses
void placeShapes(PlacedObstacle& obstacle, const std::vector<Pose>& poses);

/// Computes the place and the touch list of an attached obstacle again, after the model of its robot was replaced. If
/// the link does not exist any more, the obstacle stays as it is.
void follow(PlacedObstacle& obstacle, const RobotEntries& robots, const Params& params);

/// Returns the carrier_speed of an obstacle that is not attached.
double carrierSpeedOf(const PlacedObstacle& obstacle, const RobotEntries& robots, const std::string& world_frame,
                      const Params& params);

}  // namespace hgrid
