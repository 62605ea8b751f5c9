// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/broadphase/rooms.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// The settings of a Scene.
struct SceneOptions {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m, world] boxes are stored relative to this point
  double margin = 0.10;            ///< [m] bodies whose boxes are this close or closer are candidate pairs, 0 .. 1e3
  double event_hysteresis = 0.02;  ///< [m] a pair ends when its gap exceeds its margin by more than this, 0 .. 1e3
  /// Makes a broad phase without boxes for `finest_edge` [m] and `threads`. Empty: makes an HGrid. The kind of broad
  /// phase changes the time and the memory of a tick, but never its results.
  std::function<std::unique_ptr<BroadPhase>(double finest_edge, int threads)> broad_phase;
  /// [m, world] Rooms with solid walls, and doors: bodies without a common room make no pair, see BodyRooms. Null:
  /// none.
  std::shared_ptr<const Building> building;
  double finest_edge = 0.0;  ///< [m] GridScale::finest_edge, 1e-6 .. 1e3; 0: computed from the sizes of the bodies
  double world_limit = 1e6;  ///< [m] poses with a larger coordinate on any axis are refused; at most 1e6
  double growth_cap = 1.0;   ///< [m] largest growth of the margins of a stale body, 0 .. 1e3
  /// [s] If the pose of a body is older than this, its margins grow in every state. If the period of its source is
  /// longer, they grow always.
  double growth_after = 0.25;
  std::size_t max_bodies = 100000;  ///< largest number of bodies in the scene
  std::size_t max_planes = 64;      ///< largest number of planes; a tick compares each with bodies that can move
  /// Maximum number of pairs that a snapshot lists; 0: no limit. It also bounds the work and the memory of a tick: the
  /// search collects at most 4 times as many pairs of boxes, or 65536 if that is more. Snapshot::truncated() tells
  /// whether a limit was reached.
  std::size_t max_pairs = 100000;
  std::size_t max_reasons = 8;  ///< maximum number of reasons that a snapshot lists
  int threads = 1;              ///< number of threads that the broad phase may use, 1 .. 64
  /// [s] Two bodies that can meet within this time, given their max_speed, are a pair too. So are two bodies that
  /// passed each other since the last commit. Range 0 .. 60; 0 switches both off.
  double horizon = 0.0;
  /// Margins of single pairs, 0 .. 1e3 [m], in place of `margin` and of the margins of their bodies.
  std::vector<PairMargin> pair_margins;
  /// If true, a query without a hit answers CLEAR only if a map in its scope knows the space to be free. If no map
  /// does, the query answers UNKNOWN.
  bool report_unmapped = false;
  /// Globs over names of required bodies. If no body matches one of them, the world is incomplete.
  std::vector<std::string> required;
  PairKinds pair_kinds;                 ///< which kinds of pair exist at all
  std::vector<PairRule> allowed_pairs;  ///< rules at the start; setRules() replaces them
};

/// The settings of a Scene that may change between two commits. SceneOptions says what they mean.
struct SceneTuning {
  double margin = SceneOptions{}.margin;                      ///< [m] SceneOptions::margin
  double event_hysteresis = SceneOptions{}.event_hysteresis;  ///< [m] SceneOptions::event_hysteresis
  double growth_cap = SceneOptions{}.growth_cap;              ///< [m] SceneOptions::growth_cap
  double horizon = SceneOptions{}.horizon;                    ///< [s] SceneOptions::horizon
};

/// Rules, and the pair filter that they make for the bodies of a structure. It takes long to make a filter of many
/// rules and bodies, so this can be done before a commit and on another thread.
struct PreparedRules {
  PairFilter filter;           ///< the filter, which contains the rules
  std::uint64_t revision = 0;  ///< Structure::revision of the bodies for which the filter was made
};

/// Bodies that will enter a scene, and the structure that the scene will then have: the result of Scene::prepare().
class PreparedBodies {
 public:
  PreparedBodies(PreparedBodies&&) noexcept;             ///< the moved-from object may only be destroyed or assigned to
  PreparedBodies& operator=(PreparedBodies&&) noexcept;  ///< the moved-from object may only be destroyed or assigned to
  ~PreparedBodies();

 private:
  friend class Scene;
  struct Data;
  PreparedBodies();
  std::unique_ptr<Data> data_;
};

/// Durations of the three parts of a commit.
struct TickTimes {
  std::chrono::nanoseconds boxes{0};  ///< time to compute the boxes of the bodies
  std::chrono::nanoseconds grid{0};   ///< time to update the grid and to find overlapping boxes in it
  std::chrono::nanoseconds pairs{0};  ///< time to select the pairs and to do everything else
};

/// Holds the bodies of the world and their poses, and makes snapshots of them.
///
/// A scene is the only writer of its snapshots. One thread at a time may call its functions, except prepare(), which
/// any thread may call at any time. Any thread may read the snapshots.
///
/// Usage in each tick: call add(), remove(), place() and setState() for everything that changed, then commit().
///
/// Wrong input throws Refusal. A call that throws changes nothing, even if memory ran out. After a commit() that threw,
/// the next commit() makes the same snapshot as if the failed call had never happened: no number is skipped, and no
/// pair and no event is lost.
class Scene {
 public:
  /// @throws Refusal out_of_range if an option is out of range; its sentence names the option
  explicit Scene(const SceneOptions& options);
  ~Scene();
  /// Takes over the content of another scene, which may then only be destroyed.
  Scene(Scene&&) noexcept;

