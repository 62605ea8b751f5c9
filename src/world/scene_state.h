// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/world/scene.h"
#include "pairs/pair_choice.h"
#include "pairs/pair_limits.h"
#include "pairs/pair_tracker.h"
#include "world/horizon.h"
#include "world/map_pairs.h"
#include "world/pair_events.h"
#include "world/plane_pairs.h"
#include "world/prepared_bodies.h"
#include "world/recent_changes.h"
#include "world/scene_structure.h"
#include "world/snapshot_pool.h"

namespace hgrid {

/// Returns a building whose walls and openings are relative to `origin`; null if there are no rooms.
/// @param world  [m, world] may be null
std::shared_ptr<const Building> buildingFrom(const std::shared_ptr<const Building>& world,
                                             const Eigen::Vector3d& origin);

/// The data of a Scene: the bodies, and the data that commits keep from tick to tick.
struct Scene::State {
  /// The part of a body that every tick reads and writes. The rest of the body is in State::bodies, so that a tick
  /// accesses little memory. A slot is used again after its body was removed.
  struct Slot {
    bool used = false;
    bool fixed = false;
    bool moved = false;            // whether the body moved since the last commit: its boxes must be computed again
    std::uint32_t generation = 0;  // how many bodies used this slot before
    std::uint64_t changed = 0;     // number of the first commit with the present `pose`
    BodyPose pose;
  };
  /// What a grown box was computed from.
  struct GrownFrom {
    Aabb box;          // the box before it was grown
    double by = -1.0;  // [m] how much it was grown; negative: nothing was computed yet
  };

  explicit State(const SceneOptions& scene_options)
      : options(scene_options),
        first_options(scene_options),
        limits(PairLimits::of(scene_options.max_pairs)),
        building(buildingFrom(scene_options.building, scene_options.origin)),
        horizon(scene_options.horizon, scene_options.growth_cap),
        tracker(limits.remembered),
        pair_events(scene_options.event_hysteresis, limits.remembered) {}

  // scene.cpp: adds and removes bodies.

  /// Returns the slot of a body. @throws Refusal unknown_id if the handle is not valid
  Slot& at(BodyId id);
  void noteChange(std::uint32_t slot);

  SceneOptions options;
  const SceneOptions first_options;  // those of the constructor; they never change, so any thread may read them
  PairLimits limits;
  const std::shared_ptr<const Building> building;  // relative to options.origin; null: there are no rooms
  std::vector<Slot> slots;
  std::vector<std::shared_ptr<const Body>> bodies;     // the body in each slot; null: the slot is not used
  std::vector<std::shared_ptr<const MapCells>> cells;  // the cells of the body in each slot; null: it has no cells
  std::size_t plane_count = 0;                         // number of planes of all bodies
  std::vector<std::uint32_t> free_slots;               // indices of the unused slots; has capacity for all slots
  std::size_t body_count = 0;                          // number of bodies in the scene
  std::map<std::string, std::uint32_t> entered;        // slots of the bodies that `structure` lacks, by name
  std::vector<std::uint32_t> left;              // bodies of `structure` that left or were replaced; one may occur twice
  bool options_changed = true;                  // whether tune() changed an option since `structure` was made
  bool bodies_changed = true;                   // whether exchange() was called since, even if all that came left again
  bool rules_changed = true;                    // whether options.allowed_pairs differ from the rules of `structure`
  std::optional<PreparedRules> prepared_rules;  // has the same rules as options.allowed_pairs
  std::vector<NameMatches> name_matches;        // see Scene::prepareNames(); the oldest come first
  std::uint64_t sequence = 0, epoch = 0, commits = 0;

  bool isThere(BodyId id) const {
    return id.slot < slots.size() && slots[id.slot].used && slots[id.slot].generation == id.generation;
  }
  /// Returns whether the next commit must make a new structure.
  bool isOutdated() const { return options_changed || rules_changed || bodies_changed; }
  std::uint32_t slotOf(const std::string& name) const;
  std::uint32_t indexOf(std::uint32_t slot) const;
  std::vector<std::uint32_t> checkedSlots(const std::vector<BodyId>& out);
  std::vector<std::uint32_t> slotsFor(const std::vector<std::uint32_t>& leaving, std::size_t count) const;
  std::size_t reserveSlots(const std::vector<std::uint32_t>& numbers);
  void takeOut(std::uint32_t slot);
  BodyId putIn(std::uint32_t slot, std::shared_ptr<const Body> body);
  std::vector<BodyId> exchange(const std::vector<BodyId>& out, EnteringBodies in);

  // prepared_bodies.cpp: applies prepared changes.

  bool isUpToDate(const PreparedBodies::Data& prepared, const std::vector<BodyId>& out) const;
  std::vector<BodyId> exchange(PreparedBodies::Data& prepared);

