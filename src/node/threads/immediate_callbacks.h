// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/callback_queue_interface.h>

#include <cstdint>

namespace hgrid {

/// A callback queue that runs each callback at once, in the thread that adds it. This is the thread that receives.
///
/// roscpp can bound the queue of a subscriber only by the number of messages, and it drops messages without a count. A
/// callback in this queue can pass each message to a queue of its own, which does better.
class ImmediateCallbacks : public ros::CallbackQueueInterface {
 public:
  void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override { callback->call(); }
  /// Does nothing, because no callback is stored. roscpp calls this only while it adds no callback of the subscriber.
  void removeByID(std::uint64_t) override {}
};

}  // namespace hgrid