  /// Adds a body. It is unplaced until place() is called.
  /// @throws Refusal dup_id or bad_id for the name
  /// @throws Refusal limit if there are too many bodies or planes
  /// @throws Refusal unsupported if a body with a plane is not a fixed obstacle
  /// @throws Refusal out_of_range or nonfinite for a pose, padding, margin or speed
  BodyId add(Body body);
  /// Removes a body. @throws Refusal unknown_id if the handle is not valid (any more)
  void remove(BodyId id);
  /// Removes the bodies `out` and adds the bodies `in`, or throws and does nothing. An added body may have the name of
  /// a removed one. Two fixed obstacles that differ only in their poses are the same body, so its handle stays valid.
  /// @returns the handles of the added bodies, in the order of `in`
  /// @throws Refusal unknown_id for a handle, dup_id if a handle occurs twice, or any Refusal of add()
  std::vector<BodyId> exchange(const std::vector<BodyId>& out, std::vector<Body> in);
  /// Prepares exchangePrepared(): makes the structure that the scene will then have. This takes long if there are many
  /// bodies. Any thread may call it, also while another thread uses the scene.
  /// @param newest  the newest snapshot of this scene. The new structure is used only if the scene still has the
  ///                structure of this snapshot in exchangePrepared().
  /// @param out     names of the bodies to be removed
  /// @param rules   the rules that setRules() will set after exchangePrepared(); nullopt: those of the snapshot stay.
  ///                If other rules are set, the next commit() makes the pair filter again.
  /// @throws Refusal as exchange(), for the bodies of the snapshot
  PreparedBodies prepare(const Snapshot& newest, const std::vector<std::string>& out, std::vector<Body> in,
                         const std::optional<std::vector<PairRule>>& rules = std::nullopt) const;
  /// As exchange(). Takes much less time if `in` was prepared for the same bodies `out`, and if no body, rule, margin,
  /// growth cap or horizon changed since the snapshot. Otherwise the result is the same, but the next commit() takes
  /// longer. What is not used stays in `in`, because it takes long to destroy it.
  std::vector<BodyId> exchangePrepared(const std::vector<BodyId>& out, PreparedBodies&& in);
  /// Sets `id` to the handle of the body with this name. @returns whether there is such a body
  bool find(const std::string& name, BodyId& id) const;
  /// Returns the description of a body.
  /// @throws Refusal unknown_id if the handle is not valid
  const Body& body(BodyId id) const;
  /// Returns the number of bodies.
  std::size_t size() const;

  /// Sets the pose of a body and the stamp of this pose. The first pose makes the body fresh. Later poses do not change
  /// its state.
  /// @throws Refusal unknown_id if the handle is not valid; nonfinite or out_of_range if the pose is not valid
  void place(BodyId id, const Pose& world_from_body, Time stamp);
  /// Throws what place() would throw for the same arguments, and changes nothing.
  void checkPlace(BodyId id, const Pose& world_from_body) const;
  /// Sets how far the pose of a body can be trusted. `age` is in seconds; `cohort` and `period` [s] are those of
  /// BodyPose. Does nothing for a body that has no pose. For a body that has a pose, `unplaced` counts as `invalid`.
  /// @throws Refusal unknown_id if the handle is not valid
  void setState(BodyId id, Freshness state, double age, std::uint32_t cohort = 0, double period = 0.0);
  /// Returns the last known pose of a body. @throws Refusal unknown_id if the handle is not valid
  const BodyPose& poseOf(BodyId id) const;

  /// Sets the occupied cells of a map or cloud. The next commit is the first to use the new cells. The structure does
  /// not change.
  /// @throws Refusal unknown_id if the handle is not valid
  /// @throws Refusal bad_geometry if the body cannot have cells or `cells` is null
  void setCells(BodyId id, std::shared_ptr<const MapCells> cells);

  /// Replaces all rules of the allowed collision matrix. The next commit is the first to use the new rules. If two
  /// equally exact rules match a pair, the later one decides.
  void setRules(std::vector<PairRule> rules);
  /// As above, with the rules of the filter in `prepared`. If bodies were added since, the next commit matches only
  /// their names with the rules.
  void setPreparedRules(PreparedRules prepared);
  /// Removes rules, from the next commit on. @param gone  for each rule in rules(): whether it is removed
  void removeRules(const std::vector<bool>& gone);
  /// Takes a result of PairFilter::match() for names of bodies that will be added. The next commit with a new structure
  /// uses it if the globs of the rules are unchanged. It saves time and changes no result. The results of the last 64
  /// calls are kept, or fewer if they have more than SceneOptions::max_bodies names.
  /// @param matches  of the filter of the newest snapshot, or of the one given to setPreparedRules()
  void prepareNames(NameMatches matches);
  /// Returns the rules that the next commit uses, in the order in which they were set.
  const std::vector<PairRule>& rules() const;

  /// Replaces settings, all of them or none. The next commit is the first to use them. It lists the pairs that a new
  /// scene with these settings and the same bodies would list. Pairs that stay listed are not interrupted.
  /// @throws Refusal out_of_range if a setting is out of range; its sentence names the setting
  void tune(const SceneTuning& tuning);

  /// Makes a snapshot of the present state of the scene.
  /// @param stamp  time of the tick
  /// @param gaps   what the sources lack, apart from problems of single bodies; each gap makes its source incomplete
  std::shared_ptr<const Snapshot> commit(Time stamp, const std::vector<SourceGap>& gaps);

  /// Begins a new epoch: ticks and events are numbered from 1 again, and NearPair::since of all pairs starts again.
  void beginEpoch(std::uint64_t epoch);

  /// Returns Structure::revision of the newest structure. The last commit() made it, or a later exchangePrepared()
  /// replaced it by a prepared one.
  std::uint64_t revision() const;
  /// Returns how long the last commit took.
  const TickTimes& lastTimes() const;
  /// Returns how many threads the last commit used. If the system could not create all of them, it is less than
  /// SceneOptions::threads.
  int lastThreads() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hgrid
