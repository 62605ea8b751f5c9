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

#include "node/tf/tf_listener.h"
#include "node/tf/tf_queue.h"
#include "node/threads/immediate_callbacks.h"
#include "node/wire/poses_message.h"
#include "node/wire/transform_slices.h"

namespace hgrid {

/// Subscribes to /tf, /tf_static and ~poses, and passes their transforms to a function, the sink.
///
/// roscpp can bound the queue of a subscriber only by the number of messages. So the thread that receives a message
/// puts its bytes into a TfQueue at once, which bounds the number of bytes.
///
/// Then one of two threads reads the message. The receiving thread does it if the tick thread has something else to do,
/// because waking a thread takes longer than reading a message. The tick thread does it if it works with the
/// transforms at this moment, or if the message is long. Only one of the two threads uses the sink at a time: the one
/// that has a Hold.
class TfReader {
 public:
  using Now = std::function<Moment()>;
  /// Called with a slice of a message. @param received  when the message arrived, which may be long before this call
  /// @returns whether the tick thread must look at what has arrived
  using Sink = std::function<bool(const std::vector<TransformView>& transforms, bool is_static,
                                  const std::string& publisher, const Moment& received)>;

  /// While this object exists, only the thread that created it uses the sink. The tick thread creates one while it uses
  /// what the sink changes.
  class Hold {
   public:
    explicit Hold(TfReader& reader) : reader_(reader) {
      ++reader_.waiting_;  // under a flood of messages, the receiving thread would lock the mutex again and again
      reader_.mutex_.lock();
      --reader_.waiting_;
    }
    ~Hold() { reader_.mutex_.unlock(); }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

   private:
    TfReader& reader_;
  };

  /// @param node        its callback queue must be that of the tick thread, which reads waiting messages between ticks
  /// @param private_node  node handle whose namespace contains the topic "poses"
  /// @param most_names    largest number of names in a message of ~poses
  /// @param most_bytes  [bytes] how much may wait in the queue of each topic
  /// @param now         returns the current time; the thread that receives messages calls it
  /// @param sink        gets the transforms; must not throw
  /// @param listener    learns which messages were read, from the thread that calls the sink; may be null
  /// @param receiver_reads  whether the receiving thread may call the sink; otherwise only the tick thread does
  TfReader(ros::NodeHandle node, ros::NodeHandle private_node, std::size_t most_names, std::size_t most_bytes, Now now,
           Sink sink, TfListener* listener, bool receiver_reads, Ledger& ledger);
  ~TfReader();
  TfReader(const TfReader&) = delete;
  TfReader& operator=(const TfReader&) = delete;

  /// Reads waiting messages in the order in which they were received. Stops when none is left or when `most_time` has
  /// passed. A long message may be read in several calls. The calling thread must have a Hold.
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
  void read();
  bool readHere();
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
  PosesConverter poses_;  ///< guarded by poses_mutex_
  const bool receiver_reads_;
  std::mutex mutex_;                  ///< locked by a Hold
  std::atomic<int> waiting_{0};       ///< number of threads that are about to lock mutex_
  ReceivedTransforms current_;        ///< guarded by mutex_: the message that is being read
  TransformSlices slices_;            ///< guarded by mutex_: the unread slices; refers to the bytes of current_
  std::vector<TransformView> slice_;  ///< guarded by mutex_: the slice that was read last
  bool noteworthy_ = false;           ///< guarded by mutex_: what the sink returned last
  ros::CallbackQueueInterface& tick_queue_;
  ros::CallbackInterfacePtr read_next_;
  std::atomic<bool> woken_{false};  ///< whether read_next_ is in tick_queue_
  ImmediateCallbacks immediately_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hgrid
