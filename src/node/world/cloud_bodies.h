// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/sources/cloud_news.h"
#include "node/sources/source_id.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Keeps the bodies of clouds in the scene up to date: their cells, their places and their states.
class CloudBodies {
 public:
  /// @param simulated  /clock drives ROS time
  CloudBodies(const Params& params, bool simulated, Scene& scene, Ledger& ledger);

  /// Replaces what a sensor has seen. Adds the body if this is the first message of the cloud. All of it or nothing.
  /// @throws Refusal as Scene::add() and Scene::setCells()
  void set(const SourceId& cloud, const LoadedCloud& loaded, const std::string& world_frame);
  /// A message of the cloud could not be used. @returns false if the cloud is not in the world
  bool noteRefused(const SourceId& cloud, const std::string& sentence);
  /// Judges all clouds. Appends to the troubles of `tick`, and a gap for each cloud that is lost.
  /// @param time  [ROS time] of the tick
  void update(Time time, const Moment& now, bool clock_frozen, Tick& tick, std::vector<SourceGap>& gaps);

 private:
  struct Cloud {
    BodyId body;
    CloudNews news;
  };
  Cloud& add(const SourceId& cloud, const std::string& world_frame);

  const Params& params_;
  bool simulated_;
  Scene& scene_;
  Ledger& ledger_;
  std::map<SourceId, Cloud> clouds_;
};

}  // namespace hgrid
