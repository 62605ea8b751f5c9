// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "node/diagnostics/ledger.h"
#include "node/tf/frame_claims.h"

namespace hgrid {

/// Compares the transforms of rival publishers with those of the holder, and reports contradictions.
///
/// See FrameClaims for what a holder and a rival are. Readings are those of the AgeClock.
class FrameRivals {
 public:
  /// The publisher whose transforms of a frame are used.
  struct Holder {
    const std::string& frame;  ///< name of the frame
    FrameClaim claim;
    Time newest{0};  ///< stamp of its newest transform
    /// The frame's pose in its parent, by the holder's transforms. Empty: it is not known for that time.
    std::function<std::optional<FramePose>(Time)> pose_at;
  };

  explicit FrameRivals(Ledger& ledger) : ledger_(ledger) {}

  /// Takes in a rival's transform. It is compared as soon as the holder has sent one with its stamp or a newer one.
  void take(std::uint32_t frame, const Holder& holder, const FrameClaims::RivalTransform& rival, Time reading);
  /// The rival's transform that waits, if the holder's newest transform has its stamp or a newer one. It waits no more.
  std::optional<FrameClaims::RivalTransform> takeWaiting(std::uint32_t frame, Time holders_newest) {
    return claims_.take(frame, holders_newest);
  }
  /// Compares a transform of a rival with the holder's pose at its stamp.
  void compare(std::uint32_t frame, const Holder& holder, const FrameClaims::RivalTransform& rival, Time reading);
  /// The claim `next` replaces that of the holder. If the two take turns, that is a contradiction.
  void change(std::uint32_t frame, const Holder& holder, const FrameClaim& next, Time reading);
  /// The holder and another claim contradict each other.
  void contradict(std::uint32_t frame, const Holder& holder, const FrameClaim& other, Time reading);
  /// Drops all transforms that wait, because the clock jumped.
  void forgetTransforms() { claims_.forgetTransforms(); }

  const FrameClaims& claims() const { return claims_; }

 private:
  Ledger& ledger_;
  FrameClaims claims_;
};

}  // namespace hgrid
