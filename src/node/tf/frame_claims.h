// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "node/tf/frame_pose.h"

namespace hgrid {

/// Who places a frame, and in which parent.
struct FrameClaim {
  std::string publisher, parent;
};

/// Keeps track of frames that more than one publisher places, and reports those over which publishers fight.
///
/// One publisher at a time holds a frame: its transforms are used. Any other publisher of the frame is a rival. A
/// transform of a rival waits here until the holder has sent one with that stamp or a newer one. Only then can the two
/// be compared. Frames are known by their numbers in the TfIntake. Readings are those of the AgeClock.
class FrameClaims {
 public:
  /// A transform of a rival.
  struct RivalTransform {
    FrameClaim claim;
    Time stamp{0};
    FramePose parent_from_frame;
  };

  /// [ns] A frame is contested for this long after publishers contradicted each other.
  static constexpr Time kMemory{3000000000};

  /// Stores a rival's transform, unless one of this frame waits already.
  void keep(std::uint32_t frame, const RivalTransform& transform);
  /// Returns and removes the transform that waits, if its stamp is not newer than the holder's newest.
  std::optional<RivalTransform> take(std::uint32_t frame, Time holders_newest);
  /// The claim `to` replaces the claim `from`. Returns whether `from` replaced `to` less than kMemory ago: the two take
  /// turns.
  bool change(std::uint32_t frame, const FrameClaim& from, const FrameClaim& to, Time reading);
  /// Two claims contradict each other: the frame is contested for a while.
  void contradict(std::uint32_t frame, const std::string& name, const FrameClaim& holder, const FrameClaim& rival,
                  Time reading);
  /// Drops all transforms and changes, since the clock jumped. Fights go on.
  void forgetTransforms();

  bool isContested(std::uint32_t frame, Time reading) const;
  /// What is wrong with a frame that was contested.
  const std::string& sentence(std::uint32_t frame) const { return entries_.at(frame).sentence; }
  /// The sentences of all frames that are contested, sorted.
  std::vector<std::string> sentences(Time reading) const;

 private:
  struct Entry {
    std::optional<RivalTransform> waiting;
    std::optional<FrameClaim> left;  // the claim that was replaced last
    Time left_at{0};
    std::string sentence;
    std::optional<Time> contested_until;
  };

  std::unordered_map<std::uint32_t, Entry> entries_;
};

}  // namespace hgrid
