// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Guard.h>

#include "node/guard/guard.h"
#include "node/services/envelope/service_envelope.h"

namespace hgrid {

/// Serves ~guard: watches the path of a robot, or stops that.
class GuardService {
 public:
  /// All parameters must outlive this object.
  GuardService(ServiceEnvelope& envelope, Guard& guard);

 private:
  void answer(ServiceCall<msg::Guard>& call);

  Guard& guard_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
