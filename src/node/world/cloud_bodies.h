// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "node/health/ledger.h"
#include "node/params/params.h"
#include "node/sources/cloud_news.h"
#include "node/sources/source_id.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Keeps the bodies of clouds in the scene up to date: their cells, poses and states.
class CloudBodies {
 public:
  /// @param simulated  whether /clock drives ROS time
  CloudBodies(const Params& params, bool simulated, Scene& scene, Ledger& ledger);

  /// Replaces the cells of a cloud. The first call for a cloud adds its body. If this throws, nothing has changed.
  /// @throws Refusal as Scene::add() and Scene::setCells()
  void set(const SourceId& cloud, const LoadedCloud& loaded, const std::string& world_frame);
  /// Notes that a message of the cloud could not be used. @returns false if the cloud is not in the world
  bool noteRefused(const SourceId& cloud, const std::string& sentence);
  /// Updates the pose and state of every cloud. Appends to the troubles of `tick`, and to `gaps` for each cloud that is
  /// LOST or worse.
  void update(const Moment& now, bool clock_frozen, Tick& tick, std::vector<SourceGap>& gaps);

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
