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

/// What /diagnostics reports besides the newest tick.
struct HealthReport {
  std::map<std::string, std::string> failed_loads;  ///< sentence by robot: its description could not be loaded
  std::size_t late_ticks_in_a_row = 0;
  std::uint64_t failed_ticks = 0;      ///< since the node was started
  std::optional<Refusal> failed_tick;  ///< why the last tick failed; nullopt if it did not
  std::vector<std::string> conflicts;  ///< frames that come on /tf and on /tf_static
};

/// Collects what the parts of the node note for /diagnostics. Any thread.
class NodeHealth {
 public:
  /// Call this for every tick. @param fault  why it failed; nullopt if it did not
  void noteTick(const std::optional<Refusal>& fault);
  /// Call this for every tick. @param late  it began more than a period too late
  void noteLateness(bool late);
  /// @param frames  all frames that come on /tf and on /tf_static. A frame in this list is never removed from it.
  void noteConflicts(const std::vector<std::string>& frames);
  /// @returns whether this sentence is another than the last one of this robot
  bool noteFailedLoad(const std::string& robot, const std::string& sentence);
  void noteLoaded(const std::string& robot);

  HealthReport report() const;

 private:
  mutable std::mutex mutex_;
  HealthReport report_;  // guarded by mutex_
};

}  // namespace hgrid
