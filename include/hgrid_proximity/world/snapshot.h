// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/bodies/source.h"
#include "hgrid_proximity/broadphase/broad_phase_reader.h"
#include "hgrid_proximity/maps/map_cells.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/pairs/near_pair.h"
#include "hgrid_proximity/pairs/pair_event.h"
#include "hgrid_proximity/pairs/pair_filter.h"
#include "hgrid_proximity/pairs/pair_margins.h"

namespace hgrid {

/// What does not change while bodies move; snapshots of one revision share it.
struct Structure {
  std::uint64_t revision = 0;
  std::vector<Body> bodies;                ///< sorted by name
  std::vector<BodyId> ids;                 ///< handle of each body
  std::vector<std::uint32_t> first_proxy;  ///< proxies of body i: first_proxy[i] .. first_proxy[i + 1] - 1
  std::vector<std::uint32_t> body_of_proxy;
  std::vector<std::uint32_t> maps;       ///< bodies that are maps or clouds, ascending
  std::vector<std::string> sources;      ///< where the bodies come from, as sourceOf() names it, sorted
  std::vector<std::uint32_t> source_of;  ///< of each body: index into sources
  std::vector<std::string> absent;       ///< globs of required bodies that no body matches
  std::vector<double> margin;            ///< [m] of each body, at least the global one
  double least_margin = 0.0;             ///< [m] the global one
  PairMargins pair_margins;              ///< of pairs that have one of their own
  PairFilter filter;
  bool silenced = false;  ///< rules switch off every pair that would be reported without them

  bool isMap(std::uint32_t body) const { return bodies[body].kind == BodyKind::map; }

  static constexpr std::uint32_t kNone = 0xffffffff;
  /// Index of the body of this name, or kNone.
  std::uint32_t find(const std::string& name) const;
};

/// Where a body is in a snapshot, and how far that can be trusted.
struct BodyPose {
  Pose world_from_body = Pose::Identity();  ///< meaningless while unplaced
  Time stamp{0};                            ///< of the pose; where nothing can move it, when it was put there
  Freshness state = Freshness::unplaced;
  double age = 0.0;  ///< [s] of the pose when the snapshot was made; 0 if fixed
  /// [m] How far a point of the body may be from where this pose puts it, since the body is stale: max_speed * age.
  double reach = 0.0;
  double growth = 0.0;       ///< [m] by which the body's margins are widened: the reach, but at most a cap
  std::uint32_t cohort = 0;  ///< bodies of one robot with equal numbers (not 0) are equally old
};

enum class Verdict : std::uint8_t { unknown = 0, clear = 1, hit = 2 };

/// Why a verdict is unknown. The numbers are part of the interface: do not change them.
enum class Unknown : std::uint8_t { no = 0, refused = 1, incomplete = 2, stale_body = 3, outdated = 4, unmapped = 5 };

/// Which bodies a query is about, and how many hits it wants.
struct QueryScope {
  std::vector<std::string> include;  ///< globs over body names; empty: all
  std::vector<std::string> exclude;  ///< globs over body names; beat include
  std::uint32_t limit = 0;           ///< most hits; 0: all
  /// By it distances to shapes are measured; null: by boxes. What has no solid, or fails, counts as hit by its box.
  const NarrowPhase* exact = nullptr;
};

/// A box that is asked for.
struct QueryBox {
  Pose world_from_box = Pose::Identity();  ///< of its centre
  Eigen::Vector3d size;                    ///< [m] full lengths, >= 0
};

/// One body that a query met.
struct QueryHit {
  std::uint32_t body = 0;                  ///< index into Structure::bodies
  std::uint32_t shape = 0;                 ///< index of the nearest (segment: first met) of its shapes
  Measure status = Measure::not_measured;  ///< of exact ones
  double distance = 0.0;  ///< [m] from the query's surface to the body's box (exact: shape); 0 where they overlap
  double center_distance = 0.0;  ///< [m] the same from the query's centre or axis; between two bodies as distance
  /// [m] segment only; in an open mesh, which it may enter without a touch, no later than where it meets the surface
  double along = Proximity::kUnknown;
  double cell_edge = Proximity::kUnknown;  ///< [m] maps and clouds: of the cell met, the nearest or first
  /// [m, world] point of the box (exact: shape) nearest to centre or axis; of a shape that a segment meets the point
  /// that it meets first. NaN: unknown, as inside a shape
  Eigen::Vector3d point = Eigen::Vector3d::Constant(Proximity::kUnknown);
  Eigen::Vector3d own_point = Eigen::Vector3d::Constant(Proximity::kUnknown);  ///< nearest to a body: point on that one
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(Proximity::kUnknown);  ///< exact: outward unit normal of the shape
};

/// What a query found. A verdict of unknown has a reason.
struct QueryAnswer {
  Verdict verdict = Verdict::unknown;
  std::vector<QueryHit> hits;     ///< by distance, center_distance, name; segment: by along, name
  std::uint64_t total = 0;        ///< bodies met; more than hits if there was a limit
  Unknown because = Unknown::no;  ///< why the verdict is unknown
  std::string reason;             ///< why nothing was found and it is still not clear
};

/// The world at one moment: immutable, read by any number of threads, alive as long as somebody holds it.
/// Coordinates of queries are in the world frame [m].
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
  /// What is occupied of a map or a cloud; null for other bodies, and while it is not known.
  std::shared_ptr<const MapCells> cellsOf(std::uint32_t body) const;
  /// [m] The least distance of the boxes of two bodies: those of their shapes, or the occupied cells of a map, which in
  /// the map's frame are held against the box around the other's box. Infinite if it is more than `up_to`, and where
  /// there are no boxes.
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
  /// [m] By how much it is wider since they are stale. Links of one robot that are equally old have not moved apart.
  double growthOf(std::uint32_t first, std::uint32_t second) const;
  /// Whether every source is complete: each of its bodies is known, placed and covered, and none is lost, frozen or
  /// invalid.
  bool complete() const { return reasons_total_ == 0; }
  /// Names of the sources that are not complete, sorted.
  const std::vector<std::string>& incompleteSources() const { return incomplete_; }
  /// Why this source is not complete, the worst reason; empty if it is complete.
  std::string reasonOf(const std::string& source) const;
  /// What sources lack beside the trouble of single bodies, as the scene was told.
  const std::vector<SourceGap>& gaps() const { return gaps_; }
  /// Why the world is not complete, the worst first, at most as many as the scene was told to keep.
  const std::vector<std::string>& reasons() const { return reasons_; }
  std::uint32_t reasonsTotal() const { return reasons_total_; }
  Freshness worstState() const { return worst_state_; }
  /// [s] of the oldest pose of a moving body.
  double maxAge() const { return max_age_; }
  /// The broad phase. It stores the boxes of the placed proxies, each grown by its share of the margins.
  const BroadPhaseReader& broadPhase() const { return *broad_phase_; }

