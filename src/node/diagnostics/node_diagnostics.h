// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <functional>
#include <memory>
#include <string>

#include "node/diagnostics/node_health.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Publishes the four statuses of /diagnostics (REP-107): world, robots, transforms, ticks. They are for people and
/// dashboards; a program that stops a robot must use ~pairs and ~status. One thread.
class NodeDiagnostics {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;

  NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const std::string& name, NewestTick newest,
                  const NodeHealth& health);
  /// Publishes now. The updater itself would wait for its period.
  void update() { updater_.force_update(); }

 private:
  void world(diagnostic_updater::DiagnosticStatusWrapper& status);
  void robots(diagnostic_updater::DiagnosticStatusWrapper& status);
  void transforms(diagnostic_updater::DiagnosticStatusWrapper& status);
  void ticks(diagnostic_updater::DiagnosticStatusWrapper& status);

  NewestTick newest_;
  const NodeHealth& health_;
  diagnostic_updater::Updater updater_;
};

}  // namespace hgrid
