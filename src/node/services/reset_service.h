// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/services/envelope/service_envelope.h"
#include "node/threads/stopwatch.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~reset (std_srvs/Trigger): restores the configured robots and obstacles, clears counters and timings, and
/// begins a new epoch.
class ResetService {
 public:
  /// @param envelope      must outlive this object
  /// @param change_world  changes the world, and has configured robots that were removed loaded again
  /// @param stopwatch     the stopwatch of the tick thread; must outlive this object
  ResetService(ServiceEnvelope& envelope, ChangeWorld change_world, Stopwatch& stopwatch);

 private:
  ros::ServiceServer server_;
};

}  // namespace hgrid
