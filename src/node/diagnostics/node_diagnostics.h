// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <functional>
#include <memory>
#include <string>

#include "node/health/node_health.h"
#include "node/tick/newest_tick.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Publishes six statuses on /diagnostics (REP-107): world, robots, transforms, ticks, audit and state. They are for
/// people and dashboards. A program that stops a robot must use ~pairs and ~status instead. Only one thread at a time
/// may use it.
class NodeDiagnostics {
 public:
  NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const std::string& name, NewestTick newest,
                  const NodeHealth& health);
  /// Publishes immediately. Otherwise the updater would wait for the end of its period.
  void update() { updater_.force_update(); }

 private:
  void world(diagnostic_updater::DiagnosticStatusWrapper& status);
  void robots(diagnostic_updater::DiagnosticStatusWrapper& status);
  void transforms(diagnostic_updater::DiagnosticStatusWrapper& status);
  void ticks(diagnostic_updater::DiagnosticStatusWrapper& status);
  void audit(diagnostic_updater::DiagnosticStatusWrapper& status);
  void state(diagnostic_updater::DiagnosticStatusWrapper& status);

  NewestTick newest_;
  const NodeHealth& health_;
  diagnostic_updater::Updater updater_;
};

}  // namespace hgrid
