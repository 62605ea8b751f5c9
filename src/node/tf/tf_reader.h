// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/callback_queue_interface.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "node/tf/tf_queue.h"
#include "node/wire/transform_slices.h"

namespace hgrid {

/// Subscribes to /tf and /tf_static and hands their messages, checked and deserialized, to the tick thread.
///
/// roscpp bounds a subscriber's queue by the number of messages only. So the thread that receives a message stores its
/// bytes in a TfQueue at once, which bounds them, and the tick thread does everything else.
class TfReader {
 public:
  using Now = std::function<Moment()>;
  /// @param received  when the message arrived, which may be long before this call
  using Sink = std::function<void(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher,
                                  const Moment& received)>;

  /// @param node  its callback queue is the tick thread's: between ticks, waiting messages are read there
  /// @param now   called by the thread that receives
  /// @param sink  called by the thread that runs the callback queue or calls readFor()
  TfReader(ros::NodeHandle node, std::size_t most_bytes, Now now, Sink sink, Ledger& ledger);
  ~TfReader();
  TfReader(const TfReader&) = delete;
  TfReader& operator=(const TfReader&) = delete;

  /// Reads the messages that wait, in the order in which they were received, until none is left or `most_time` has
  /// passed. A long message may be read in several calls.
  void readFor(std::chrono::duration<double> most_time);

 private:
  /// Runs a callback in the thread that adds it. For the subscribers, that is the thread that receives.
  class Immediately : public ros::CallbackQueueInterface {
   public:
    void addCallback(const ros::CallbackInterfacePtr& callback, std::uint64_t) override { callback->call(); }
    /// No callback is stored. roscpp removes a subscriber only while none of its callbacks is being added.
    void removeByID(std::uint64_t) override {}
  };
  struct ReadNext;

  void subscribe(const ros::NodeHandle& node, const std::string& topic, bool is_static);
  void onMessage(const ros::MessageEvent<const TransformBytes>& event, bool is_static);
  void wakeTickThread();
  void readNext();
  bool readSlice();
  bool open();

  std::size_t most_bytes_;
  Now now_;
  Sink sink_;
  Ledger& ledger_;
  TfQueue queue_;
  ReceivedTransforms current_;  ///< tick thread only: the message whose slices are read
  TransformSlices slices_;      ///< tick thread only: refers to the bytes of current_
  ros::CallbackQueueInterface& tick_queue_;
  ros::CallbackInterfacePtr read_next_;
  std::atomic<bool> woken_{false};  ///< read_next_ stands in tick_queue_
  Immediately immediately_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hgrid
