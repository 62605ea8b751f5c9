// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tf/frame_rivals.h"

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

// Two poses that differ by at most this much agree. A frame may move a little between the transforms of two publishers.
constexpr double kSameDistance = 0.01;  // [m]
constexpr double kSameAngle = 0.01;     // [rad]

bool agree(const FramePose& a, const FramePose& b) {
  const double angle = a.rotation.angularDistance(b.rotation);
  return (a.translation - b.translation).norm() <= kSameDistance && angle <= kSameAngle;
}

}  // namespace

void FrameRivals::take(std::uint32_t frame, const Holder& holder, const FrameClaims::RivalTransform& rival,
                       Time reading) {
  ledger_.count("tf.rival");
  if (rival.stamp <= holder.newest) {
    compare(frame, holder, rival, reading);
  } else {
    claims_.keep(frame, rival);
  }
}

void FrameRivals::compare(std::uint32_t frame, const Holder& holder, const FrameClaims::RivalTransform& rival,
                          Time reading) {
  if (rival.claim.parent == holder.claim.parent) {
    if (rival.claim.publisher == holder.claim.publisher) return;  // the rival has become the holder meanwhile
    const std::optional<FramePose> held = holder.pose_at(rival.stamp);
    if (!held) return;  // the holder's pose at that time is not known
    if (agree(*held, rival.parent_from_frame)) return;
  }
  contradict(frame, holder, rival.claim, reading);
}

void FrameRivals::change(std::uint32_t frame, const Holder& holder, const FrameClaim& next, Time reading) {
  if (claims_.change(frame, holder.claim, next, reading)) contradict(frame, holder, next, reading);
}

void FrameRivals::contradict(std::uint32_t frame, const Holder& holder, const FrameClaim& other, Time reading) {
  claims_.contradict(frame, holder.frame, holder.claim, other, reading);
  ledger_.refuse("tf.fight", Refusal(Code::conflict, claims_.sentence(frame)));
}

}  // namespace hgrid
