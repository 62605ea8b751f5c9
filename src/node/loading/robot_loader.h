// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "hgrid_proximity/refusal.h"
#include "node/diagnostics/node_health.h"
#include "node/loading/description_watch.h"
#include "node/loading/pending_loads.h"
#include "node/params/params.h"
#include "node/sources/robot_source.h"
#include "node/tick/tick_jobs.h"

namespace hgrid {

/// Puts the configured robots into the world, and stores which of them are still missing. Only one thread may use this
/// object. The tick thread must not use it.
class RobotLoader {
 public:
  /// At first, all robots are missing. All parameters must outlive this object.
  RobotLoader(const RobotSource& source, const Params& params, TickJobs& jobs, NodeHealth& health);

  bool hasMissing() const { return !missing_.empty(); }
  /// Tries to load every missing robot. Each failure is reported in the log, on ~status and on /diagnostics.
  void loadMissing();

  /// Loads the robot of this name again, or all robots if the name is empty. If a load fails, the old model stays.
  /// @returns ok; unknown_id if there is no such robot; otherwise the reason of the last failure
  Refusal reload(const std::string& name);

  /// Loads each robot whose description has changed. If a load fails, the old model of this robot stays, and the next
  /// loadMissing() tries again.
  void loadChanged();

 private:
  Refusal loadAgain(const RobotParams& robot);
  Refusal load(const RobotParams& robot);
  void noteFailed(const RobotParams& robot, const Refusal& why);

  const RobotSource& source_;
  const Params& params_;
  TickJobs& jobs_;
  NodeHealth& health_;
  PendingLoads<const RobotParams*> missing_;
  DescriptionWatch watch_;
};

}  // namespace hgrid
