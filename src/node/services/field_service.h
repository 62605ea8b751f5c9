// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/DistanceField.h>

#include <memory>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/services/envelope/service_envelope.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/leases.h"
#include "node/tick/tick_history.h"

namespace hgrid {

/// Serves ~distance_field from the newest tick, from the tick of a lease, or from the tick of the request's stamp. Any
/// number of threads may serve requests at the same time. No request waits for a tick.
class FieldService {
 public:
  /// All objects that are passed by reference must outlive this object.
  /// @param transforms  used to look up the frames of the lattices
  FieldService(ServiceEnvelope& envelope, const Params& params, const TransformLookup& transforms,
               const TickHistory& history, Leases& leases, std::shared_ptr<NarrowPhase> narrow_phase);

 private:
  void answer(ServiceCall<msg::DistanceField>& call);

  const Params& params_;
  const TransformLookup& transforms_;
  const TickHistory& history_;
  Leases& leases_;
  const std::shared_ptr<NarrowPhase> narrow_phase_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
