// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/tf_reader.h"

#include <hgrid_proximity/Poses.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>
#include <optional>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/wire/bytes_subscriber.h"

namespace hgrid {

struct TfReader::ReadNext : ros::CallbackInterface {
  explicit ReadNext(TfReader& owner) : reader(owner) {}
  CallResult call() override {
    reader.readNext();
    return Success;
  }
  TfReader& reader;
};

TfReader::TfReader(ros::NodeHandle node, ros::NodeHandle private_node, std::size_t most_names, std::size_t most_bytes,
                   Now now, Sink sink, TfListener* listener, bool receiver_reads, Ledger& ledger)
    : most_bytes_(most_bytes),
      now_(std::move(now)),
      sink_(std::move(sink)),
      listener_(listener),
      ledger_(ledger),
      queue_(most_bytes, ledger),
      poses_(most_names, most_bytes),
      receiver_reads_(receiver_reads),
      tick_queue_(*node.getCallbackQueue()),
      read_next_(boost::make_shared<ReadNext>(*this)) {
  node.setCallbackQueue(&immediately_);
  private_node.setCallbackQueue(&immediately_);
  const char* const tf_type = ros::message_traits::datatype<tf2_msgs::TFMessage>();
  const char* const tf_md5 = ros::message_traits::md5sum<tf2_msgs::TFMessage>();
  subscribe(node, "/tf", tf_type, tf_md5, &TfReader::onTransforms);
  subscribe(node, "/tf_static", tf_type, tf_md5, &TfReader::onStatic);
  subscribe(private_node, "poses", ros::message_traits::datatype<::hgrid_proximity::Poses>(),
            ros::message_traits::md5sum<::hgrid_proximity::Poses>(), &TfReader::onPoses);
}

TfReader::~TfReader() {
  subscribers_.clear();  // from here on, no message wakes the tick thread
  tick_queue_.removeByID(reinterpret_cast<std::uint64_t>(this));
}

void TfReader::subscribe(ros::NodeHandle& node, const std::string& topic, const char* type, const char* md5,
                         void (TfReader::*on_message)(const Event&)) {
  ros::SubscribeOptions options =
      bytesOptions(topic, 1, most_bytes_, [this, on_message](const Event& event) { (this->*on_message)(event); });
  options.datatype = type;
  options.md5sum = md5;
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(node.subscribe(options));
}

/// Converts a message of ~poses into transforms, which are then read like those of /tf.
void TfReader::onPoses(const Event& event) {
  ReceivedTransforms poses{event.getConstMessage(), false, {}, now_(), true};
  try {
    poses.publisher = event.getPublisherName();
    if (poses.message->size <= most_bytes_) {  // otherwise the queue refuses it
      const auto transforms = boost::make_shared<MessageBytes>();
      transforms->most_bytes = most_bytes_;
      {
        const std::lock_guard<std::mutex> lock(poses_mutex_);
        transforms->bytes = poses_.toTransforms(poses.message->bytes, poses.publisher);
      }
      transforms->size = transforms->bytes.size();
      poses.message = transforms;
    }
    queue_.push(std::move(poses));
    read();
  } catch (const Refusal& refusal) {
    ledger_.refuse("poses.refused", Refusal(refusal.code(), poses.name() + " cannot be used: " + refusal.what()));
  } catch (...) {  // out of memory; the receiving thread must continue
    ledger_.fault("tf.failed");
  }
}

void TfReader::onMessage(const Event& event, bool is_static) {
  try {
    queue_.push({event.getConstMessage(), is_static, event.getPublisherName(), now_()});
    read();
  } catch (...) {  // out of memory; the receiving thread must continue
    ledger_.fault("tf.failed");
  }
}

/// Reads the message that has just arrived, or lets the tick thread read it. The receiving thread calls this.
void TfReader::read() {
  if (!readHere()) wakeTickThread();
}

/// Reads waiting messages in the receiving thread, but at most one slice, so that other messages do not wait for long.
/// @returns false if the tick thread must read what is left, or must look at what has arrived
bool TfReader::readHere() {
  if (!receiver_reads_ || waiting_ > 0) return false;
  const std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  return lock && !readSlice() && !noteworthy_;
}

void TfReader::wakeTickThread() {
  if (woken_.exchange(true)) return;
  try {
    tick_queue_.addCallback(read_next_, reinterpret_cast<std::uint64_t>(this));
  } catch (...) {
    woken_ = false;  // the next transforms try again
    throw;
  }
}

/// Reads one slice per callback, so that a tick that is due waits for one slice at most.
void TfReader::readNext() {
  woken_ = false;
  const Hold hold(*this);
  if (readSlice()) wakeTickThread();
}

void TfReader::readFor(std::chrono::duration<double> most_time) {
  const auto begin = std::chrono::steady_clock::now();
  while (readSlice() && std::chrono::steady_clock::now() - begin < most_time) {
  }
}

/// @returns whether there may be more to read
bool TfReader::readSlice() {
  bool complete = true;
  noteworthy_ = false;
  try {
    if (!slices_.left() && !open()) return false;
    slices_.next(slice_);
    noteworthy_ = sink_(slice_, current_.is_static, current_.publisher, current_.received);
  } catch (const Refusal& refusal) {
    ledger_.refuse("tf.refused", Refusal(refusal.code(), current_.name() + " cannot be read: " + refusal.what()));
  } catch (...) {  // out of memory; drop the rest of the message and continue
    slices_ = TransformSlices();
    ledger_.fault("tf.failed");
    complete = false;
  }
  if (slices_.left()) return true;
  close(complete);
  return !queue_.empty();
}

/// Takes the next message from the queue. @returns whether there was one
bool TfReader::open() {
  std::optional<ReceivedTransforms> next = queue_.pop();
  if (!next) return false;
  current_ = std::move(*next);
  slices_ = TransformSlices(current_.message->bytes);
  if (listener_ != nullptr) listener_->begins(current_);
  return true;
}

/// Ends the message that was read, and frees its bytes. @param complete  false: the rest of it was dropped
void TfReader::close(bool complete) {
  if (listener_ != nullptr) listener_->ends(complete);
  current_ = ReceivedTransforms();
}

}  // namespace hgrid
