// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QueryShape.h>
#include <hgrid_proximity/QuerySphere.h>

#include <memory>
#include <vector>

#include "node/markers/query_markers.h"
#include "node/queries/query_request.h"
#include "node/services/envelope/service_envelope.h"
#include "node/tf/transform_lookup.h"
#include "node/tick/tick_history.h"

namespace hgrid {

/// Serves ~query_sphere, ~query_segment, ~query_box, ~query_shape and ~query_nearest from the newest tick, or from the
/// tick of the request's stamp. Any number of threads may serve requests at the same time. No request waits for a tick.
class QueryServices {
 public:
  /// All objects that are passed by reference must outlive this object.
  /// @param quick       serves ~query_sphere; its requests may be answered in a QuickTurn
  /// @param envelope    serves the others
  /// @param transforms  used to look up the frames of the queries
  /// @param sketch      receives the newest sphere and segment, so that ~markers can show them
  QueryServices(ServiceEnvelope& quick, ServiceEnvelope& envelope, const Params& params,
                const TransformLookup& transforms, const TickHistory& history,
                std::shared_ptr<NarrowPhase> narrow_phase, QuerySketch& sketch);

 private:
  /// Serves one kind of query. @param ask  function (const Request&, const PreparedQuery&) that returns the QueryAnswer
  template <class Service, class Ask>
  void serve(ServiceEnvelope& envelope, const char* name, Ask ask);
  template <class Service, class Ask>
  void answer(ServiceCall<Service>& call, const Ask& ask) const;

  QueryAnswer askNearest(const msg::QueryNearest::Request& request, const PreparedQuery& question) const;

  const Params& params_;
  const TransformLookup& transforms_;
  const TickHistory& history_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
