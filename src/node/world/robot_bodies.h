// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "node/sources/robot_change.h"
#include "node/sources/source_id.h"
#include "node/world/link_paddings.h"
#include "node/world/missing_sources.h"
#include "node/world/movers.h"
#include "node/world/robot_models.h"

namespace hgrid {

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
  /// @throws Refusal limit (~max_bodies), or as Scene::exchange()
  void set(LoadedRobot robot);
  /// Applies changes of robots, all of them or none. @param world_frame  empty: not known yet
  /// @throws ChangeRefusal as edit() and checkSharesRoot(), or limit (~max_bodies); Refusal as Scene::exchange()
  void apply(const RobotChanges& changes, const std::string& world_frame);
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
  using Robots = std::vector<std::shared_ptr<const LoadedRobot>>;

  const LoadedRobot* findTooLarge(const RobotEntries& next) const;
  void exchange(RobotEntries next, const std::function<bool(const SourceId&)>& leaves_too = nullptr);
  void replace(const std::function<bool(const SourceId&)>& leaves, const Robots& coming);
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
