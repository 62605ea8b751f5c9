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

/// Whether a request with a header and a lease names the tick that it is about. Then the age of the tick does not
/// matter.
template <class Request>
bool namesItsTick(const Request& request) {
  return request.lease.sequence != 0 || namesItsTime(request.header.stamp);
}

/// Makes the response from the tick that the request asks for by its lease or by its stamp.
/// @throws Refusal conflict if it has both; what Leases::find() and TickHistory::at() throw; not_ready before the first
/// tick
template <class Service>
void answerFromAskedTick(ServiceCall<Service>& call, Leases& leases, const TickHistory& history) {
  const auto& request = call.request;
  call.tick.snapshot();  // throws while there is no world
  std::shared_ptr<const Tick> tick = leases.find(request.lease, call.tick.get());
  if (namesItsTime(request.header.stamp)) {
    if (request.lease.sequence != 0) {
      throw Refusal(Code::conflict, "the request names tick " + std::to_string(request.lease.sequence) +
                                        " in its lease and a time in header.stamp; set one of them to 0");
    }
    tick = history.at(request.header.stamp, tick);
  }
  call.answerFrom(std::move(tick));
}

}  // namespace hgrid
