// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "node/immediate_callbacks.h"
#include "node/tf/tf_listener.h"
#include "node/tf/tf_queue.h"
#include "node/wire/poses_message.h"
#include "node/wire/transform_slices.h"

namespace hgrid {

/// Subscribes to /tf, /tf_static and ~poses, and passes their checked and deserialized messages to the tick thread.
///
/// roscpp can bound the queue of a subscriber only by the number of messages. So the thread that receives a message
/// puts its bytes into a TfQueue at once, which bounds the number of bytes. The tick thread does everything else.
class TfReader {
 public:
  using Now = std::function<Moment()>;
  /// Called with a slice of a message. @param received  when the message arrived, which may be long before this call
  using Sink = std::function<void(const tf2_msgs::TFMessage& message, bool is_static, const std::string& publisher,
                                  const Moment& received)>;

  /// @param node        its callback queue must be that of the tick thread, which reads waiting messages between ticks
  /// @param private_node  node handle whose namespace contains the topic "poses"
  /// @param most_names    largest number of names in a message of ~poses
  /// @param most_bytes  [bytes] how much may wait in the queue of each topic
  /// @param now         returns the current time; the thread that receives messages calls it
  /// @param sink        gets the messages; the thread that runs the callback queue or calls readFor() calls it
  /// @param listener    learns which messages were read; may be null
  TfReader(ros::NodeHandle node, ros::NodeHandle private_node, std::size_t most_names, std::size_t most_bytes, Now now,
           Sink sink, TfListener* listener, Ledger& ledger);
  ~TfReader();
  TfReader(const TfReader&) = delete;
  TfReader& operator=(const TfReader&) = delete;

  /// Reads waiting messages in the order in which they were received. Stops when none is left or when `most_time` has
  /// passed. A long message may be read in several calls.
  void readFor(std::chrono::duration<double> most_time);

 private:
  struct ReadNext;

  using Event = ros::MessageEvent<const MessageBytes>;
  void subscribe(ros::NodeHandle& node, const std::string& topic, const char* type, const char* md5,
                 void (TfReader::*on_message)(const Event&));
  void onTransforms(const Event& event) { onMessage(event, false); }
  void onStatic(const Event& event) { onMessage(event, true); }
  void onPoses(const Event& event);
  void onMessage(const Event& event, bool is_static);
  void wakeTickThread();
  void readNext();
  bool readSlice();
  bool open();
  void close(bool complete);

  std::size_t most_bytes_;
  Now now_;
  Sink sink_;
  TfListener* const listener_;
  Ledger& ledger_;
  TfQueue queue_;
  std::mutex poses_mutex_;
  PosesConverter poses_;        ///< guarded by poses_mutex_
  ReceivedTransforms current_;  ///< tick thread only: the message that is being read
  TransformSlices slices_;      ///< tick thread only: the unread slices; refers to the bytes of current_
  tf2_msgs::TFMessage slice_;   ///< tick thread only: the slice that was read last
  ros::CallbackQueueInterface& tick_queue_;
  ros::CallbackInterfacePtr read_next_;
  std::atomic<bool> woken_{false};  ///< whether read_next_ is in tick_queue_
  ImmediateCallbacks immediately_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hgrid
