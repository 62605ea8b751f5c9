// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// Where an obstacle is: in a frame, which it follows, or where this frame was at a time.
struct ObstaclePlace {
  std::string frame;  ///< empty: the world frame
  Pose frame_from_body = Pose::Identity();
  /// The obstacle stays where the frame was at this time; 0: where it is at present; nullopt: it follows the frame
  std::optional<Time> at;
};

/// An obstacle as it was requested.
struct RequestedObstacle {
  Body body;  ///< complete, apart from frame, pose and mobility
  ObstaclePlace place;
  bool moving = false;       ///< whether it makes pairs with fixed bodies even if it follows the world frame
  bool lost_at_end = false;  ///< at the end of its lifetime, it becomes LOST; otherwise it is removed
  std::string owner;         ///< who added it
  std::chrono::nanoseconds lifetime{0};  ///< of ROS time, from its last change; 0: unlimited
};

/// How an obstacle is attached to a link of a robot.
struct Attachment {
  std::string link;                    ///< full name of the link, which may have no geometry: "robot/tool0"
  std::optional<Pose> link_from_body;  ///< nullopt: the obstacle keeps its present pose relative to the link
  std::vector<std::string> touch;      ///< globs over the names of bodies that may touch the obstacle
};

/// One change of one obstacle. Each change is created by the thread that received the request, and applied in a tick.
struct ObstacleChange {
  enum class Kind { add, move, remove, attach, detach };
  Kind kind;
  std::string name;                                ///< full name of the body: "obstacle/table"
  std::shared_ptr<const RequestedObstacle> added;  ///< for add
  bool replace = false;                            ///< for add: whether another obstacle of this name is replaced
  ObstaclePlace place;                             ///< for move
  std::shared_ptr<const Attachment> attachment;    ///< for attach
};

/// Changes that are applied together or not at all.
struct ObstacleChanges {
  std::vector<ObstacleChange> changes;  ///< in the order in which they are applied
  std::optional<std::string>
      complete_set_of;  ///< the obstacles of this owner that no change adds are removed; nullopt: none
};

/// A refusal of one of several changes.
class ChangeRefusal : public Refusal {
 public:
  /// @param index  the change that is refused, as an index into ObstacleChanges::changes
  ChangeRefusal(std::size_t index, const Refusal& why) : Refusal(why), index_(index) {}
  std::size_t index() const { return index_; }

 private:
  std::size_t index_;
};

}  // namespace hgrid
