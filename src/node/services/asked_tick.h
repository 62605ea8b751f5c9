// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "node/services/envelope/service_envelope.h"
#include "node/tick/leases.h"
#include "node/tick/tick_history.h"

namespace hgrid {

/// Returns whether a request names its tick, by a lease or by a time in header.stamp. The age of a named tick does not
/// matter, so its answers never become UNKNOWN (OUTDATED).
template <class Request>
bool namesItsTick(const Request& request) {
  return request.lease.sequence != 0 || namesItsTime(request.header.stamp);
}

/// Chooses the tick that the lease or the stamp of a request names, or else the newest tick, and answers from it.
/// @throws Refusal conflict if the request has both a lease and a stamp
/// @throws Refusal not_ready before the first tick
/// @throws Refusal in the same cases as Leases::find() and TickHistory::at()
template <class Service>
void answerFromAskedTick(ServiceCall<Service>& call, Leases& leases, const TickHistory& history) {
  const auto& request = call.request;
  call.tick.snapshot();  // throws while there is no world
  std::shared_ptr<const Tick> tick = leases.find(request.lease, call.tick.get());
  if (namesItsTime(request.header.stamp)) {
    if (request.lease.sequence != 0) {
      throw Refusal(Code::conflict, "lease.sequence is " + std::to_string(request.lease.sequence) +
                                        " and header.stamp is " + text(request.header.stamp.toSec()) +
                                        " s; a request may have only one of them. Set the other one to 0");
    }
    tick = history.at(request.header.stamp, tick);
  }
  call.answerFrom(std::move(tick));
}

}  // namespace hgrid
