// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/BodyState.h>

#include <functional>
#include <memory>
#include <string>

#include "node/diagnostics/ledger.h"
#include "node/messages/messages.h"
#include "node/params/params.h"
#include "node/tick/world.h"

namespace hgrid {

/// What services that change the world have in common: how a request is answered.
struct AdminAnswer {
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;
  /// Does a job at the begin of a tick and waits for the result of that tick.
  /// @throws Refusal busy
  using DoInTick = std::function<std::shared_ptr<const Tick>(const std::function<void(World&)>&)>;

  const Params& params;
  std::uint64_t config_hash;
  NewestTick newest;
  DoInTick do_in_tick;
  Ledger& ledger;

  /// Does the deed with the newest tick (null before the first), which it may replace by a later one, and says how it
  /// went. @param what  the service, as its refusals are counted
  template <class Response, class Deed>
  bool operator()(const std::string& what, Response& response, Deed&& deed) const {
    std::shared_ptr<const Tick> tick = newest();
    response.code = toMsg(Code::ok, "");
    try {
      deed(tick);
      response.success = true;
    } catch (const Refusal& refusal) {
      response.code = toMsg(refusal.code(), refusal.what());
      ledger.refuse(what + ".refused", refusal);
    } catch (...) {  // a fault of the node's own: the caller hears of it, the node goes on
      const Refusal fault = ledger.fault((what + ".failed").c_str());
      response.code = toMsg(fault.code(), fault.what());
    }
    if (tick) {
      const std::chrono::duration<double> age = std::chrono::steady_clock::now() - tick->made.steady;
      response.world = worldState(*tick, params, config_hash, age.count());
    } else {
      response.world.worst_state = msg::BodyState::UNPLACED;
    }
    return true;
  }
};

}  // namespace hgrid
