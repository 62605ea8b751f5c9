// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/reload_service.h"

#include <utility>

namespace hgrid {

ReloadService::ReloadService(ServiceEnvelope& envelope, Reload reload, ChangeWorld change_world)
    : reload_(std::move(reload)), change_world_(std::move(change_world)) {
  server_ = envelope.serve<msg::ReloadRobot>("reload_robot",
                                             [this](ServiceCall<msg::ReloadRobot>& call) { this->reload(call); });
}

void ReloadService::reload(ServiceCall<msg::ReloadRobot>& call) const {
  const Refusal outcome = reload_(call.request.robot);
  call.tick = AnswerTick(change_world_([](World&) {}));  // changes nothing, but waits for a tick with the new robots
  call.response.uncovered = call.tick.get()->models->uncovered;
  call.response.warnings = call.tick.get()->models->warnings;
  if (outcome.code() != Code::ok) throw outcome;
}

}  // namespace hgrid
