// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/source.h"
#include "hgrid_proximity/broadphase/broad_phase_reader.h"
#include "hgrid_proximity/maps/map_cells.h"
#include "hgrid_proximity/pairs/pair_event.h"
#include "hgrid_proximity/pairs/near_pair.h"
#include "hgrid_proximity/world/body_pose.h"
#include "hgrid_proximity/world/structure.h"

namespace hgrid {

/// The world at one moment, as data: immutable, read by any number of threads, alive as long as somebody holds it.
///
/// The room queries/ answers questions about it, distances/ measures its pairs, explain/ explains them.
class Snapshot {
 public:
  const Structure& structure() const { return *structure_; }
  Time stamp() const { return stamp_; }
  std::uint64_t sequence() const { return sequence_; }
  std::uint64_t epoch() const { return epoch_; }
  /// Per body, in the order of structure().bodies.
  const std::vector<BodyPose>& poses() const { return poses_; }
  /// Per proxy, relative to origin(); meaningless for proxies of unplaced bodies.
  const std::vector<Aabb>& boxes() const { return boxes_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  /// The occupied cells of each of structure().maps; null while they are not known.
  const std::vector<std::shared_ptr<const MapCells>>& cells() const { return cells_; }
  /// The occupied cells of a body; null if it is no map or cloud, and while they are not known.
  std::shared_ptr<const MapCells> cellsOf(std::uint32_t body) const;
  /// [m] The least distance of the boxes of two bodies; infinite if it is more than `up_to` or a body has no boxes.
  /// The boxes of a map are its occupied cells. They are compared, in the map's frame, with the box around the other
  /// body's box.
  double gapOf(std::uint32_t first, std::uint32_t second, double up_to = std::numeric_limits<double>::infinity()) const;
  /// Candidates that the filter does not leave out, sorted by (first, second). If truncated(), some are missing: of the
  /// candidates that were collected, those with the smallest gaps are listed, and of equal gaps the first by name.
  const std::vector<NearPair>& pairs() const { return pairs_; }
  /// Whether candidates may be missing from pairs(), because of SceneOptions::max_pairs. Queries miss nothing.
  bool truncated() const { return searchCut() || pairs_found_ > pairs_.size(); }
  /// Whether the search ended at its limit. Otherwise it found all candidates.
  bool searchCut() const { return search_cut_; }
  /// Number of candidates that the search found. If searchCut(), there may be more.
  std::uint64_t pairsFound() const { return pairs_found_; }
  /// Pairs that began or ended since the snapshot before, by number: the ends, then the begins.
  const std::vector<PairEvent>& events() const { return events_.events; }
  /// Number of the newest event of the epoch; 0: there was none.
  std::uint64_t lastEvent() const { return events_.last; }
  /// What the bodies of an event are indices into: those of an end may be gone from structure().
  const Structure& structureOf(const PairEvent& event) const {
    return event.kind == EventKind::end && event.cause == EventCause::bodies ? *events_.before : *structure_;
  }
  /// [m] The margin that a pair of bodies has while both are fresh.
  double marginOf(std::uint32_t first, std::uint32_t second) const;
  /// [m] By how much that margin is widened because the bodies are stale. It is 0 for links of one robot whose poses
  /// have the same age.
  double growthOf(std::uint32_t first, std::uint32_t second) const;
  /// Whether every source is complete: each of its bodies is known, placed and covered, and none is lost, frozen or
  /// invalid.
  bool complete() const { return reasons_total_ == 0; }
  /// Names of the sources that are not complete, sorted.
  const std::vector<std::string>& incompleteSources() const { return incomplete_; }
  /// Why this source is not complete, the worst reason; empty if it is complete.
  std::string reasonOf(const std::string& source) const;
  /// What sources lack in addition to the trouble of single bodies, as the scene was told.
  const std::vector<SourceGap>& gaps() const { return gaps_; }
  /// Whether one of gaps() is about exactly the body of this name.
  bool hasGap(const std::string& body) const;
  /// Bodies that are stale or worse or may have moved since their pose, and bodies that are not covered, ascending.
  const std::vector<std::uint32_t>& doubtful() const { return doubtful_; }
  /// Whether a query may answer CLEAR only for space that a map knows to be free (SceneOptions::report_unmapped).
  bool reportsUnmapped() const { return report_unmapped_; }
  /// Why the world is not complete, the worst first, at most as many as the scene was told to keep.
  const std::vector<std::string>& reasons() const { return reasons_; }
  std::uint32_t reasonsTotal() const { return reasons_total_; }
  Freshness worstState() const { return worst_state_; }
  /// [s] of the oldest pose of a moving body.
  double maxAge() const { return max_age_; }
  /// The broad phase. It stores the boxes of the placed proxies, each grown by its share of the margins.
  const BroadPhaseReader& broadPhase() const { return *broad_phase_; }

  /// [s] Two bodies that are at least `distance` [m] apart at their poses do not meet within this time after stamp().
  /// It follows from their bounds of speed; a pose that is older than stamp() shortens it. NaN if a bound is missing,
  /// infinite if neither body can move.
  double noContactBefore(std::uint32_t first, std::uint32_t second, double distance) const;

 private:
  friend class Scene;
  friend struct PooledSnapshot;
  Snapshot() = default;

  std::shared_ptr<const Structure> structure_;
  Time stamp_{0};
  std::uint64_t sequence_ = 0, epoch_ = 0, commit_ = 0;  // commit_: never starts again
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<BodyPose> poses_;
  std::vector<Aabb> boxes_;
  std::vector<std::shared_ptr<const MapCells>> cells_;  // of structure_->maps
  std::vector<NearPair> pairs_;
  std::uint64_t pairs_found_ = 0;
  bool search_cut_ = false;
  PairEventList events_;
  std::vector<SourceGap> gaps_;
  std::vector<std::uint32_t> doubtful_;  // bodies that are stale or worse, or not covered
  std::vector<std::string> incomplete_;
  std::vector<std::string> reasons_;
  std::uint32_t reasons_total_ = 0;
  Freshness worst_state_ = Freshness::fresh;
  double max_age_ = 0.0, max_growth_ = 0.0, max_reach_ = 0.0;
  bool report_unmapped_ = false;
  const BroadPhaseReader* broad_phase_ = nullptr;  // lives as long as the snapshot: see PooledSnapshot
};

}  // namespace hgrid