  /// [s] From stamp() on, two bodies that are at least so far apart [m] at their poses do not meet earlier, by their
  /// bounds of speed; by how much a pose is older than stamp() counts. NaN where a bound is missing, infinite where
  /// neither can move.
  double noContactBefore(std::uint32_t first, std::uint32_t second, double distance) const;

  /// Bodies whose boxes the ball touches; the pair filter does not apply, padding counts, margins do not.
  /// @throws Refusal nonfinite, bad_geometry (negative radius), out_of_range (beyond kQueryReach)
  QueryAnswer query(const Sphere& sphere, const QueryScope& scope) const;
  /// Bodies whose boxes the segment meets, in order along it; otherwise as above.
  QueryAnswer query(const Segment& segment, const QueryScope& scope) const;
  /// Bodies whose boxes (exact: shapes) the box touches; otherwise as above. @param narrow_phase  measures also by
  /// boxes
  QueryAnswer query(const QueryBox& box, const NarrowPhase& narrow_phase, const QueryScope& scope) const;
  /// The scope.limit (0: one) bodies nearest to a point, at most so far away [m]; otherwise as above.
  QueryAnswer nearest(const Eigen::Vector3d& point, double max_distance, const QueryScope& scope) const;
  /// The same to another body, itself left out. @throws Refusal not_ready if it has no pose or no shapes
  QueryAnswer nearest(std::uint32_t body, double max_distance, const QueryScope& scope) const;

  /// Whether a query is about a body.
  bool inScope(const QueryScope& scope, std::uint32_t body) const;
  /// Whether a query is about bodies that a gap may hide.
  bool inScope(const QueryScope& scope, const SourceGap& gap) const;

  /// [m] queries may reach this far from the world's origin.
  static constexpr double kQueryReach = 1e10;

 private:
  friend class Scene;
  friend struct PooledSnapshot;
  Snapshot() = default;
  struct Probe;
  class Region;
  class SphereRegion;
  class SegmentRegion;
  class BoxRegion;
  class BodyRegion;
  QueryAnswer finished(std::vector<QueryHit>& hits, const QueryScope& scope, bool by_along, const Region& region) const;
  void doubt(const QueryScope& scope, const Region& region, QueryAnswer& answer) const;
  bool doubtBody(std::uint32_t body, const QueryScope& scope, const Region& region, QueryAnswer& answer) const;
  bool mayMeet(std::uint32_t body, const QueryScope& scope, const Region& region) const;
  bool hasGap(const std::string& body) const;
  double reachBetween(std::uint32_t first, std::uint32_t second) const;
  template <class Asked, class Ask>
  QueryAnswer nearestBy(const Asked& asked, const Eigen::Vector3d& center, double reach, double max_distance,
                        const QueryScope& scope, const Region& region, const Ask& measure) const;
  template <class Look>
  void forEachMap(const QueryScope& scope, Look&& look) const;
  void addMaps(const Sphere& sphere, const QueryScope& scope, std::vector<QueryHit>& hits) const;
  void addMaps(const Segment& segment, const QueryScope& scope, std::vector<QueryHit>& hits) const;
  void addMaps(const QueryBox& box, const NarrowPhase& narrow_phase, const QueryScope& scope,
               std::vector<QueryHit>& hits) const;
  void addMapsNear(const Eigen::Vector3d& point, double limit, const QueryScope& scope,
                   std::vector<QueryHit>& hits) const;
  void addMapsNear(std::uint32_t body, double limit, const QueryScope& scope, std::vector<QueryHit>& hits) const;
  template <class Knows>
  bool knownToNone(const QueryScope& scope, const Knows& knows) const;
  bool unmapped(const Sphere& sphere, const QueryScope& scope) const;
  bool unmapped(const Segment& segment, const QueryScope& scope) const;
  bool unmapped(const QueryBox& box, const NarrowPhase& narrow_phase, const QueryScope& scope) const;
  bool unmappedNear(const Eigen::Vector3d& point, double limit, const QueryScope& scope) const;
  bool unmappedNear(std::uint32_t body, double limit, const QueryScope& scope) const;
  void measureFrom(ProxyId own, ProxyId proxy, double up_to, const QueryScope& scope, QueryHit& hit) const;

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
  double max_age_ = 0.0, max_growth_ = 0.0;
  bool report_unmapped_ = false;
  const BroadPhaseReader* broad_phase_ = nullptr;  // lives as long as the snapshot: see PooledSnapshot
};

}  // namespace hgrid
