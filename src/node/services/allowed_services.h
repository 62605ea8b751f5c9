// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/SetAllowed.h>

#include <memory>
#include <string>
#include <vector>

#include "node/services/envelope/service_envelope.h"
#include "node/tick/change_world.h"

namespace hgrid {

/// Serves ~set_allowed and ~get_allowed, which change and read the allowed-pair matrix.
///
/// A request is checked against the rules of the newest tick, and a later tick puts the new rules in force. Nobody may
/// add other rules in between. Therefore only one thread may serve requests. Rules may end in between.
class AllowedServices {
 public:
  /// `envelope` and `params` must outlive this object.
  AllowedServices(ServiceEnvelope& envelope, const Params& params, ChangeWorld change_world,
                  WaitUntilStored wait_until_stored);

 private:
  void set(ServiceCall<msg::SetAllowed>& call) const;
  void get(ServiceCall<msg::GetAllowed>& call) const;
  PairFilter filterAfter(const ServiceCall<msg::SetAllowed>& call, const Structure& structure) const;
  void checkNotSilenced(const Structure& structure, const PairFilter& filter, bool force) const;

  const Params& params_;
  ChangeWorld change_world_;
  WaitUntilStored wait_until_stored_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
