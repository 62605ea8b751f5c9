// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/reset_service.h"

#include <std_srvs/Trigger.h>

#include <utility>

#include "node/world/world.h"

namespace hgrid {

ResetService::ResetService(ServiceEnvelope& envelope, ChangeWorld change_world, Stopwatch& stopwatch) {
  server_ = envelope.serve<std_srvs::Trigger>("reset", [change = std::move(change_world),
                                                        &stopwatch](ServiceCall<std_srvs::Trigger>& call) {
    call.tick = AnswerTick(change([&stopwatch](World& world) {
      world.reset();
      stopwatch = Stopwatch();
    }));
    call.response.message = "the robots and obstacles are as configured, all counters are 0, and a new epoch has begun";
  });
}

}  // namespace hgrid
