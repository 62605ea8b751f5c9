// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/source.h"
#include "hgrid_proximity/broadphase/broad_phase_reader.h"
#include "hgrid_proximity/geometry/half_space.h"
#include "hgrid_proximity/maps/map_cells.h"
#include "hgrid_proximity/pairs/near_pair.h"
#include "hgrid_proximity/pairs/pair_event.h"
#include "hgrid_proximity/world/body_pose.h"
#include "hgrid_proximity/world/body_rooms.h"
#include "hgrid_proximity/world/structure.h"

namespace hgrid {

/// The state of the world at one tick. Immutable. Any number of threads may read it, as long as they hold a pointer.
///
/// The folder queries/ answers queries about a snapshot, distances/ measures its pairs, and explain/ explains them.
class Snapshot {
 public:
  /// The bodies, rules and margins of the snapshot: everything that does not change while bodies move.
  const Structure& structure() const { return *structure_; }
  /// Time of the tick.
  Time stamp() const { return stamp_; }
  /// Number of the tick in its epoch. The first tick of an epoch has the number 1.
  std::uint64_t sequence() const { return sequence_; }
  /// Number of the epoch, as passed to Scene::beginEpoch().
  std::uint64_t epoch() const { return epoch_; }
  /// Pose of each body, in the order of structure().bodies.
  const std::vector<BodyPose>& poses() const { return poses_; }
  /// Box of each proxy [m], relative to origin(); meaningless for planes and for the proxies of unplaced bodies.
  const std::vector<Aabb>& boxes() const { return boxes_; }
  /// Point [m, world] that boxes() are relative to.
  const Eigen::Vector3d& origin() const { return origin_; }
  /// The half-space of each of structure().planes, padding included, relative to origin(); meaningless for the planes
  /// of unplaced bodies.
  const std::vector<HalfSpace>& halfSpaces() const { return half_spaces_; }
  /// Returns the half-space of a proxy that is a plane.
  const HalfSpace& halfSpaceOf(std::uint32_t plane) const;
  /// Returns the distance [m] of the boxes of two proxies of placed bodies. For a plane, the half-space takes the place
  /// of the box. The distance of two planes is infinite, because they make no pair.
  double gapOfProxies(std::uint32_t first, std::uint32_t second) const;
  /// Returns whether gapOfProxies() is at most `margin` [m]. For two boxes the decision is exact.
  bool areWithin(std::uint32_t first, std::uint32_t second, double margin) const;
  /// The occupied cells of each of structure().maps; null while they are not known.
  const std::vector<std::shared_ptr<const MapCells>>& cells() const { return cells_; }
  /// The occupied cells of a body; null if the body is no map or cloud, or while its cells are not known.
  std::shared_ptr<const MapCells> cellsOf(std::uint32_t body) const;
  /// Returns the gap [m] of two bodies: the least distance of their boxes. It is infinite if it exceeds `up_to` or a
  /// body has no boxes. The boxes of a map are its occupied cells. For a pair with a map, each box of the other body is
  /// replaced by a box around it whose sides are parallel to the axes of the map. For planes, see gapOfProxies(); the
  /// gap of a plane and a map is infinite, because they make no pair.
  double gapOf(std::uint32_t first, std::uint32_t second, double up_to = std::numeric_limits<double>::infinity()) const;
  /// The pairs, sorted by (first, second). If truncated(), some pairs are missing. Then this lists the pairs with the
  /// smallest gaps among the pairs that the search collected. Among equal gaps, the names decide.
  const std::vector<NearPair>& pairs() const { return pairs_; }
  /// The rooms of the bodies; null if SceneOptions::building is null or has no rooms. The walls and openings of its
  /// building are relative to origin().
  const BodyRooms* rooms() const { return rooms_.get(); }
  /// Whether two bodies make no pair because they have no room in common.
  bool areSeparate(std::uint32_t first, std::uint32_t second) const {
    return rooms_ && rooms_->areSeparate(first, second);
  }
  /// Whether pairs() may lack some pairs, because of SceneOptions::max_pairs. Queries miss nothing in this case.
  bool truncated() const { return searchCut() || pairs_found_ > pairs_.size(); }
  /// Whether the search for pairs stopped at its limit. If not, the search found all pairs.
  bool searchCut() const { return search_cut_; }
  /// Number of pairs that the search found. If searchCut(), there may be more pairs.
  std::uint64_t pairsFound() const { return pairs_found_; }
  /// Events since the previous snapshot, sorted by number: first the END events, then the BEGIN events.
  const std::vector<PairEvent>& events() const { return events_.events; }
  /// Number of the newest event of the epoch; 0: there was none.
  std::uint64_t lastEvent() const { return events_.last; }
  /// The structure that the body indices of an event refer to. If a pair ended because a body was removed, this is the
  /// previous structure.
  const Structure& structureOf(const PairEvent& event) const {
    return event.kind == EventKind::end && event.cause == EventCause::bodies ? *events_.before : *structure_;
  }
  /// Returns the margin [m] that a pair of bodies has while both are fresh.
  double marginOf(std::uint32_t first, std::uint32_t second) const;
  /// Returns the length [m] by which the margin of the pair grows because its bodies are stale. It is 0 for links of
  /// one robot whose poses have the same age.
  double growthOf(std::uint32_t first, std::uint32_t second) const;
  /// Returns by how much [m] the distance of two bodies may be smaller than at their poses, because they may have moved
  /// since. 0 for links of one rigid group whose poses have the same age.
  double reachBetween(std::uint32_t first, std::uint32_t second) const;
  /// Whether every source is complete: each of its bodies is known, placed and covered; none is lost, frozen or
  /// invalid; none may be farther from its pose than margins grow; and no joint of a robot may have moved since old
  /// poses.
  bool complete() const { return reasons_total_ == 0; }
  /// Names of the sources that are not complete, sorted.
  const std::vector<std::string>& incompleteSources() const { return incomplete_; }
  /// Returns the most serious reason why this source is not complete; empty if it is complete.
  std::string reasonOf(const std::string& source) const;
  /// What the sources lack, apart from problems of single bodies: the gaps passed to Scene::commit(), then the absent
  /// required bodies.
  const std::vector<SourceGap>& gaps() const { return gaps_; }
  /// Whether one of gaps() names exactly this body as missing, not a glob.
  bool hasGap(const std::string& body) const;
  /// Indices of the bodies that are stale or worse, that may have moved since their pose, or that are not covered;
  /// ascending.
  const std::vector<std::uint32_t>& doubtful() const { return doubtful_; }
  /// Indices of the bodies that are not like a fixed body: the state is not fresh, or the pose has an age or a reach.
  /// All others are fresh, with age 0.
  const std::vector<std::uint32_t>& watched() const { return watched_; }
  /// Whether a query may answer CLEAR only for space that a map knows to be free (SceneOptions::report_unmapped).
  bool reportsUnmapped() const { return report_unmapped_; }
  /// Why the world is not complete: first the gaps(), then single bodies, the worst state first. At most
  /// SceneOptions::max_reasons reasons.
  const std::vector<std::string>& reasons() const { return reasons_; }
  /// Number of reasons why the world is not complete, including the reasons that reasons() does not list.
  std::uint32_t reasonsTotal() const { return reasons_total_; }
  /// The worst state of any body.
  Freshness worstState() const { return worst_state_; }
  /// Age [s] of the oldest pose of a moving body.
  double maxAge() const { return max_age_; }
  /// The broad phase. It stores the boxes of the placed proxies, each grown by its share of the margins. It does not
  /// hold planes.
  const BroadPhaseReader& broadPhase() const { return *broad_phase_; }

