// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// All that a Scene can be told.
struct SceneOptions {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m, world] boxes are stored relative to it
  double margin = 0.10;                              ///< [m] boxes this close or closer are candidates, 0 .. 1e3
  double event_hysteresis = 0.02;                    ///< [m] a pair's end is told this far beyond its margin, 0 .. 1e3
  double finest_edge = 0.0;                          ///< [m] HGrid's finest level, 1e-6 .. 1e3; 0: from the bodies
  double world_limit = 1e6;                          ///< [m] poses beyond are refused, per axis; at most 1e6
  double growth_cap = 1.0;                           ///< [m] most that an old body's margins are widened by
  double growth_after = 0.25;  ///< [s] margins of a body whose pose is older are widened, whatever its state
  std::size_t max_bodies = 100000;
  /// Pairs that a snapshot lists; 0: no limit. It also bounds the work and the memory of a tick: the search collects at
  /// most 4 times as many pairs of boxes, or 65536 if that is more. Snapshot::truncated() says that a limit was
  /// reached.
  std::size_t max_pairs = 100000;
  std::size_t max_reasons = 8;  ///< reasons that a snapshot lists
  int threads = 1;              ///< that the broad phase may use, 1 .. 64
  /// [s] Pairs that can meet within it, by their bodies' max_speed, are candidates too, as are those that passed each
  /// other since the last commit; 0 .. 60; 0: neither
  double horizon = 0.0;
  std::vector<PairMargin> pair_margins;  ///< margins of pairs, 0 .. 1e3; what is below `margin` counts as that
  /// A CLEAR is said only of space that one of the maps asked about knows to be free; otherwise it becomes UNKNOWN.
  bool report_unmapped = false;
  /// Globs of bodies without which the world is incomplete: each must match one.
  std::vector<std::string> required;
  PairKinds pair_kinds;
  std::vector<PairRule> allowed_pairs;  ///< rules to begin with
};

/// Time a part of a tick took.
struct TickTimes {
  std::chrono::nanoseconds boxes{0}, grid{0}, pairs{0};
};

/// What the world consists of and where it is: the only writer. One thread at a time; the snapshots that it
/// makes may be read by any.
///
/// Usage per tick: add, remove, place and setState as news come in, then commit().
///
/// Wrong input throws Refusal, here as everywhere in the core but the broad phase. A call that throws, also for lack of
/// memory, has changed nothing. After a commit() that threw, the next one makes the snapshot that it would have made
/// without it: numbers have no gap, and no pair and no event is lost.
class Scene {
 public:
  /// @throws Refusal out_of_range, naming the option
  explicit Scene(const SceneOptions& options);
  ~Scene();
  Scene(Scene&&) noexcept;

  /// Takes in a body; it is unplaced until place() is called.
  /// @throws Refusal dup_id, bad_id, limit, or out_of_range (padding, margin); then nothing has changed.
  BodyId add(Body body);
  /// @throws Refusal unknown_id if the handle is not (or no longer) valid.
  void remove(BodyId id);
  /// Removes the bodies `out` and adds the bodies `in`, all of it or nothing. A body that comes may have the name of
  /// one that leaves.
  /// @returns the handles of `in`, in their order
  /// @throws Refusal unknown_id, dup_id, or as add()
  std::vector<BodyId> exchange(const std::vector<BodyId>& out, std::vector<Body> in);
  /// Handle of the body of this name, if there is one.
  bool find(const std::string& name, BodyId& id) const;
  /// @throws Refusal unknown_id
  const Body& body(BodyId id) const;
  std::size_t size() const;

  /// Puts a body at a pose taken at `stamp`. Its state does not change.
  /// @throws Refusal unknown_id, nonfinite, out_of_range; then it stays where it was.
  void place(BodyId id, const Pose& world_from_body, Time stamp);
  /// Throws what place() would throw.
  void checkPlace(BodyId id, const Pose& world_from_body) const;
  /// Says how far the body's pose can be trusted. `age` [s]; `cohort` as in BodyPose.
  /// A body without a pose stays unplaced whatever is said.
  void setState(BodyId id, Freshness state, double age, std::uint32_t cohort = 0);
  /// Last known pose of a body.
  const BodyPose& poseOf(BodyId id) const;

  /// Says what is occupied of a body of kind map, from the next commit on. That is no change of the structure.
  /// @throws Refusal unknown_id, bad_geometry (a body of another kind, or no cells)
  void setCells(BodyId id, std::shared_ptr<const MapCells> cells);

  /// Replaces all rules of the allowed-pair matrix from the next commit on. Of two that are equally exact the stronger
  /// comes last.
  void setRules(std::vector<PairRule> rules);

  /// Makes the snapshot of now.
  /// @param gaps  what sources lack beside the trouble of single bodies; each makes its source incomplete
  std::shared_ptr<const Snapshot> commit(Time stamp, const std::vector<SourceGap>& gaps);

  /// A new epoch: the numbers of ticks and events start again and pairs forget since when they are near.
  void beginEpoch(std::uint64_t epoch);

  std::uint64_t revision() const;
  const TickTimes& lastTimes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hgrid
