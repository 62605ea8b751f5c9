// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/sources/obstacle_change.h"

namespace hgrid {

class World;

/// Notes which objects of MoveIt the world lacks or has at a wrong place, because a message about them was refused or
/// dropped. Only the tick thread may use this object.
class SceneGaps {
 public:
  /// Largest number of objects that are noted one by one.
  static constexpr std::size_t kMostNames = 1000;

  /// What the world does not know about an object.
  enum class Lack {
    shapes,  ///< the object, or some of its shapes. Only a message that adds or removes the object ends this.
    place,   ///< where it is, or whether it is attached. A message that moves, attaches or detaches it ends this, too.
  };
  struct Object {
    std::string name;  ///< full name of the obstacle; empty: not known, so only a complete scene ends this
    Lack lack;
    bool attached = false;  ///< whether MoveIt has attached it, so that a message about a free object does not end this
  };

  /// @param objects  what a message is about that could not be used
  /// @param why      why it could not be used
  void noteRefused(const std::vector<Object>& objects, const std::string& why);
  /// Notes that a message was applied.
  void noteApplied(const ObstacleChanges& changes);
  /// Notes that there is no object of this name any more, for MoveIt as well.
  void noteRemoved(const std::string& name) { eraseFree(lacks_.find(name)); }
  /// Notes that MoveIt has detached an object that is not attached in the world, or whose detachment was refused.
  void noteDetached(const std::string& name);

  /// Returns what is wrong; nullopt if nothing is.
  std::optional<std::string> sentence() const;

 private:
  struct Gap {
    Lack lack;
    bool attached;
  };
  using Gaps = std::map<std::string, Gap>;  // by full name

  void note(const ObstacleChange& change);
  void eraseFree(Gaps::iterator gap);
  void eraseFreeShapes();

  Gaps lacks_;
  bool others_ = false;  // whether other objects may be missing, too
  std::string why_;      // of the newest message that was refused
};

/// Lets the source "obstacle" be incomplete while there are gaps. Only the tick thread may call this.
void showGaps(const SceneGaps& gaps, World& world);

}  // namespace hgrid
