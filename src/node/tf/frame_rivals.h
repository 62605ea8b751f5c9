// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "node/health/ledger.h"
#include "node/tf/frame_claims.h"

namespace hgrid {

/// Compares the transforms of rival publishers with those of the holder, and reports contradictions.
///
/// FrameClaims explains the terms holder and rival. Readings are readings of the AgeClock.
class FrameRivals {
 public:
  /// The publisher whose transforms of a frame are used.
  struct Holder {
    const std::string& frame;  ///< name of the frame
    FrameClaim claim;
    Time newest{0};  ///< stamp of the holder's newest transform
    /// Returns the pose of the frame in its parent at a time, from the holder's transforms. Empty: it is not known.
    std::function<std::optional<FramePose>(Time)> pose_at;
  };

  explicit FrameRivals(Ledger& ledger) : ledger_(ledger) {}

  /// Receives a rival's transform. It is compared once the holder has sent a transform that is at least as new.
  void take(std::uint32_t frame, const Holder& holder, const FrameClaims::RivalTransform& rival, Time reading);
  /// Removes and returns the rival's transform that is waiting, if the holder's newest transform is at least as new.
  std::optional<FrameClaims::RivalTransform> takeWaiting(std::uint32_t frame, Time holders_newest) {
    return claims_.take(frame, holders_newest);
  }
  /// Compares a rival's transform with the holder's pose at the stamp of that transform.
  void compare(std::uint32_t frame, const Holder& holder, const FrameClaims::RivalTransform& rival, Time reading);
  /// Notes that the claim `next` replaces the holder's claim. Reports a contradiction if the two claims take turns.
  void change(std::uint32_t frame, const Holder& holder, const FrameClaim& next, Time reading);
  /// Reports that the holder's claim and another claim contradict each other.
  void contradict(std::uint32_t frame, const Holder& holder, const FrameClaim& other, Time reading);
  /// Drops all waiting transforms. Call this after the clock jumped.
  void forgetTransforms() { claims_.forgetTransforms(); }

  const FrameClaims& claims() const { return claims_; }

 private:
  Ledger& ledger_;
  FrameClaims claims_;
};

}  // namespace hgrid
