// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <string>
#include <thread>

#include "workload.h"

namespace hgrid {
namespace bench {

/// Publishes the cycles of a workload on /tf or ~poses from its own thread until this object is destroyed. A cycle is
/// one set of transforms. All of them have the same stamp: the time when the cycle is sent.
class TfPublisher {
 public:
  /// @param period  [s] time from the start of a cycle to the start of the next
  /// @param node    name of the node, for workloads that ~poses moves
  TfPublisher(const Workload& workload, double period, const std::string& node = "");
  ~TfPublisher();
  /// Returns whether the topic has a subscriber.
  bool heard() const { return publisher_.getNumSubscribers() > 0; }
  /// Returns the number of cycles that began more than half a period late, because the machine was too busy.
  std::size_t lateCycles() const { return late_; }

 private:
  void run();
  void publish(const tf2_msgs::TFMessage& cycle, bool named);

  const Workload& workload_;
  double period_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::size_t> late_{0};
  std::thread thread_;  // last member, because the thread uses the other members
};

}  // namespace bench
}  // namespace hgrid
