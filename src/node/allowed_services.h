// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/SetAllowed.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <vector>

#include "ledger.h"
#include "messages.h"
#include "params.h"
#include "world.h"

namespace hgrid {

/// Serves ~set_allowed and ~get_allowed: the allowed-pair matrix. Whether a request is right is decided from the newest
/// tick; a tick only takes over the rules that it comes to. One thread; nobody else changes rules, but that they end.
class AllowedServices {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;
  /// Does a job at the begin of a tick and waits for the result of that tick.
  /// @throws Refusal busy
  using DoInTick = std::function<std::shared_ptr<const Tick>(const std::function<void(World&)>&)>;

  AllowedServices(ros::NodeHandle& node, const Params& params, std::uint64_t config_hash, NewestTick newest,
                  DoInTick do_in_tick, Ledger& ledger);

 private:
  bool onSet(msg::SetAllowed::Request& request, msg::SetAllowed::Response& response);
  bool onGet(msg::GetAllowed::Request& request, msg::GetAllowed::Response& response);
  std::vector<PairRule> rulesAfter(const msg::SetAllowed::Request& request, const Structure& structure) const;
  template <class Response, class Deed>
  bool answer(const char* what, Response& response, Deed&& deed);

  const Params& params_;
  std::uint64_t config_hash_;
  NewestTick newest_;
  DoInTick do_in_tick_;
  Ledger& ledger_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
