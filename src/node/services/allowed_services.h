// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/SetAllowed.h>
#include <ros/node_handle.h>

#include <vector>

#include "node/services/admin_answer.h"
#include "node/wire/checked.h"

namespace hgrid {

/// Serves ~set_allowed and ~get_allowed: the allowed-pair matrix. Whether a request is right is decided from the newest
/// tick; a tick only takes over the rules that it comes to. One thread; nobody else changes rules, but that they end.
class AllowedServices {
 public:
  AllowedServices(ros::NodeHandle& node, AdminAnswer answer);

 private:
  bool onSet(Checked<msg::SetAllowed::Request>& checked, msg::SetAllowed::Response& response);
  bool onGet(Checked<msg::GetAllowed::Request>& checked, msg::GetAllowed::Response& response);
  std::vector<PairRule> rulesAfter(const msg::SetAllowed::Request& request, const Structure& structure) const;

  AdminAnswer answer_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
