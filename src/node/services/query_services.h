// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QuerySphere.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>

#include "hgrid_proximity/queries/query.h"
#include "node/messages/markers.h"
#include "node/messages/messages.h"
#include "node/params/params.h"
#include "node/tick/world.h"
#include "node/wire/checked.h"

namespace hgrid {

/// Answers ~query_sphere, ~query_segment, ~query_box and ~query_nearest from the newest tick. Callbacks run on the
/// queue of the node handle, on as many threads as spin it, and wait for nobody.
class QueryServices {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;

  QueryServices(ros::NodeHandle& node, const Params& params, std::uint64_t config_hash, NewestTick newest,
                const TransformLookup& transforms, std::shared_ptr<const NarrowPhase> narrow_phase, QuerySketch& sketch,
                Ledger& ledger);

 private:
  bool onSphere(Checked<msg::QuerySphere::Request>& request, msg::QuerySphere::Response& response);
  bool onSegment(Checked<msg::QuerySegment::Request>& request, msg::QuerySegment::Response& response);
  bool onBox(Checked<msg::QueryBox::Request>& request, msg::QueryBox::Response& response);
  bool onNearest(Checked<msg::QueryNearest::Request>& request, msg::QueryNearest::Response& response);
  template <class Request, class Response, class Ask>
  bool answer(const Checked<Request>& checked, Response& response, Ask&& ask);
  Pose worldFromFrame(const Tick& tick, const std::string& frame) const;
  QueryScope scopeOf(const std::vector<std::string>& include, const std::vector<std::string>& exclude,
                     std::uint32_t limit) const;

  const Params& params_;
  std::uint64_t config_hash_;
  NewestTick newest_;
  const TransformLookup& transforms_;
  std::shared_ptr<const NarrowPhase> narrow_phase_;
  QuerySketch& sketch_;
  Ledger& ledger_;
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace hgrid
