// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_list.h"

#include <algorithm>
#include <map>
#include <utility>

namespace hgrid {
namespace {

/// Returns whether the server has not accepted a goal so far.
bool waits(GoalPhase phase) { return phase == GoalPhase::sent || phase == GoalPhase::waiting; }

/// Returns whether a controller may have both the topic for commands and the action.
bool belongTogether(const PathSource& command, const PathSource& action) {
  return !command.command_of.empty() &&
         std::count(action.action_of.begin(), action.action_of.end(), command.command_of) > 0;
}

bool shareController(const PathSource& a, const PathSource& b) {
  return a.topic == b.topic || belongTogether(a, b) || belongTogether(b, a);
}

}  // namespace

/// Returns why the robot may not follow the path; empty: it does.
std::string PathList::Entry::doubt() const {
  if (phase == GoalPhase::followed || (!path->doubt.empty() && phase != GoalPhase::unseen)) return path->doubt;
  const std::string goal = source.goal.empty() ? "a path" : "the goal '" + printable(source.goal, 100) + "'";
  const std::string what = goal + " of robot '" + path->robot + "' on " + source.topic;
  if (phase == GoalPhase::unseen) return "nobody knows the path of " + what + ", because this node did not receive it";
  if (phase == GoalPhase::ending) {
    return what + " was canceled, aborted or replaced; nobody knows whether the robot stops or goes on";
  }
  return what + " is not accepted yet; nobody knows whether the robot will follow it";
}

/// Returns whether a newer path replaces this one as a whole.
bool PathList::Entry::isReplacedBy(const PathSource& newer) const {
  if (source.topic != newer.topic) return false;
  if (!newer.goal.empty() && newer.goal == source.goal) return true;
  return newer.topic.empty() || newer.is_plan;
}

bool PathList::Entry::isGoal(const PathSource& goal, const std::string& robot) const {
  return !goal.goal.empty() && source.topic == goal.topic && source.goal == goal.goal && path->robot == robot;
}

/// Takes entries out of the list and returns them. The calling thread must have locked mutex_.
template <class Predicate>
PathList::Entries PathList::takeIf(const Predicate& predicate) {
  Entries taken;
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
  Entries removed;
  const std::lock_guard<std::mutex> lock(mutex_);
  removed = takeIf(predicate);
  return !removed.empty();
}

/// Takes the joints of a path away from older ones. Takes older paths of its topic that could not be read. The calling
/// thread must have locked mutex_.
/// @param taken  receives the entries that have no joint left
void PathList::takeJoints(Entries::iterator newer, Entries& taken) {
  const RobotPath& path = *newer->path;
  for (auto it = std::next(newer); it != newest_first_.end();) {
    const auto older = it++;
    if (older->path->robot != path.robot || older->phase == GoalPhase::waiting) continue;
    RobotPath rest = withoutJoints(*older->path, path.joints);
    const bool is_unread = older->path->points() == 0 && older->source.topic == newer->source.topic;
    if (rest.joints.size() == older->path->joints.size() && !is_unread) continue;
    if (rest.joints.empty()) {
      taken.splice(taken.end(), newest_first_, older);
    } else {
      older->path = std::make_shared<const RobotPath>(std::move(rest));
    }
  }
  count_ = newest_first_.size();
}

std::shared_ptr<const RobotPath> PathList::put(const PathSource& source, RobotPath path, const Tick& tick,
                                               GoalPhase phase) {
  const std::string robot = path.robot;
  Entries replaced;
  // One lock for all steps: otherwise a check between them would find no path of the robot.
  const std::lock_guard<std::mutex> lock(mutex_);
  replaced = takeIf([&](const Entry& entry) { return entry.path->robot == robot && entry.isReplacedBy(source); });
  for (const Entry& entry : newest_first_) {
    if (!source.is_plan || entry.source.is_plan || entry.path->robot != robot) continue;
    path = withoutJoints(path, entry.path->joints);
  }
  const auto stored = std::make_shared<const RobotPath>(std::move(path));
  newest_first_.push_front({source, stored, tick.epoch, tick.snapshot ? tick.snapshot->sequence() : 0, phase});
  if (!waits(phase)) takeJoints(newest_first_.begin(), replaced);
  if (stored->joints.empty() && stored->doubt.empty()) newest_first_.pop_front();  // commands move all of its joints
  count_ = newest_first_.size();
  return stored;
}

void PathList::stop(const PathSource& source, const std::string& robot) {
  Entries removed;
  const std::lock_guard<std::mutex> lock(mutex_);
  removed =
      takeIf([&](const Entry& entry) { return entry.path->robot == robot && entry.source.topic == source.topic; });
  doubt(newest_first_.begin(), source, robot);
}

/// Marks older paths of a controller that stops all of its joints. The calling thread must have locked mutex_.
void PathList::doubt(Entries::iterator first, const PathSource& source, const std::string& robot) {
  for (auto it = first; it != newest_first_.end(); ++it) {
    const bool stops = it->path->robot == robot && shareController(it->source, source);
    if (stops && it->phase == GoalPhase::followed && it->path->doubt.empty()) it->phase = GoalPhase::ending;
  }
}

bool PathList::removeAll(const std::string& robot) {
  return removeIf([&](const Entry& entry) { return entry.path->robot == robot; });
}

std::shared_ptr<const RobotPath> PathList::waiting(const PathSource& source, const std::string& robot) const {
  for (const Entry& entry : entries()) {
    if (entry.isGoal(source, robot) && waits(entry.phase)) return entry.path;
  }
  return nullptr;
}

void PathList::replace(const std::shared_ptr<const RobotPath>& path, RobotPath by) {
  auto stored = std::make_shared<const RobotPath>(std::move(by));  // in the end: what it has replaced
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Entry& entry : newest_first_) {
    if (entry.path == path) return entry.path.swap(stored);
  }
}