  /// Returns for how long after stamp() two bodies do not meet if they are at least `distance` [m] apart at their
  /// poses. The time is shorter if a pose is older than stamp().
  NoContact noContactBefore(std::uint32_t first, std::uint32_t second, double distance) const;

 private:
  friend class Scene;
  friend struct PooledSnapshot;
  friend class SnapshotRecord;  // History makes past snapshots again
  Snapshot() = default;

  // Scene and SnapshotRecord call these functions, so that a past snapshot has the same values as the live one.

  /// Computes half_spaces_ from structure_, poses_ and origin_.
  void fillHalfSpaces();
  /// Sets watched_, worst_state_, max_age_, max_growth_ and max_reach_ as if there were no bodies.
  void clearSummary();
  /// Adds a body to these values. Does nothing if the body is like a fixed body, see watched().
  void addToSummary(std::uint32_t body);

  std::shared_ptr<const Structure> structure_;
  Time stamp_{0};
  // commit_ is the number of the commit. Unlike sequence_, it does not start again from 1 in a new epoch.
  std::uint64_t sequence_ = 0, epoch_ = 0, commit_ = 0;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<BodyPose> poses_;
  std::vector<Aabb> boxes_;
  std::vector<HalfSpace> half_spaces_;                  // in the order of structure_->planes
  std::vector<std::shared_ptr<const MapCells>> cells_;  // in the order of structure_->maps
  std::shared_ptr<const BodyRooms> rooms_;              // see rooms()
  std::vector<NearPair> pairs_;
  std::uint64_t pairs_found_ = 0;
  bool search_cut_ = false;
  PairEventList events_;
  std::vector<SourceGap> gaps_;
  std::vector<std::uint32_t> doubtful_;  // see doubtful()
  std::vector<std::uint32_t> watched_;   // see watched()
  std::vector<std::string> incomplete_;
  std::vector<std::string> reasons_;
  std::uint32_t reasons_total_ = 0;
  Freshness worst_state_ = Freshness::fresh;
  double max_age_ = 0.0, max_growth_ = 0.0, max_reach_ = 0.0;
  bool report_unmapped_ = false;
  const BroadPhaseReader* broad_phase_ = nullptr;  // lives as long as the snapshot: see PooledSnapshot
};

}  // namespace hgrid
