// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/CheckEdges.h>
#include <hgrid_proximity/CheckStates.h>

#include <memory>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/services/envelope/service_envelope.h"
#include "node/states/checker_cache.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/leases.h"

namespace hgrid {

/// Serves ~check_states and ~check_edges from the newest tick, or from the tick of a lease. Any number of threads may
/// serve requests at the same time. No request waits for a tick.
class StateServices {
 public:
  /// All objects that are passed by reference must outlive this object.
  StateServices(ServiceEnvelope& envelope, const Params& params, const TransformLookup& transforms, Leases& leases,
                std::shared_ptr<const NarrowPhase> narrow_phase);
  /// Frees memory that no request has used for a second.
  void dropUnused() { cache_.dropUnused(); }

 private:
  void answer(ServiceCall<msg::CheckStates>& call);
  void answer(ServiceCall<msg::CheckEdges>& call);
  template <class Service>
  std::shared_ptr<const Tick> chooseTick(ServiceCall<Service>& call);
  void checkCount(const char* what, std::size_t values, std::size_t joints) const;

  const Params& params_;
  const TransformLookup& transforms_;
  Leases& leases_;
  const std::shared_ptr<const NarrowPhase> narrow_phase_;
  CheckerCache cache_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
