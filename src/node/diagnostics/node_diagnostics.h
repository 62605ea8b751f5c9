// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/tick/world.h"

namespace hgrid {

/// What /diagnostics is told besides the newest tick.
struct NodeHealth {
  std::map<std::string, std::string> failed_loads;  // sentence by robot: the last reading of its description failed
  std::size_t late_ticks_in_a_row = 0;
  std::uint64_t failed_ticks = 0;      // since the node was started
  std::optional<Refusal> failed_tick;  // why the last tick failed; nullopt if it did not
  std::vector<std::string> conflicts;  // frames on /tf and /tf_static
};

/// The four statuses of /diagnostics (REP-107): world, robots, transforms, ticks. For people and dashboards; a stop
/// path listens to ~pairs and ~status. One thread.
class NodeDiagnostics {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;

  NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const std::string& name, NewestTick newest,
                  std::function<NodeHealth()> health);
  /// Publishes now, whatever the clock says.
  void update() { updater_.force_update(); }

 private:
  void world(diagnostic_updater::DiagnosticStatusWrapper& status);
  void robots(diagnostic_updater::DiagnosticStatusWrapper& status);
  void transforms(diagnostic_updater::DiagnosticStatusWrapper& status);
  void ticks(diagnostic_updater::DiagnosticStatusWrapper& status);

  NewestTick newest_;
  std::function<NodeHealth()> health_;
  diagnostic_updater::Updater updater_;
};

}  // namespace hgrid
