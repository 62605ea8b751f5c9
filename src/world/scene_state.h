// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/world/scene.h"
#include "pairs/pair_choice.h"
#include "pairs/pair_limits.h"
#include "pairs/pair_tracker.h"
#include "world/horizon.h"
#include "world/map_pairs.h"
#include "world/pair_events.h"
#include "world/snapshot_pool.h"

namespace hgrid {

/// What a Scene holds: the bodies as they were told, and what making a snapshot of them keeps from tick to tick.
struct Scene::State {
  /// What a tick reads and writes of a body; the rest stands apart in `bodies`, so that a tick runs through little
  /// memory.
  struct Slot {
    bool used = false;
    bool fixed = false;
    bool moved = false;  // since the last commit; its boxes are not those of its pose
    std::uint32_t generation = 0;
    std::uint64_t changed = 0;  // number of the first commit that has its pose as it is
    BodyPose pose;
  };
  struct ShapeInBody {
    Shape shape;
    Pose body_from_shape;
    double padding;
  };

  /// What a grown box was made of.
  struct GrownFrom {
    Aabb box;
    double by = -1.0;  // [m]
  };

  explicit State(const SceneOptions& scene_options)
      : options(scene_options),
        limits(PairLimits::of(scene_options.max_pairs)),
        horizon(scene_options.horizon, scene_options.growth_cap),
        tracker(limits.remembered),
        pair_events(scene_options.event_hysteresis, limits.remembered) {}

  // scene.cpp: the bodies as they were told.

  /// @throws Refusal unknown_id
  Slot& at(BodyId id);

  SceneOptions options;
  PairLimits limits;
  std::vector<Slot> slots;
  std::vector<Body> bodies;                            // by slot
  std::vector<std::shared_ptr<const MapCells>> cells;  // by slot; of maps, else null
  std::vector<std::uint32_t> free_slots;               // has room for all slots
  std::map<std::string, std::uint32_t> slot_of_name;   // ordered: the structure is sorted by name
  bool structure_changed = true;
  std::uint64_t sequence = 0, epoch = 0, commits = 0;

  std::vector<std::uint32_t> checkedSlots(const std::vector<BodyId>& out);
  void checkIn(const std::vector<std::uint32_t>& leaving, const std::vector<Body>& in) const;
  std::vector<std::uint32_t> slotsFor(const std::vector<BodyId>& out, std::size_t count) const;
  void reserveSlots(std::size_t count);
  void takeOut(std::uint32_t slot);
  void putIn(std::uint32_t slot, Body&& body);

  // commit.cpp: the making of a snapshot. Until accept(), which cannot fail, each step either writes what it would
  // write again, or writes beside what the last commit left. So a commit that throws leaves no trace in the next one.

  void rebuildStructure();
  void accept(const std::shared_ptr<PooledSnapshot>& accepted);
  std::shared_ptr<PooledSnapshot> freshSnapshot() const;
  void makeBoxes(std::size_t body, const Pose& world_from_body, Snapshot& snapshot) const;
  void fillBodies(Snapshot& snapshot);
  void growBoxes(const Snapshot& snapshot);
  void fillGrid(PooledSnapshot& pooled);
  void fillPairs(Snapshot& snapshot);
  void addPair(std::uint32_t first, std::uint32_t second, double gap, double margin, bool near);
  bool isCandidate(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second);

  // completeness.cpp: which sources are complete.

  void fillSources(Structure& structure) const;
  void fillCompleteness(Snapshot& snapshot, const std::vector<SourceGap>& gaps) const;
  void fillDoubtful(Snapshot& snapshot) const;

  std::shared_ptr<const Structure> structure = std::make_shared<Structure>();
  std::vector<std::uint32_t> uncovered;  // bodies of the structure that leave a gap wherever they are
  std::vector<ShapeInBody> shapes;       // by proxy of the structure
  std::shared_ptr<const Snapshot> last;  // of the last commit; null before the first one
  GridScale scale;
  std::vector<ProxyId> fixed_proxies;
  Horizon horizon;
  MapPairs map_pairs;
  PairTracker tracker;
  PairEvents pair_events;
  TickTimes times;
  std::shared_ptr<SnapshotPool> pool = std::make_shared<SnapshotPool>();

  // Scratch of a tick, kept to save allocations.
  std::vector<std::uint32_t> boxed;   // slots whose boxes were made in this commit
  std::vector<ProxyId> ids;           // placed proxies; the next two arrays are in their order
  std::vector<Aabb> grown_boxes;      // what the grid stores
  std::vector<GrownFrom> grown_from;  // what these were made of
  std::vector<ProxyPair> proxy_pairs;
  PairChoice choice;
};

}  // namespace hgrid
