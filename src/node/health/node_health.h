// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// What /diagnostics reports of ~state_folder.
struct StateReport {
  std::string folder;                   ///< empty: nothing is stored
  std::string failure;                  ///< why changes are not stored; empty: they are
  std::size_t obstacles = 0;            ///< number of obstacles that this run of the node restored
  std::size_t rules = 0;                ///< number of rules that it restored
  std::vector<std::string> unreadable;  ///< what could not be restored
};

/// Data that /diagnostics reports in addition to the newest tick.
struct HealthReport {
  std::map<std::string, std::string> failed_loads;  ///< by robot: why its description could not be loaded
  std::size_t late_ticks_in_a_row = 0;
  std::uint64_t failed_ticks = 0;           ///< number of failed ticks since the start of the node
  std::optional<Refusal> failed_tick;       ///< why the last tick failed; nullopt if it did not
  std::optional<Refusal> failed_distances;  ///< why the last measurement of distances failed; nullopt if it did not
  std::optional<Refusal> failed_structure;  ///< why ~bodies and ~rules could not be published; nullopt if they were
  std::uint64_t longest_wait = 0;           ///< [ticks] see PairDistances::longest_wait
  std::map<std::string, std::string> missing_threads;  ///< by parameter: how many of its threads could not be created
  std::vector<std::string> conflicts;                  ///< frames that are published on both /tf and /tf_static
  std::uint64_t audits = 0;                            ///< number of audited ticks since the start of the node
  std::uint64_t different_audits = 0;                  ///< number of audits that found a difference
  std::string audit_difference;                        ///< what the newest of these found; empty: nothing
  StateReport state;
};

/// Collects data for /diagnostics from all parts of the node. Any thread may use it.
class NodeHealth {
 public:
  /// Call this for every tick. @param fault  why the tick failed; nullopt if it did not fail
  void noteTick(const std::optional<Refusal>& fault);
  /// Call this for every tick. @param late  true if the tick began more than one period too late
  void noteLateness(bool late);
  /// Call this after each tick whose distances were measured. @param fault  why that failed; nullopt if it did not fail
  void noteDistances(const std::optional<Refusal>& fault);
  /// Call this after each attempt to publish ~bodies and ~rules.
  /// @param fault  why it failed; nullopt if it did not fail
  void noteStructure(const std::optional<Refusal>& fault);
  /// @param ticks  the largest number of successive ticks in which the distance of a pair was not measured
  void noteLongestWait(std::uint64_t ticks);
  /// @param frames  all frames that are published on both /tf and /tf_static. A frame is never removed from this list.
  void noteConflicts(const std::vector<std::string>& frames);
  /// Call this after each audit. @param difference  what it found; empty: nothing
  void noteAudit(const std::string& difference);
  void noteState(const StateReport& state);
  /// Notes why a robot could not be loaded. @returns whether the sentence differs from the last one for this robot
  bool noteFailedLoad(const std::string& robot, const std::string& sentence);
  void noteLoaded(const std::string& robot);
  /// Notes how many threads work, and logs it if the system could not create all of them.
  /// @param parameter   name of the parameter that says how many there should be
  /// @param configured  its value
  void noteThreads(const std::string& parameter, int configured, int created);

  HealthReport report() const;

 private:
  mutable std::mutex mutex_;
  HealthReport report_;  // guarded by mutex_
};

}  // namespace hgrid
