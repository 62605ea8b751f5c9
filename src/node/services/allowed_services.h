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
/// A request is checked against the rules of the newest tick. A later tick only takes over the result. So only one
/// thread at a time may serve requests, and nobody else may add rules. (Rules may end in between.)
class AllowedServices {
 public:
  /// `envelope` and `params` must outlive this object.
  AllowedServices(ServiceEnvelope& envelope, const Params& params, ChangeWorld change_world);

 private:
  void set(ServiceCall<msg::SetAllowed>& call) const;
  void get(ServiceCall<msg::GetAllowed>& call) const;
  PairFilter filterAfter(const ServiceCall<msg::SetAllowed>& call, const Structure& structure) const;
  void checkNotSilenced(const Structure& structure, const PairFilter& filter, bool force) const;

  const Params& params_;
  ChangeWorld change_world_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
