// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_list.h"

#include <algorithm>
#include <map>
#include <utility>

namespace hgrid {

/// Takes entries out of the list and returns them. The calling thread must have locked mutex_.
template <class Predicate>
std::list<PathList::Entry> PathList::takeIf(const Predicate& predicate) {
  std::list<Entry> taken;
  for (auto it = newest_first_.begin(); it != newest_first_.end();) {
    const auto next = std::next(it);
    if (predicate(*it)) taken.splice(taken.end(), newest_first_, it);
    it = next;
  }
  count_ = newest_first_.size();
  return taken;
}

/// Removes entries. Frees their memory after the mutex is unlocked. @returns whether there was one
template <class Predicate>
bool PathList::removeIf(const Predicate& predicate) {
  std::list<Entry> removed;
  const std::lock_guard<std::mutex> lock(mutex_);
  removed = takeIf(predicate);
  return !removed.empty();
}

std::shared_ptr<const RobotPath> PathList::put(const std::string& source, RobotPath path, const Tick& tick) {
  const std::string robot = path.robot;
  const auto stored = std::make_shared<const RobotPath>(std::move(path));
  std::list<Entry> added{{source, stored, tick.epoch, tick.snapshot ? tick.snapshot->sequence() : 0}};
  std::list<Entry> replaced;
  // One lock for both steps: otherwise a check between them would find no path of the robot.
  const std::lock_guard<std::mutex> lock(mutex_);
  replaced = takeIf([&](const Entry& entry) { return entry.source == source && entry.path->robot == robot; });
  newest_first_.splice(newest_first_.begin(), added);
  count_ = newest_first_.size();
  return stored;
}

void PathList::remove(const std::string& source, const std::string& robot) {
  removeIf([&](const Entry& entry) { return entry.source == source && entry.path->robot == robot; });
}

bool PathList::removeAll(const std::string& robot) {
  return removeIf([&](const Entry& entry) { return entry.path->robot == robot; });
}

std::list<PathList::Entry> PathList::entries() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_first_;
}

bool PathList::has(const std::shared_ptr<const RobotPath>& path) const {
  const std::list<Entry> all = entries();
  return std::any_of(all.begin(), all.end(), [&](const Entry& entry) { return entry.path == path; });
}

std::shared_ptr<const RobotPath> PathList::of(const std::string& robot) const {
  RobotPaths paths;
  for (const Entry& entry : entries()) {
    if (entry.path->robot == robot) paths.push_back(entry.path);
  }
  return paths.empty() ? nullptr : mergePaths(paths);
}

RobotPaths PathList::current(const Tick& tick, const std::function<bool(const RobotPath&)>& arrived) {
  std::map<std::string, RobotPaths> of_robots;
  RobotPaths ended;
  for (const Entry& entry : entries()) {
    const RobotPath& path = *entry.path;
    const auto robot = tick.robots->find(path.robot);
    const bool in_world = robot != tick.robots->end() && robot->second.inWorld();
    // An older tick may lack the robot because it came later.
    const bool is_older = entry.epoch == tick.epoch && tick.snapshot && tick.snapshot->sequence() < entry.sequence;
    const bool is_over = path.unread.empty() && path.times.back() < tick.made.ros && arrived(path);
    if ((!in_world && !is_older) || is_over) {
      ended.push_back(entry.path);
    } else {
      of_robots[path.robot].push_back(entry.path);
    }
  }
  if (!ended.empty()) {
    removeIf([&](const Entry& entry) { return std::count(ended.begin(), ended.end(), entry.path) > 0; });
  }
  RobotPaths paths;
  for (const auto& robot : of_robots) paths.push_back(mergePaths(robot.second));
  return paths;
}

}  // namespace hgrid
