// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "node/guard/action_goals.h"
#include "node/guard/robot_path.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Where the path of a robot comes from.
struct PathSource {
  std::string topic;                   ///< name of a topic; empty: the service ~guard
  std::string goal;                    ///< name of a goal of an action (see ActionGoals); empty: it is none
  std::string command_of;              ///< name of the controller that this command topic belongs to; empty: none
  std::vector<std::string> action_of;  ///< names of the controllers that this action may belong to
  bool is_plan = false;                ///< whether it shows what may be commanded later, and does not move the robot

  PathSource(std::string topic_name = {}) : topic(std::move(topic_name)) {}
};

/// The paths that robots follow. A robot may follow several paths, from one source or from several. Any thread may use
/// it.
///
/// A path replaces those of the joints that it names, and of no others. There are three exceptions:
/// - A request of the service and a plan also replace the one before them.
/// - A plan says nothing about joints that a command moves.
/// - The path of a goal replaces nothing before the server has accepted the goal. Until then it hides older paths.
class PathList {
 public:
  /// Adds a path.
  /// @param tick  a tick with the robot
  /// @returns the stored path
  std::shared_ptr<const RobotPath> put(const PathSource& source, RobotPath path, const Tick& tick,
                                       GoalPhase phase = GoalPhase::followed);
  /// Removes the paths of a robot from one topic. The other paths of its controller may end, too.
  void stop(const PathSource& source, const std::string& robot);
  /// Removes all paths of a robot. @returns whether there was one
  bool removeAll(const std::string& robot);
  /// Returns the path of a goal before its server has accepted it; null: there is none.
  std::shared_ptr<const RobotPath> waiting(const PathSource& source, const std::string& robot) const;
  /// Replaces a path in the list, if the list still has it.
  void replace(const std::shared_ptr<const RobotPath>& path, RobotPath by);
  /// Takes the news of a goal.
  /// @param tick  a tick with the robot
  void note(const PathSource& source, const std::string& robot, GoalPhase phase, const Tick& tick);
  /// Returns whether the list has this path.
  bool has(const std::shared_ptr<const RobotPath>& path) const;
  /// Returns all paths of a robot as one; null: it has none.
  std::shared_ptr<const RobotPath> of(const std::string& robot) const;
  /// Returns whether there is no path. Waits for no other thread.
  bool empty() const { return count_ == 0; }

  /// Removes paths that ended, and those of robots that have left the world since their path was added. A path ends
  /// - when it is over and the robot is at its end,
  /// - if its goal was canceled or aborted: when it is over, or when the robot has left it,
  /// - if nothing was heard of its goal: when it is over.
  /// @param is_on  returns whether a robot is where its path says; nullopt: nobody knows
  /// @returns one path for each robot that has any (see mergePaths()), sorted by name of the robot
  RobotPaths current(const Tick& tick, const std::function<std::optional<bool>(const RobotPath&)>& is_on);

 private:
  struct Entry {
    PathSource source;
    std::shared_ptr<const RobotPath> path;
    std::uint64_t epoch = 0, sequence = 0;  // of the tick with which the path was added
    GoalPhase phase = GoalPhase::followed;
    std::string doubt() const;
    bool isReplacedBy(const PathSource& newer) const;
    bool isGoal(const PathSource& goal, const std::string& robot) const;
  };
  using Entries = std::list<Entry>;
  template <class Predicate>
  Entries takeIf(const Predicate& predicate);
  template <class Predicate>
  bool removeIf(const Predicate& predicate);
  void takeJoints(Entries::iterator newer, Entries& taken);
  void doubt(Entries::iterator first, const PathSource& source, const std::string& robot);
  Entries entries() const;
  static std::shared_ptr<const RobotPath> merged(const std::vector<const Entry*>& newest_first);

  mutable std::mutex mutex_;
  Entries newest_first_;  // guarded by mutex_
  std::atomic<std::size_t> count_{0};
};

}  // namespace hgrid
