// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <thread>

#include "workload.h"

namespace hgrid {
namespace bench {

/// Publishes the cycles of a workload on /tf from a thread of its own while it lives. All transforms of a cycle bear
/// the time at which it is sent.
class TfPublisher {
 public:
  /// @param period  [s] from cycle to cycle
  TfPublisher(const Workload& workload, double period);
  ~TfPublisher();
  bool heard() const { return publisher_.getNumSubscribers() > 0; }
  /// Cycles that began more than half a period late: the machine was too busy to keep the rate.
  std::size_t lateCycles() const { return late_; }

 private:
  void run();

  const Workload& workload_;
  double period_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::size_t> late_{0};
  std::thread thread_;  // last: it uses the others
};

}  // namespace bench
}  // namespace hgrid
