// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <cstdint>
#include <memory>

namespace hgrid {

/// A callback queue with its own threads. All callbacks of its two node handles run on these threads only.
class CallbackThreads {
 public:
  CallbackThreads(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
      : node_(node), private_node_(private_node) {
    node_.setCallbackQueue(&queue_);
    private_node_.setCallbackQueue(&queue_);
  }

  const ros::NodeHandle& node() const { return node_; }
  const ros::NodeHandle& privateNode() const { return private_node_; }

  void start(std::uint32_t threads) {
    spinner_ = std::make_unique<ros::AsyncSpinner>(threads, &queue_);
    spinner_->start();
  }
  /// Starts no further callbacks, and waits for those that are running.
  void stop() {
    if (spinner_) spinner_->stop();
  }

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle node_, private_node_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

}  // namespace hgrid
