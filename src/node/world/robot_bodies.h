// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "node/robots/robot_change.h"
#include "node/sources/source_id.h"
#include "node/world/link_paddings.h"
#include "node/world/missing_sources.h"
#include "node/world/movers.h"
#include "node/world/robot_models.h"

namespace hgrid {

/// Models of robots.
using RobotList = std::vector<std::shared_ptr<const LoadedRobot>>;

/// The bodies of a change of robots, made before the tick that applies the change.
struct PreparedRobotBodies {
  std::set<std::string> leaving;  ///< names of the robots whose bodies leave
  RobotList coming;               ///< the robots whose bodies come
  NewMovers movers;               ///< of `coming`; they hold the prepared bodies
};

/// The robots of the world: their models, and their links as bodies of the scene.
///
/// Each change also updates the missing sources: they say what each robot lacks. A call that throws, even because
/// memory ran out, changes nothing.
class RobotBodies {
 public:
  /// At first, no robot is loaded. All references must outlive this object.
  /// @param stored  what an earlier run of the node changed
  RobotBodies(const Params& params, const StoredRobots& stored, const Scene& scene, Movers& movers,
              MissingSources& missing);

  /// Returns the robots, also those that are absent or not loaded.
  const RobotModels& models() const { return models_; }

  /// Replaces the model of the robot of the same name, or adds a robot. An absent robot stays absent.
  /// @throws Refusal limit (~limits/max_bodies), or as Scene::exchange()
  /// @param robot     not null
  /// @param prepared  result of prepare(); null: none. It is not used if setPaddings() gave paddings to links, or if it
  ///                  was made for another change.
  void set(std::shared_ptr<const LoadedRobot> robot, PreparedRobotBodies* prepared = nullptr);
  /// Applies changes of robots, all of them or none. @param world_frame  empty: not known yet
  /// @throws ChangeRefusal as edit() and checkSharesRoot(), or limit (~limits/max_bodies); Refusal as Scene::exchange()
  /// @param prepared  as above
  void apply(const RobotChanges& changes, const std::string& world_frame, PreparedRobotBodies* prepared = nullptr);
  /// Prepares the bodies of robots for set() or apply(), so that they take less time. Any thread may call this.
  /// @param before  the robots of the tick with the snapshot
  /// @param after   the robots after the change
  /// @param newest  snapshot of the newest tick
  /// @param scene   that of the movers
  /// @throws Refusal as Scene::prepare()
  static std::shared_ptr<PreparedRobotBodies> prepare(const RobotEntries& before, const RobotEntries& after,
                                                      const Snapshot& newest, const Scene& scene);
  /// Notes why the newest description of a robot could not be used. Does nothing if the robot was removed, or is absent
  /// and not loaded.
  void noteRefused(const std::string& robot, const std::string& sentence);
  /// Restores the robots of ~robots. Robots that were removed must be loaded again.
  /// @param leaves_too  returns whether another source leaves the world at the same time
  /// @throws Refusal as Scene::exchange()
  void reset(const std::function<bool(const SourceId&)>& leaves_too);

  /// Replaces the paddings of links that were set at run time. The next padLinks() applies them.
  void setPaddings(LinkPaddings paddings) noexcept;
  const LinkPaddings& paddings() const { return paddings_; }
  /// Gives the links in the world their paddings, if setPaddings() changed them. @throws Refusal as Scene::exchange()
  void padLinks();

 private:
  const LoadedRobot* findTooLarge(const RobotEntries& next) const;
  void exchange(RobotEntries next, PreparedRobotBodies* prepared,
                const std::function<bool(const SourceId&)>& leaves_too = nullptr);
  NewMovers moversOf(const RobotList& coming) const;
  bool hasOtherPadding(const Body& link) const;

  const Params& params_;
  const Scene& scene_;
  Movers& movers_;
  MissingSources& missing_;
  RobotModels models_;
  LinkPaddings paddings_;
  bool paddings_changed_ = false;  // since the last padLinks()
};

}  // namespace hgrid
