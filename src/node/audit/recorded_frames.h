// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/audit/audit_case.h"

namespace hgrid {

/// Computes poses of frames from recorded transforms. Uses no code of the folder tf, which the audit checks.
///
/// A frame is doubtful if several publishers or parents place it, if it is on both /tf and /tf_static, or if one of its
/// transforms is not valid. Which of its transforms the node uses depends on earlier messages, which the record may not
/// contain. So the audit skips doubtful frames.
class RecordedFrames {
 public:
  /// @param audited  must outlive this object
  explicit RecordedFrames(const AuditCase& audited);

  /// The frames whose transforms connect a target frame with another frame.
  struct Chain {
    std::vector<std::size_t> up;    // frames from the target to the common ancestor, without that ancestor
    std::vector<std::size_t> down;  // frames from the other frame to the common ancestor, without that ancestor
    bool doubtful = false;          // whether a frame of the chain is doubtful
    bool moves = false;             // whether a frame of the chain is published on /tf
  };
  /// Returns the chain between two frames. Each frame is below its newest parent. Empty: the frames are not connected.
  std::optional<Chain> chain(const std::string& target, const std::string& frame) const;

  /// Returns the pose of the chain's other frame in its target frame at `time`. Empty: a transform is not known at this
  /// time.
  std::optional<Pose> poseAt(const Chain& chain, Time time) const;
  /// Returns the newest time at which all transforms of a chain are known; Time::max() if no frame of the chain moves.
  Time newestTime(const Chain& chain) const;
  /// Returns a stamp: the pose that the node uses for the chain at `time` must not be older than this stamp.
  ///
  /// For each moving frame of the chain, there is a newest sample that is not later than `time`. The result is the
  /// oldest stamp of these samples. Empty: a frame has no such sample.
  std::optional<Time> sampledUpTo(const Chain& chain, Time time) const;

 private:
  struct Sample {
    Time stamp{0};
    std::size_t parent = 0;
    Eigen::Quaterniond rotation;
    Eigen::Vector3d translation;
  };
  struct Frame {
    std::vector<Sample> samples;  // sorted by stamp, one for each stamp; a static frame has one sample
    std::uint32_t publisher = 0;  // of the last recorded transform; index in AuditCase::names
    bool moves = false, fixed = false, doubtful = false;
    bool free = false;  // whether a planar or floating joint moves it
  };

  std::optional<std::size_t> numberOf(const std::string& name) const;
  void add(const RecordedTransform& transform);
  void finish(Frame& frame);
  std::vector<std::size_t> ancestors(std::size_t frame) const;
  std::optional<Pose> edgeAt(std::size_t frame, Time time) const;

  const AuditCase& audited_;
  std::map<std::string, std::size_t> numbers_;  // name -> index in AuditCase::names and in frames_
  std::vector<Frame> frames_;                   // one for each of AuditCase::names
};

}  // namespace hgrid
