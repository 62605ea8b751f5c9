// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// Largest number of shapes of one obstacle.
inline constexpr std::size_t kMostShapes = 1000;

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

/// Returns whether `name`, with or without the robot, is the name of the link "robot/link".
inline bool isNameOfLink(const std::string& name, const std::string& link) {
  return name == link || name == link.substr(std::min(link.size(), link.find('/') + 1));
}

/// How an obstacle is attached to a link of a robot.
struct Attachment {
  std::string link;                      ///< full name of the link, which may have no geometry: "robot/tool0"
  bool without_robot = false;            ///< whether `link` may also be a name without robot: "tool0"
  std::optional<Pose> link_from_body;    ///< nullopt: the obstacle keeps its present pose relative to the link
  std::vector<std::string> touch;        ///< globs over the names of bodies that may touch the obstacle
  std::vector<std::string> touch_links;  ///< names, without robot, of links of the same robot that may touch it
  std::string owner;                     ///< who attached it
};

/// One change of one obstacle, or of all obstacles of an owner. Each change is created by the thread that received the
/// request, and applied in a tick.
struct ObstacleChange {
  enum class Kind {
    add,
    append,  ///< adds the shapes of `added` to the obstacle, or adds the obstacle if there is none
    move,
    remove,
    remove_all_free,  ///< removes the obstacles of `owner` that are not attached
    attach,
    detach,
    detach_all,  ///< detaches what `owner` attached to `link`; empty: to any link
  };
  Kind kind = Kind::add;
  std::string name;                                ///< full name of the body: "obstacle/table"
  std::shared_ptr<const RequestedObstacle> added;  ///< for add and append
  bool replace = false;                            ///< for add: whether another obstacle of this name is replaced
  bool free_only = false;  ///< for add, append and remove: whether the change is refused if the obstacle is attached
  ObstaclePlace place;     ///< for move
  std::vector<Pose> shape_poses;  ///< for move: new poses of all shapes in the frame of the body; empty: unchanged
  std::shared_ptr<const Attachment> attachment;  ///< for attach
  bool in_set = false;                           ///< for attach: whether the obstacle belongs to a complete set
  std::string owner, link;                       ///< for remove_all_free and detach_all
};

/// Changes that are applied together or not at all.
struct ObstacleChanges {
  std::vector<ObstacleChange> changes;  ///< in the order in which they are applied
  /// The obstacles of this owner that no change adds are removed; nullopt: none. See also in_set.
  std::optional<std::string> complete_set_of;
  bool spare_attached = false;  ///< whether the complete set keeps attached obstacles
  bool complete = false;        ///< whether all obstacles that no change adds are removed, whoever owns them
  /// Whether each change is about one obstacle alone, so that no other obstacle of its group moves. The obstacles of a
  /// group must still move together after the last change.
  bool without_groups = false;
};

/// Returns the full names of the obstacles that the changes may add.
inline std::vector<std::string> addedNames(const ObstacleChanges& changes) {
  std::vector<std::string> names;
  for (const ObstacleChange& change : changes.changes) {
    if (change.added) names.push_back(change.name);
  }
  return names;
}

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
