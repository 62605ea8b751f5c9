// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ExplainPair.h>

#include <memory>

#include "hgrid_proximity/explain/explain.h"
#include "node/services/envelope/service_envelope.h"
#include "node/tick/tick_history.h"

namespace hgrid {

/// Serves ~explain_pair from the newest tick, or from the tick of the request's stamp. Any number of threads may serve
/// requests at the same time. No request waits for a tick.
class ExplainService {
 public:
  /// `envelope`, `params` and `history` must outlive this object.
  ExplainService(ServiceEnvelope& envelope, const Params& params, const TickHistory& history,
                 std::shared_ptr<const NarrowPhase> narrow_phase);

 private:
  void explainPair(ServiceCall<msg::ExplainPair>& call) const;
  void fill(const Snapshot& snapshot, const msg::ExplainPair::Request& request, double tick_age,
            msg::ExplainPair::Response& response) const;
  void listContacts(const Snapshot& snapshot, const Explanation& what, std::uint32_t most,
                    msg::ExplainPair::Response& response) const;

  const Params& params_;
  const TickHistory& history_;
  std::shared_ptr<const NarrowPhase> narrow_phase_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
