// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <boost/function.hpp>
#include <optional>
#include <string>
#include <utility>

#include "node/diagnostics/ledger.h"

namespace hgrid {

/// Does what a callback of the node is for. Every callback that roscpp, a timer or a tick calls goes through this
/// function or through advertiseGuarded(), since an exception that leaves a callback ends the process.
///
/// Whatever `deed` throws is counted as "<where>.<CODE>" and logged, see Ledger::fault().
/// @returns why the deed failed; nullopt if it threw nothing
template <class Deed>
std::optional<Refusal> guarded(Ledger& ledger, const char* where, Deed&& deed) noexcept {
  try {
    std::forward<Deed>(deed)();
    return std::nullopt;
  } catch (...) {
    return ledger.fault(where);
  }
}

/// Advertises a service whose callback is guarded. The caller of a service hears that the call failed if the callback
/// throws. Faults are counted as "<name>.failed.<CODE>".
template <class Owner, class Request, class Response>
ros::ServiceServer advertiseGuarded(ros::NodeHandle& node, const std::string& name,
                                    bool (Owner::*callback)(Request&, Response&), Owner* owner, Ledger& ledger) {
  const boost::function<bool(Request&, Response&)> call = [callback, owner, &ledger, where = name + ".failed"](
                                                              Request& request, Response& response) {
    bool done = false;
    guarded(ledger, where.c_str(), [&] { done = (owner->*callback)(request, response); });
    return done;
  };
  return node.advertiseService(name, call);
}

}  // namespace hgrid
