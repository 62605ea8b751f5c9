// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "node/tf/tf_listener.h"

namespace hgrid {

/// Stores the messages of /tf and /tf_static as they were received, for a short time, so that an audit can compute
/// poses from them again. Only the tick thread may use it.
///
/// It stores bytes and deserializes nothing. The messages of /tf_static are never dropped, because each transform is
/// sent only once. A message of /tf_static that repeats the last one of its publisher is not stored again.
class TransformRecord : public TfListener {
 public:
  using Message = std::shared_ptr<const ReceivedTransforms>;

  /// What the record has at one moment.
  struct Content {
    std::vector<Message> messages;  ///< of /tf_static, then of /tf; each in the order in which they were read
    Time begin{0};                  ///< [ROS time] messages of /tf that were received until then may be missing
    bool overflown = false;         ///< whether there were too many messages of /tf_static, so that some are missing
  };

  /// @param window      how long a message of /tf is kept
  /// @param most_bytes  largest number of bytes that the messages of each topic may have; then the oldest of /tf are
  /// dropped
  TransformRecord(Time window, std::size_t most_bytes) : window_(window), most_bytes_(most_bytes) {}

  void begins(const ReceivedTransforms& message) override;
  void ends(bool complete) override;
  /// Drops the messages of /tf. Call this when ROS time jumped. @param now  ROS time
  void forgetMoving(Time now);

  /// Whether the node has read a part of a message. Then the record does not fit the transforms that the node uses.
  bool isReading() const { return reading_; }
  Content content() const;

 private:
  void keepStatic(const ReceivedTransforms& message);
  void dropOldest();

  const Time window_;
  const std::size_t most_bytes_;
  std::deque<Message> moving_, static_;
  std::size_t moving_bytes_ = 0, static_bytes_ = 0;
  Time begin_{0};
  bool overflown_ = false, reading_ = false;
};

}  // namespace hgrid
