// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Decides which sources of a snapshot are complete, and why the other sources are not.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "world/body_gap.h"
#include "world/scene_state.h"

namespace hgrid {
namespace {

/// Returns the source gap for a pattern of required bodies that no body matches.
SourceGap gapOfAbsent(const std::string& pattern) {
  const std::string source = pattern.substr(0, pattern.find('/'));
  const bool one_of_many = source == "map" || source == "cloud";  // each map or cloud is a source of its own
  return {source == "track" ? trackerOf(pattern)
          : one_of_many     ? pattern
                            : source,
          pattern,
          "REQUIRED '" + printable(pattern) + "': no body matches this pattern; add such a body, or do not require it"};
}

/// Returns whether a link may have moved since its pose, and its robot has a link in another rigid group with which it
/// is a pair. The margins of such pairs do not grow, see movedTogether().
bool mayHaveBent(const Structure& structure, std::uint32_t body, const BodyPose& pose) {
  if (pose.reach == 0.0 || pose.cohort == 0) return false;
  const Body& link = structure.bodies[body];
  if (link.robot.empty()) return false;
  const auto isPartner = [&](std::uint32_t other) {
    return structure.bodies[other].rigid_group != link.rigid_group && !structure.filter.allowed(body, other);
  };
  // The bodies of a source follow each other, because they are sorted by name.
  const std::uint32_t source = structure.source_of[body];
  for (std::uint32_t i = body; i-- > 0 && structure.source_of[i] == source;) {
    if (isPartner(i)) return true;
  }
  for (std::uint32_t i = body + 1; i < structure.bodies.size() && structure.source_of[i] == source; ++i) {
    if (isPartner(i)) return true;
  }
  return false;
}

/// Returns whether a body may be farther from its pose than the margins of its pairs have grown.
bool isOutgrown(const BodyPose& pose) { return pose.reach > pose.growth; }

/// Returns whether a body makes its source incomplete.
bool leavesGap(const Structure& structure, std::uint32_t body, const BodyPose& pose) {
  const Body& what = structure.bodies[body];
  if (pose.state >= Freshness::lost || (!what.covered && !what.waived)) return true;
  return isOutgrown(pose) || mayHaveBent(structure, body, pose);
}

/// Returns a length [m] with three digits.
std::string metersText(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", length);
  return text;
}

/// Returns why a body makes its source incomplete, or an empty text if it does not.
std::string gapSentence(const Structure& structure, std::uint32_t body, const BodyPose& pose) {
  const Body& what = structure.bodies[body];
  std::string gap = gapLeftBy(what, pose);
  if (!gap.empty() || !leavesGap(structure, body, pose)) return gap;
  gap = std::string(name(pose.state)) + " " + what.name + ": its pose is " + secondsText(pose.age) + " old (frame '" +
        printable(what.frame) + "'), so ";
  if (!isOutgrown(pose))
    return gap + "the joints may have moved, and the margins of the robot's own pairs do not grow for that";
  const bool known = std::isfinite(pose.reach);
  return gap + "it may have moved " + (known ? metersText(pose.reach) : "any distance") +
         ", but margins grow by at most " + metersText(pose.growth) + " (growth_cap)";
}

void sortNames(std::vector<std::string>& names) {
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace

std::string causeOf(Freshness state) {
  return state == Freshness::invalid ? "newer data was refused, or several publishers contradict each other; " : "";
}

std::string gapLeftBy(const Body& body, const BodyPose& pose) {
  if (pose.state == Freshness::unplaced) {
    return "UNPLACED " + body.name + ": it never had a pose (frame '" + printable(body.frame) + "')";
  }
  if (!body.covered && !body.waived) return "UNCOVERED " + body.name + ": " + body.note;
  if (pose.state >= Freshness::lost) {
    return std::string(name(pose.state)) + " " + body.name + ": " + causeOf(pose.state) +
           (body.kind == BodyKind::cloud ? "its newest points are " : "its pose is ") + secondsText(pose.age) +
           " old (frame '" + printable(body.frame) + "')";
  }
  return {};
}

void Scene::State::fillCompleteness(Snapshot& snapshot, const std::vector<SourceGap>& gaps) const {
  snapshot.gaps_ = gaps;
  for (const std::string& pattern : structure->absent) snapshot.gaps_.push_back(gapOfAbsent(pattern));
  snapshot.doubtful_.clear();
  snapshot.incomplete_.clear();
  snapshot.reasons_.clear();
  snapshot.reasons_total_ = static_cast<std::uint32_t>(snapshot.gaps_.size());
  for (const SourceGap& gap : snapshot.gaps_) {
    snapshot.incomplete_.push_back(gap.source);
    if (snapshot.reasons_.size() < options.max_reasons) snapshot.reasons_.push_back(gap.sentence);
  }
  if (snapshot.worst_state_ >= Freshness::stale || snapshot.max_reach_ > 0.0 || !structure->uncovered.empty()) {
    fillDoubtful(snapshot);
  }
  sortNames(snapshot.incomplete_);
}

/// Lists the bodies that a query must check before it answers CLEAR. Lists the reasons for the worst of the bodies that
/// make their source incomplete.
void Scene::State::fillDoubtful(Snapshot& snapshot) const {
  std::vector<std::pair<int, std::uint32_t>> worst_first;  // negated state and body, so that the worst sorts first
  std::vector<bool> incomplete(structure->sources.size());
  const std::vector<std::uint32_t>& uncovered = structure->uncovered;
  auto next_uncovered = uncovered.begin();
  for (std::uint32_t i = 0; i < snapshot.poses_.size(); ++i) {
    const BodyPose& pose = snapshot.poses_[i];
    const bool covered = next_uncovered == uncovered.end() || *next_uncovered != i;
    if (!covered) ++next_uncovered;
    if (covered && pose.state < Freshness::stale && pose.reach == 0.0) continue;
    snapshot.doubtful_.push_back(i);
    if (!leavesGap(*structure, i, pose)) continue;
    if (snapshot.hasGap(structure->bodies[i].name)) continue;  // the gap is already counted as a reason
    worst_first.emplace_back(-static_cast<int>(pose.state), i);
    incomplete[structure->source_of[i]] = true;
  }
  for (std::size_t source = 0; source < incomplete.size(); ++source) {
    if (incomplete[source]) snapshot.incomplete_.push_back(structure->sources[source]);
  }
  snapshot.reasons_total_ += static_cast<std::uint32_t>(worst_first.size());
  const std::size_t listed = std::min(worst_first.size(), options.max_reasons - snapshot.reasons_.size());
  std::partial_sort(worst_first.begin(), worst_first.begin() + static_cast<std::ptrdiff_t>(listed), worst_first.end());
  for (std::size_t i = 0; i < listed; ++i) {
    const std::uint32_t body = worst_first[i].second;
    snapshot.reasons_.push_back(gapSentence(*structure, body, snapshot.poses_[body]));
  }
}

std::string Snapshot::reasonOf(const std::string& source) const {
  for (const SourceGap& gap : gaps_) {
    if (gap.source == source) return gap.sentence;
  }
  std::uint32_t worst = Structure::kNone;
  for (const std::uint32_t body : doubtful_) {
    if (structure_->sources[structure_->source_of[body]] != source) continue;
    if (!leavesGap(*structure_, body, poses_[body])) continue;
    if (worst == Structure::kNone || poses_[body].state > poses_[worst].state) worst = body;
  }
  return worst == Structure::kNone ? std::string() : gapSentence(*structure_, worst, poses_[worst]);
}

}  // namespace hgrid
