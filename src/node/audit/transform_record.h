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

/// Stores the newest messages of /tf and all transforms of /tf_static as they were received. An audit uses them to
/// compute poses again. Only one thread at a time may use this object (see TfReader::Hold).
///
/// Transforms of /tf_static are never dropped, because each is sent only once. If a publisher sends several transforms
/// for one child, only the newest is kept. A transform that is not valid replaces no other transform, as in the node.
class TransformRecord : public TfListener {
 public:
  using Message = std::shared_ptr<const ReceivedTransforms>;
  /// Transforms by (child, publisher).
  using StaticTransforms = std::map<std::pair<std::string, std::string>, SerializedTransform>;

  /// A copy of the recorded transforms.
  struct Content {
    std::shared_ptr<const StaticTransforms> fixed = std::make_shared<StaticTransforms>();
    std::vector<Message> moving;  ///< messages of /tf in the order in which they were read
    Time begin{0};                ///< [ROS time] messages of /tf from this time or earlier may be missing
    bool all_static = true;       ///< false: transforms of /tf_static are missing, because there were too many
  };

  /// @param window       how long a message of /tf is kept
  /// @param most_bytes   [bytes] largest memory of all messages of /tf; if they need more, the oldest are dropped
  /// @param most_static  largest number of transforms of /tf_static; if there are more, the later ones are not kept
  TransformRecord(Time window, std::size_t most_bytes, std::size_t most_static)
      : window_(window), most_bytes_(most_bytes), most_static_(most_static) {}

  void begins(const ReceivedTransforms& message) override;
  void ends(bool complete) override;
  /// Drops the messages of /tf. Call this when ROS time jumped. @param now  ROS time
  void forgetMoving(Time now);

  /// Whether the node has read only a part of a message. Then the record contains transforms that the node does not use
  /// yet.
  bool isReading() const { return reading_; }
  Content content();

 private:
  void keepStatic(const ReceivedTransforms& message);
  void dropOldest();

  const Time window_;
  const std::size_t most_bytes_, most_static_;
  std::deque<Message> moving_;
  StaticTransforms fixed_;
  std::shared_ptr<const StaticTransforms> shared_fixed_;  // copy of fixed_; null: fixed_ changed after the copy
  std::size_t moving_bytes_ = 0;
  Time begin_{0};
  bool all_static_ = true, reading_ = false;
};

}  // namespace hgrid
