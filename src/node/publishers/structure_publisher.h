// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <memory>

#include "node/diagnostics/ledger.h"
#include "node/params/params.h"
#include "node/publishers/structure_watch.h"
#include "node/tick/newest_only.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Publishes ~bodies and ~rules (latched) at the first tick and whenever the structure of the world changes. A rule
/// that begins or ends changes the structure, too.
///
/// A separate thread does this, because the messages list all bodies and all rules, and ticks must not wait for that.
class StructurePublisher {
 public:
  /// `params` and `ledger` must outlive this object.
  StructurePublisher(ros::NodeHandle& private_node, const Params& params, Ledger& ledger);

  /// Passes a tick to the publishing thread if the structure has changed, or if the last messages could not be
  /// published. Never waits for the thread. Only the tick thread may call this.
  void publish(const std::shared_ptr<const Tick>& tick);
  /// Waits until the structure of every tick that was passed to publish() is published. Any other thread may call this.
  void wait() { thread_.wait(); }

 private:
  const Params& params_;
  ros::Publisher bodies_, rules_;
  StructureWatch watch_;                            // only the tick thread uses it
  std::atomic<bool> failed_{false};                 // whether the last messages could not be published
  NewestOnly<std::shared_ptr<const Tick>> thread_;  // declared last, because its thread uses the members above
};

}  // namespace hgrid
