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

/// Says which publisher places a frame, and in which parent.
struct FrameClaim {
  std::string publisher, parent;
};

/// Keeps track of frames that more than one publisher places, and lists the contested frames.
///
/// The holder of a frame is the publisher whose transforms are used. Any other publisher of the frame is a rival.
/// A rival's transform waits here until the holder has sent a transform with the same stamp or a newer one. Only then
/// can the two be compared. Frame numbers are those of the TfIntake. Readings are readings of the AgeClock.
class FrameClaims {
 public:
  /// A transform that a rival sent.
  struct RivalTransform {
    FrameClaim claim;
    Time stamp{0};
    FramePose parent_from_frame;
  };

  /// [ns] A frame stays contested for this long after its publishers contradicted each other.
  static constexpr Time kMemory{3000000000};

  /// Stores a rival's transform, unless a transform of this frame is already waiting.
  void keep(std::uint32_t frame, const RivalTransform& transform);
  /// Returns and removes the rival's transform that is waiting, if its stamp is not newer than `holders_newest`.
  /// @param holders_newest  stamp of the holder's newest transform
  std::optional<RivalTransform> take(std::uint32_t frame, Time holders_newest);
  /// Notes that the claim `to` replaces the claim `from`.
  /// @returns true if `from` replaced `to` at most kMemory ago, so that the two claims take turns
  bool change(std::uint32_t frame, const FrameClaim& from, const FrameClaim& to, Time reading);
  /// Notes that two claims contradict each other. The frame is contested for the next kMemory.
  void contradict(std::uint32_t frame, const std::string& name, const FrameClaim& holder, const FrameClaim& rival,
                  Time reading);
  /// Drops all waiting transforms and noted changes. Call this after the clock jumped. Contested frames stay contested.
  void forgetTransforms();

  bool isContested(std::uint32_t frame, Time reading) const;
  /// Returns the sentence that says which publishers contradict each other about a frame that was contested.
  const std::string& sentence(std::uint32_t frame) const { return entries_.at(frame).sentence; }
  /// Returns the sentences of all contested frames, sorted.
  std::vector<std::string> sentences(Time reading) const;

 private:
  struct Entry {
    std::optional<RivalTransform> waiting;
    std::optional<FrameClaim> left;  // the claim that was replaced most recently
    Time left_at{0};
    std::string sentence;
    std::optional<Time> contested_until;
  };

  std::unordered_map<std::uint32_t, Entry> entries_;
};

}  // namespace hgrid