void PathList::note(const PathSource& source, const std::string& robot, GoalPhase phase, const Tick& tick) {
  Entries removed;
  std::unique_lock<std::mutex> lock(mutex_);
  const auto found = std::find_if(newest_first_.begin(), newest_first_.end(),
                                  [&](const Entry& entry) { return entry.isGoal(source, robot); });
  if (found == newest_first_.end()) {
    if (phase != GoalPhase::unseen) return;
    lock.unlock();
    RobotPath unseen;
    unseen.robot = robot;
    unseen.doubt = "unseen";
    put(source, std::move(unseen), tick, phase);
    return;
  }
  const auto newer = [&](const auto& act) {
    for (auto it = newest_first_.begin(); it != found; ++it) {
      if (it->path->robot == robot && !waits(it->phase)) act(*it);
    }
  };
  switch (phase) {
    case GoalPhase::sent:
    case GoalPhase::waiting:
    case GoalPhase::unseen:
      found->phase = phase;
      return;
    case GoalPhase::followed:
      found->phase = phase;
      // The server may have accepted the goal before the newer path came, or after that.
      newer([&](const Entry& entry) {
        if (withoutJoints(*found->path, entry.path->joints).joints != found->path->joints)
          found->phase = GoalPhase::ending;
      });
      if (found->phase == phase) takeJoints(found, removed);
      return;
    case GoalPhase::ending: {
      found->phase = phase;
      if (found->path->points() == 0) return;
      RobotPath rest = *found->path;
      newer([&](const Entry& entry) { rest = withoutJoints(rest, entry.path->joints); });
      if (rest.joints.empty()) break;
      auto stored = std::make_shared<const RobotPath>(std::move(rest));
      found->path.swap(stored);
      return;
    }
    case GoalPhase::stopped:
      doubt(std::next(found), source, robot);
      break;
    case GoalPhase::over:
    case GoalPhase::refused:
      break;
  }
  removed.splice(removed.end(), newest_first_, found);
  count_ = newest_first_.size();
}

PathList::Entries PathList::entries() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_first_;
}

bool PathList::has(const std::shared_ptr<const RobotPath>& path) const {
  const Entries all = entries();
  return std::any_of(all.begin(), all.end(), [&](const Entry& entry) { return entry.path == path; });
}

/// Returns the paths of a robot as one, with the doubt about any of them.
std::shared_ptr<const RobotPath> PathList::merged(const std::vector<const Entry*>& newest_first) {
  RobotPaths paths;
  std::string doubt;
  for (const Entry* entry : newest_first) {
    paths.push_back(entry->path);
    if (doubt.empty()) doubt = entry->doubt();
  }
  auto path = mergePaths(paths);
  if (path->doubt == doubt) return path;
  RobotPath doubted = *path;
  doubted.doubt = doubt;
  return std::make_shared<const RobotPath>(std::move(doubted));
}

std::shared_ptr<const RobotPath> PathList::of(const std::string& robot) const {
  const Entries all = entries();
  std::vector<const Entry*> own;
  for (const Entry& entry : all) {
    if (entry.path->robot == robot) own.push_back(&entry);
  }
  return own.empty() ? nullptr : merged(own);
}

RobotPaths PathList::current(const Tick& tick, const std::function<std::optional<bool>(const RobotPath&)>& is_on) {
  const Entries all = entries();
  std::map<std::string, std::vector<const Entry*>> of_robots;
  RobotPaths ended;
  for (const Entry& entry : all) {
    const RobotPath& path = *entry.path;
    const auto robot = tick.robots->find(path.robot);
    const bool in_world = robot != tick.robots->end() && robot->second.inWorld();
    // An older tick may lack the robot because it came later.
    const bool is_older = entry.epoch == tick.epoch && tick.snapshot && tick.snapshot->sequence() < entry.sequence;
    bool is_over = path.doubt.empty() && path.times.back() < tick.made.ros;
    if (entry.phase == GoalPhase::followed) is_over = is_over && is_on(path) == true;
    if (entry.phase == GoalPhase::waiting) is_over = false;
    if (entry.phase == GoalPhase::ending && path.doubt.empty()) is_over = is_over || is_on(path) == false;
    if ((!in_world && !is_older) || is_over) {
      ended.push_back(entry.path);
    } else {
      of_robots[path.robot].push_back(&entry);
    }
  }
  if (!ended.empty()) {
    removeIf([&](const Entry& entry) { return std::count(ended.begin(), ended.end(), entry.path) > 0; });
  }
  RobotPaths paths;
  for (const auto& robot : of_robots) paths.push_back(merged(robot.second));
  return paths;
}

}  // namespace hgrid
