// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/validity_service.h"

#include <boost/function.hpp>
#include <utility>

#include "node/health/guarded.h"
#include "node/moveit/state_validity.h"
#include "node/wire/checked.h"

namespace hgrid {

ValidityService::ValidityService(ros::NodeHandle node, Commons& commons, NewestTick newest,
                                 const TransformLookup& transforms)
    : commons_(commons), newest_(std::move(newest)), transforms_(transforms) {
  using Event = ros::ServiceEvent<Checked<moveit::GetStateValidity::Request>, moveit::GetStateValidity::Response>;
  const boost::function<bool(Event&)> callback = [this](Event& event) {
    // If the request is refused, the call fails, because the response has no field for a reason.
    return !guarded(commons_.ledger, "moveit.validity_failed",
                    [&] { answer(event.getRequest().value(), event.getResponse()); });
  };
  server_ = node.advertiseService<Event>("check_state_validity", callback);
}

void ValidityService::answer(const moveit::GetStateValidity::Request& request,
                             moveit::GetStateValidity::Response& response) {
  StateValidity found = stateValidity(request, AnswerTick(newest_()), transforms_, commons_.narrow_phase);
  response = std::move(found.response);
  if (!found.unknown.empty()) {
    commons_.ledger.refuse("moveit.validity_unknown", Refusal(Code::not_ready, found.unknown));
  }
}

}  // namespace hgrid
