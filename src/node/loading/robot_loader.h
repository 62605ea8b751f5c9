// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/refusal.h"
#include "node/diagnostics/node_health.h"
#include "node/loading/pending_loads.h"
#include "node/params/params.h"
#include "node/sources/robot_source.h"
#include "node/tick/tick_jobs.h"

namespace hgrid {

/// Puts the configured robots into the world and remembers which of them are still missing. One thread, not that of the
/// ticks.
class RobotLoader {
 public:
  /// All robots are missing at first. The parameters must outlive this object.
  RobotLoader(const RobotSource& source, const Params& params, TickJobs& jobs, NodeHealth& health);

  bool hasMissing() const { return !missing_.empty(); }
  /// Tries to load every robot that is missing. Each that fails is reported in the log, by ~status and by /diagnostics.
  void loadMissing();

  /// Loads the robot of this name again, or all robots if the name is empty. A robot that fails keeps its old model.
  /// @returns ok; unknown_id if there is no such robot; otherwise why the last robot that failed did
  Refusal reload(const std::string& name);

 private:
  Refusal load(const RobotParams& robot);
  void noteFailed(const RobotParams& robot, const Refusal& why);

  const RobotSource& source_;
  const Params& params_;
  TickJobs& jobs_;
  NodeHealth& health_;
  PendingLoads<const RobotParams*> missing_;
};

}  // namespace hgrid
