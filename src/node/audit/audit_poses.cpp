// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/audit_poses.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

#include "hgrid_proximity/refusal.h"
#include "node/audit/recorded_frames.h"

namespace hgrid {
namespace {

// Two positions count as equal if their distance is at most kPosition [m] plus kRelative times the largest coordinate.
constexpr double kPosition = 1e-6;
constexpr double kRelative = 1e-10;
constexpr double kRotation = 1e-7;  // entries of two rotation matrices count as equal if they differ by at most this

/// Returns a small number with three digits.
std::string shortText(double number) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.3g", number);
  return digits;
}

std::string secondsOf(Time time) { return text(seconds(time)) + " s"; }

Time nanosecondsOf(double duration) { return Time(std::llround(1e9 * duration)); }

std::string unexplained(const Body& body, const BodyPose& pose) {
  return "body '" + printable(body.name) + "' has a pose of " + secondsOf(pose.stamp) +
         ", but no transforms that were received place it then";
}

/// Compares the pose of one body.
class PoseAudit {
 public:
  PoseAudit(const AuditCase& audited, const RecordedFrames& frames, const RecordedFrames::Chain& chain,
            std::size_t body)
      : audited_(audited), frames_(frames), chain_(chain), body_(audited.bodies[body]), pose_(audited.poses[body]) {}

  /// Returns a sentence about the difference; empty if there is none. Sets `compared` to false if the record has too
  /// few transforms to compare the pose.
  std::string difference(bool& compared) const {
    if (pose_.state == Freshness::unplaced) return unplaced(compared);
    if (const std::string lag = lagging(); !lag.empty()) return lag;
    const auto expected = frames_.poseAt(chain_, chain_.moves ? pose_.stamp : audited_.stamp);
    if (!expected) return withoutTransforms(compared);
    return differenceFrom(*expected * body_.frame_from_body);
  }

 private:
  std::string subject() const { return "body '" + printable(body_.name) + "'"; }

  std::string unplaced(bool& compared) const {
    const auto expected = frames_.poseAt(chain_, audited_.stamp);
    compared =
        expected && (*expected * body_.frame_from_body).translation().cwiseAbs().maxCoeff() < audited_.world_limit;
    return compared ? subject() + " has no pose, but the transforms place it at the time of the tick" : "";
  }

  /// Returns a sentence if the node has read newer transforms than those that it used; otherwise an empty text.
  std::string lagging() const {
    if (!chain_.moves || pose_.state >= Freshness::frozen) return "";
    const Time known = std::min(audited_.stamp, frames_.newestTime(chain_));
    const auto newest = frames_.sampledUpTo(chain_, known);
    if (!newest || pose_.stamp >= *newest) return "";
    return subject() + " has a pose of " + secondsOf(pose_.stamp) + ", but transforms of " + secondsOf(*newest) +
           " had been read";
  }

  /// Returns a sentence that no transforms explain the pose. If transforms that the record has dropped may explain it,
  /// returns an empty text and sets `compared` to false.
  std::string withoutTransforms(bool& compared) const {
    compared = frames_.newestTime(chain_) < pose_.stamp || audited_.record_begin.count() == 0;
    return compared ? unexplained(body_, pose_) : "";
  }

  std::string differenceFrom(const Pose& expected) const {
    const Eigen::Vector3d off = pose_.world_from_body.translation() - expected.translation();
    const double allowed = kPosition + kRelative * expected.translation().cwiseAbs().maxCoeff();
    const double turned = (pose_.world_from_body.linear() - expected.linear()).cwiseAbs().maxCoeff();
    if (off.norm() <= allowed && turned <= kRotation) return "";
    return subject() + " is " + shortText(off.norm()) + " m away from where the transforms of " +
           secondsOf(pose_.stamp) + " place it (entries of its rotation matrix differ by " + shortText(turned) + ")";
  }

  const AuditCase& audited_;
  const RecordedFrames& frames_;
  const RecordedFrames::Chain& chain_;
  const Body& body_;
  const BodyPose& pose_;
};

/// Checks that the time of the tick is at most ~limits/max_sync_wait older than the newest transforms.
/// @param newest  the newest time for which all transforms of a body were known; Time::min() if there is none
void auditTime(const AuditCase& audited, Time newest, AuditFindings& findings) {
  if (newest == Time::min() || audited.stamp >= newest - nanosecondsOf(audited.max_sync_wait)) return;
  findings.add("the time of the tick is " + secondsOf(audited.stamp) + ", but transforms of " + secondsOf(newest) +
               " had been read; ~limits/max_sync_wait is " + text(audited.max_sync_wait) + " s");
}

}  // namespace

void auditPoses(const AuditCase& audited, AuditFindings& findings) {
  const RecordedFrames frames(audited);
  std::map<std::string, std::optional<RecordedFrames::Chain>> chains;
  Time newest = Time::min();
  // The record contains each transform with a later stamp than this: a stamp is at most ~limits/max_future later than the time
  // at which the transform was received.
  const Time explained_from = audited.record_begin + nanosecondsOf(audited.max_future);
  const Time latest = audited.made + nanosecondsOf(audited.max_sync_wait);
  for (std::size_t i = 0; i < audited.bodies.size(); ++i) {
    const Body& body = audited.bodies[i];
    const auto [entry, is_new] = chains.try_emplace(body.frame);
    if (is_new) entry->second = frames.chain(audited.world_frame, body.frame);
    const auto& chain = entry->second;
    const BodyPose& pose = audited.poses[i];
    // A cloud or a track keeps the pose that it had at the stamp of its message. The record has no such messages.
    const bool follows_frame = body.kind != BodyKind::cloud && body.kind != BodyKind::track;
    bool compared = follows_frame && chain && !chain->doubtful;
    // A link can have a pose without transforms of its own frame: fixed joints connect it with another link.
    const bool needs_chain = follows_frame && body.kind != BodyKind::link;
    if (!chain && audited.all_static && pose.state != Freshness::unplaced && needs_chain &&
        pose.stamp > explained_from) {
      findings.add(unexplained(body, pose));
    }
    if (compared) {
      const std::string difference = PoseAudit(audited, frames, *chain, i).difference(compared);
      if (!difference.empty()) findings.add(difference);
      if (chain->moves && frames.newestTime(*chain) <= latest) newest = std::max(newest, frames.newestTime(*chain));
    }
    ++(compared ? findings.poses : findings.poses_skipped);
  }
  auditTime(audited, newest, findings);
}

}  // namespace hgrid
