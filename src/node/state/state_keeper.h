// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "node/health/commons.h"
#include "node/state/state_edit.h"
#include "node/state/state_folder.h"
#include "node/state/waiting_changes.h"
#include "node/world/robot_models.h"
#include "node/world/stored_world.h"

namespace hgrid {

class ObstacleBodies;
class World;
struct Tick;

/// Stores in ~state_folder what services and messages change, so that the next run of the node begins with it.
///
/// After each tick, see() collects what the tick changed. A thread of this object writes it to disk. If that fails, the
/// thread tries again every second, and /diagnostics says why it failed. Without ~state_folder, this object does
/// nothing.
class StateKeeper {
 public:
  /// Reads the folder. If it cannot be used, nothing is stored, and restored() says why.
  /// @param commons  must outlive this object
  explicit StateKeeper(Commons& commons);
  ~StateKeeper();

  /// Returns what an earlier run stored. If some of it could not be read, its troubles say so.
  const StoredWorld& restored() const { return restored_; }

  /// Collects the changes of the world in a tick. Only the tick thread may call this, after every tick.
  void see(World& world, const Tick& tick);
  /// Notes that a map was loaded from a file or removed. An empty name means all maps. Any thread may call this.
  /// @param map  nullopt: the map was removed
  void noteMap(const std::string& name, const std::optional<MapParams>& map);
  /// Waits until everything that was collected is on disk. Any thread except the tick thread may call this.
  /// @returns false if nothing is stored, if the disk refuses it, or after 5 s
  bool waitUntilStored();

 private:
  using Edits = std::vector<StateEdit>;
  using Changes = std::vector<WaitingChange>;

  void open();
  Changes changesOf(const ObstacleBodies& obstacles) const;
  void collectRobots(const RobotModels& robots, Changes& changes) const;
  void add(Changes changes);
  void run();
  Edits newEdits(const WaitingChanges& changes) const;
  void write(WaitingChanges& changes, bool anew);
  void tell(const std::string& failure);

  Commons& commons_;
  StoredWorld restored_;
  std::unique_ptr<StateFolder> folder_;  // null: nothing is stored
  std::set<std::string> configured_;     // full names of the obstacles of ~obstacles
  StateItems items_;                     // what the newest file holds, or must hold; only run() uses it

  // Only the tick thread uses these.
  std::uint64_t seen_structure_ = 0;        // revision of the structure whose rules were compared
  std::vector<PairRule> seen_rules_;        // the rules of ~set_allowed that were collected last
  std::optional<RobotModels> seen_robots_;  // the robots that were collected last

  std::mutex mutex_;
  std::condition_variable changed_;
  WaitingChanges waiting_;      // guarded by mutex_
  std::uint64_t added_ = 0;     // guarded by mutex_: number of calls of add()
  std::uint64_t stored_ = 0;    // guarded by mutex_: how many of them are on disk
  std::uint64_t failures_ = 0;  // guarded by mutex_: number of failed attempts to write
  bool behind_ = false;         // guarded by mutex_: whether the last see() failed
  bool ending_ = false;         // guarded by mutex_
  std::thread thread_;
};

}  // namespace hgrid
