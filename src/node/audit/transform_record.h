// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "node/audit/visit_transforms.h"
#include "node/tf/tf_listener.h"

namespace hgrid {

/// Stores the messages of /tf and /tf_static as they were received, for a short time, so that an audit can compute
/// poses from them again. Only the tick thread may use it.
///
/// The transforms of /tf_static are never dropped, because each is sent only once. If a publisher sends another one for
/// the same child, only the newest is kept. One that the node does not use replaces none, as in the node.
class TransformRecord : public TfListener {
 public:
  using Message = std::shared_ptr<const ReceivedTransforms>;
  using StaticTransforms = std::map<std::pair<std::string, std::string>, SerializedTransform>;  ///< by child, publisher

  /// What the record has at one moment.
  struct Content {
    std::shared_ptr<const StaticTransforms> fixed = std::make_shared<StaticTransforms>();
    std::vector<Message> moving;  ///< messages of /tf in the order in which they were read
    Time begin{0};                ///< [ROS time] messages of /tf that were received until then may be missing
    bool all_static = true;       ///< whether there was room for all transforms of /tf_static
  };

  /// @param window       how long a message of /tf is kept
  /// @param most_bytes   [bytes] how much the messages of /tf may have; then the oldest are dropped
  /// @param most_static  how many transforms of /tf_static are kept
  TransformRecord(Time window, std::size_t most_bytes, std::size_t most_static)
      : window_(window), most_bytes_(most_bytes), most_static_(most_static) {}

  void begins(const ReceivedTransforms& message) override;
  void ends(bool complete) override;
  /// Drops the messages of /tf. Call this when ROS time jumped. @param now  ROS time
  void forgetMoving(Time now);

  /// Whether the node has read a part of a message. Then the record does not fit the transforms that the node uses.
  bool isReading() const { return reading_; }
  Content content();

 private:
  void keepStatic(const ReceivedTransforms& message);
  void dropOldest();

  const Time window_;
  const std::size_t most_bytes_, most_static_;
  std::deque<Message> moving_;
  StaticTransforms fixed_;
  std::shared_ptr<const StaticTransforms> shared_fixed_;  // a copy of fixed_ for content(); null: fixed_ has changed
  std::size_t moving_bytes_ = 0;
  Time begin_{0};
  bool all_static_ = true, reading_ = false;
};

}  // namespace hgrid
