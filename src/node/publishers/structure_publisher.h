// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <memory>

#include "node/health/commons.h"
#include "node/publishers/structure_watch.h"
#include "node/threads/newest_only.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Publishes ~bodies and ~rules (latched) at the first tick and whenever the structure of the world changes. A rule
/// that begins or ends changes the structure, too.
///
/// A thread of its own, the structure thread, does this, because the messages list all bodies and all rules, and ticks
/// must not wait for that.
class StructurePublisher {
 public:
  /// `commons` must outlive this object.
  StructurePublisher(ros::NodeHandle& private_node, Commons& commons);

  /// Passes a tick to the structure thread if the structure has changed, or if the last messages could not be
  /// published. Never waits for the thread. Only the tick thread may call this.
  void publish(const std::shared_ptr<const Tick>& tick);
  /// Waits until the structure thread has worked on all ticks passed to publish() before this call. If a newer tick
  /// replaced a waiting one, waits for the newer one. If publishing failed, this function returns as well; the next
  /// tick tries again. Any thread may call this, except the tick thread and the structure thread.
  void wait() { thread_.wait(); }

 private:
  void publishNow(const Tick& tick);

  Commons& commons_;
  ros::Publisher bodies_, rules_;
  StructureWatch watch_;                            // only the tick thread uses it
  std::atomic<bool> failed_{false};                 // whether the last messages could not be published
  NewestOnly<std::shared_ptr<const Tick>> thread_;  // declared last, because its thread uses the members above
};

}  // namespace hgrid
