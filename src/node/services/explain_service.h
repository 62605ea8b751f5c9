// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/ExplainPair.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>

#include "hgrid_proximity/explain/explain.h"
#include "node/diagnostics/ledger.h"
#include "node/messages/messages.h"
#include "node/params/params.h"
#include "node/tick/world.h"
#include "node/wire/checked.h"

namespace hgrid {

/// Serves ~explain_pair from the newest tick. Callbacks run on the queue of the node handle, on as many threads as spin
/// it, and wait for nobody.
class ExplainService {
 public:
  using NewestTick = std::function<std::shared_ptr<const Tick>()>;

  ExplainService(ros::NodeHandle& node, const Params& params, std::uint64_t config_hash, NewestTick newest,
                 std::shared_ptr<const NarrowPhase> narrow_phase, Ledger& ledger);

 private:
  bool onExplain(Checked<msg::ExplainPair::Request>& checked, msg::ExplainPair::Response& response);
  void listContacts(msg::ExplainPair::Response& response, const Snapshot& snapshot, const Explanation& what,
                    std::uint32_t most) const;
  void explainTo(msg::ExplainPair::Response& response, const Snapshot& snapshot,
                 const msg::ExplainPair::Request& request, double age_since) const;

  const Params& params_;
  std::uint64_t config_hash_;
  NewestTick newest_;
  std::shared_ptr<const NarrowPhase> narrow_phase_;
  Ledger& ledger_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
