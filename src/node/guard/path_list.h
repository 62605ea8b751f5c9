// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "node/guard/robot_path.h"
#include "node/tick/tick.h"

namespace hgrid {

/// The paths that robots follow. A robot may follow several paths, one from each source. Any thread may use it.
class PathList {
 public:
  /// Adds a path. It replaces the one that the robot had from the same source.
  /// @param source  name of a topic; empty: the service ~guard
  /// @param tick    a tick with the robot
  /// @returns the stored path
  std::shared_ptr<const RobotPath> put(const std::string& source, RobotPath path, const Tick& tick);
  /// Removes the path of a robot from one source, if there is one.
  void remove(const std::string& source, const std::string& robot);
  /// Removes all paths of a robot. @returns whether there was one
  bool removeAll(const std::string& robot);
  /// Returns whether the list has this path.
  bool has(const std::shared_ptr<const RobotPath>& path) const;
  /// Returns all paths of a robot as one; null: it has none.
  std::shared_ptr<const RobotPath> of(const std::string& robot) const;
  /// Returns whether there is no path. Waits for no other thread.
  bool empty() const { return count_ == 0; }

  /// Removes the paths that ended before a tick and at whose end the robot has arrived, and those of robots that have
  /// left the world since their path was added.
  /// @param arrived  returns whether a robot is at the end of its path
  /// @returns one path for each robot that has any (see mergePaths()), sorted by name of the robot
  RobotPaths current(const Tick& tick, const std::function<bool(const RobotPath&)>& arrived);

 private:
  struct Entry {
    std::string source;
    std::shared_ptr<const RobotPath> path;
    std::uint64_t epoch = 0, sequence = 0;  // of the tick with which the path was added
  };
  template <class Predicate>
  std::list<Entry> takeIf(const Predicate& predicate);
  template <class Predicate>
  bool removeIf(const Predicate& predicate);
  std::list<Entry> entries() const;

  mutable std::mutex mutex_;
  std::list<Entry> newest_first_;  // guarded by mutex_
  std::atomic<std::size_t> count_{0};
};

}  // namespace hgrid
