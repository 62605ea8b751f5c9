// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/health/node_health.h"

#include <ros/console.h>

namespace hgrid {

void NodeHealth::noteTick(const std::optional<Refusal>& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.failed_tick = fault;
  if (fault) ++report_.failed_ticks;
}

void NodeHealth::noteLateness(bool late) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.late_ticks_in_a_row = late ? report_.late_ticks_in_a_row + 1 : 0;
}

void NodeHealth::noteDistances(const std::optional<Refusal>& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.failed_distances = fault;
}

void NodeHealth::noteStructure(const std::optional<Refusal>& fault) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.failed_structure = fault;
}

void NodeHealth::noteLongestWait(std::uint64_t ticks) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.longest_wait = ticks;
}

void NodeHealth::noteConflicts(const std::vector<std::string>& frames) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (frames.size() != report_.conflicts.size()) report_.conflicts = frames;
}

void NodeHealth::noteAudit(const std::string& difference) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++report_.audits;
  if (difference.empty()) return;
  ++report_.different_audits;
  report_.audit_difference = difference;
}

void NodeHealth::noteState(const StateReport& state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.state = state;
}

bool NodeHealth::noteFailedLoad(const std::string& robot, const std::string& sentence) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string& known = report_.failed_loads[robot];
  if (known == sentence) return false;
  known = sentence;
  return true;
}

void NodeHealth::noteLoaded(const std::string& robot) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.failed_loads.erase(robot);
}

void NodeHealth::noteThreads(const std::string& parameter, int configured, int created) {
  std::string sentence;
  if (created < configured) {
    sentence = "the system could create only " + std::to_string(created) + " of the " + std::to_string(configured) +
               " threads of " + parameter +
               "; results are the same but may come later: allow more threads or memory, or reduce " + parameter;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (sentence.empty()) {
      report_.missing_threads.erase(parameter);
      return;
    }
    std::string& known = report_.missing_threads[parameter];
    if (known == sentence) return;
    known = sentence;
  }
  ROS_WARN("%s", sentence.c_str());  // without the mutex, because ticks need it
}

HealthReport NodeHealth::report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

}  // namespace hgrid
