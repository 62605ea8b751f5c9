// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "node/audit/audit_case.h"

namespace hgrid {

/// Computes poses of frames from recorded transforms. Written apart from the folder tf, which the audit checks.
///
/// Some frames are doubtful: several publishers or parents place them, they are on both topics, or a transform of them
/// is not valid. Which of their transforms the node uses depends on what it received earlier, so the audit leaves them
/// out.
class RecordedFrames {
 public:
  /// @param audited  must outlive this object
  explicit RecordedFrames(const AuditCase& audited);

  /// The transforms between two frames.
  struct Chain {
    std::vector<std::size_t> up;    // frames from the target to the common ancestor, without that ancestor
    std::vector<std::size_t> down;  // frames from the other frame to the common ancestor, without that ancestor
    bool doubtful = false;          // whether a frame of the chain is doubtful
    bool moves = false;             // whether a frame of the chain is on /tf
  };
  /// Returns the chain between two frames by their newest parents. Empty: they are not connected.
  std::optional<Chain> chain(const std::string& target, const std::string& frame) const;

  /// Returns the pose of the chain's frame in its target at a time. Empty: a transform is not known at that time.
  std::optional<Pose> poseAt(const Chain& chain, Time time) const;
  /// Returns the newest time at which all transforms of a chain that moves are known.
  Time newestTime(const Chain& chain) const;
  /// Returns a time for which the node must have a pose of the chain, or for a later one: for each frame of the chain
  /// that moves, takes the newest sample up to `time`; returns the least of their stamps. Empty: a frame has none.
  std::optional<Time> sampledUpTo(const Chain& chain, Time time) const;

 private:
  struct Sample {
    Time stamp{0};
    std::size_t parent = 0;
    Eigen::Quaterniond rotation;
    Eigen::Vector3d translation;
  };
  struct Frame {
    std::vector<Sample> samples;  // by stamp, each stamp once; a static frame has one sample
    std::uint32_t publisher = 0;  // of the newest sample
    bool moves = false, fixed = false, doubtful = false;
  };

  std::optional<std::size_t> numberOf(const std::string& name) const;
  void add(const RecordedTransform& transform);
  void finish(Frame& frame);
  std::vector<std::size_t> ancestors(std::size_t frame) const;
  std::optional<Pose> edgeAt(std::size_t frame, Time time) const;

  const AuditCase& audited_;
  std::map<std::string, std::size_t> numbers_;
  std::vector<Frame> frames_;  // for each of AuditCase::names
};

}  // namespace hgrid