  // commit.cpp: Scene::commit() makes a snapshot. Its last step is accept(), which cannot fail. The steps before it do
  // not overwrite results of the last commit. They write to separate members, or they write what the next commit would
  // write as well. So a commit that throws has no effect on the next commit.

  void accept(const std::shared_ptr<PooledSnapshot>& accepted);
  std::shared_ptr<PooledSnapshot> freshSnapshot() const;
  void makeBoxes(std::size_t body, const Pose& world_from_body, Snapshot& snapshot) const;
  void fillBodies(Snapshot& snapshot);
  void fillAllBodies(Snapshot& snapshot);
  void fillChangedBodies(Snapshot& snapshot);
  void keepBoxes(Snapshot& snapshot) const;
  void fillPose(std::uint32_t body, Snapshot& snapshot) const;
  bool fillBoxes(std::uint32_t body, Snapshot& snapshot);
  void summarizePoses(Snapshot& snapshot);
  const std::vector<std::uint32_t>& changedBodies();
  void fillPairs(Snapshot& snapshot);
  void addPair(std::uint32_t first, std::uint32_t second, double gap, double margin, bool near);
  bool isCandidate(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second);

  // new_structure.cpp: makes a new structure after bodies, rules or margins changed.

  void renewStructure();
  BodyChange changeOfBodies() const;
  PairFilter filterFor(const BodyList& next, const std::vector<std::uint32_t>& known) const;
  void setStructure(std::shared_ptr<const SceneStructure> next, std::vector<std::uint32_t> places,
                    std::vector<bool> watched);

  // grown_boxes.cpp: grows the boxes by their margins and stores them in the broad phase.

  void growBoxes(const Snapshot& snapshot);
  void growBox(const Snapshot& snapshot, ProxyId proxy, std::size_t position);
  void fillGrid(PooledSnapshot& pooled);
  bool moveInGrid(BroadPhase& grid);

  // find_rooms.cpp: finds the rooms of the bodies.

  void findRooms(Snapshot& snapshot);
  void listRooms(const Snapshot& snapshot, std::uint32_t body);
  bool isRegrown(const Snapshot& snapshot, std::uint32_t body) const;

  // completeness.cpp: decides which sources are complete.

  void fillCompleteness(Snapshot& snapshot, const std::vector<SourceGap>& gaps) const;
  void fillDoubtful(Snapshot& snapshot) const;

  std::shared_ptr<const SceneStructure> structure = std::make_shared<SceneStructure>();
  // For each slot that existed when `structure` was set: the index in `structure` of the body that was there, or kNone.
  std::vector<std::uint32_t> body_of_slot;
  std::shared_ptr<const Snapshot> last;  // snapshot of the last commit; null before the first one
  Horizon horizon;
  MapPairs map_pairs;
  PlanePairs plane_pairs;
  PairTracker tracker;
  PairEvents pair_events;
  RecentChanges changes;
  std::vector<bool> is_watched;  // for each body of the structure: whether the last commit watched it
  TickTimes times;
  int threads = 1;
  std::shared_ptr<SnapshotPool> pool = std::make_shared<SnapshotPool>();

  // Buffers of a commit. They are members so that the next commit need not allocate them again.
  std::vector<std::uint32_t> boxed;  // slots whose boxes were computed in this commit
  std::uint64_t since = 0;           // the commit that the snapshot object held before; 0: all bodies are filled
  std::size_t unplaced = 0;          // number of bodies without a pose
  // The grown boxes of an earlier commit stay valid for bodies that did not change since, if the structure is that of
  // `grown_revision` and the number of unplaced bodies is `grown_unplaced`.
  std::vector<ProxyId> ids;                // proxies of placed bodies; the next three arrays are in the same order
  std::vector<Aabb> grown_boxes;           // the boxes that the grid stores
  std::vector<GrownFrom> grown_from;       // for each grown box: what it was computed from
  std::vector<std::uint64_t> grown_in;     // for each grown box: the commit that computed it
  std::vector<std::uint32_t> position_of;  // for each proxy of a placed body: its position in these arrays
  std::uint64_t grown_revision = 0;
  std::size_t grown_unplaced = 0;
  // The rooms of an earlier commit, which may have failed after it found them. They stay valid like the grown boxes.
  std::shared_ptr<const BodyRooms> rooms;
  std::uint64_t rooms_revision = 0;
  std::size_t rooms_unplaced = 0;
  std::vector<std::uint32_t> body_rooms, box_rooms;  // see listRooms()
  std::vector<ProxyId> regrown;                      // proxies whose grown boxes differ from those in the grid
  std::vector<Aabb> regrown_boxes;                   // these boxes, in the same order
  std::vector<std::uint32_t> changed_bodies;         // see changedBodies()
  std::vector<ProxyPair> proxy_pairs;
  PairChoice choice;
};

}  // namespace hgrid
