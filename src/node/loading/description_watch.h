// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "node/params/params.h"
#include "node/robots/robot_source.h"

namespace hgrid {

/// Notices that the description of a robot on the parameter server has changed.
///
/// A separate thread reads the descriptions about once per second, because the ROS master may take long to answer. The
/// thread spends at most 1/50 of its time on reading. It reads a description that several robots share only once. A
/// missing description does not count as a change, because all descriptions are missing after a restart of the master.
class DescriptionWatch {
 public:
  using Robots = std::vector<std::shared_ptr<const RobotSpec>>;

  /// Starts the thread, unless ~watch_descriptions is false. All parameters must outlive this object.
  DescriptionWatch(const RobotSource& source, const Params& params);
  ~DescriptionWatch();
  DescriptionWatch(const DescriptionWatch&) = delete;
  DescriptionWatch& operator=(const DescriptionWatch&) = delete;

  /// Replaces the list of robots to watch. Robots whose description came with a request never change.
  void setRobots(Robots robots);
  /// Call this before a robot is loaded from a description. From then on, a different description is a change.
  /// @param hash  RobotDescription::hash()
  void noteRead(const std::string& robot, std::uint64_t hash);
  /// Call this if a robot was added that is equal to another one, so that both change at the same time.
  void noteLike(const std::string& robot, const std::string& other);
  /// Returns the robots whose newest description differs from that of the last noteRead(). Never waits for the ROS
  /// master.
  Robots changed() const;

 private:
  void run();
  void look(const RobotSpec& robot);

  const RobotSource& source_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // mutex_ guards the members from here to ends_.
  Robots robots_;                              // those to watch
  Robots distinct_;                            // one of them for each description
  std::map<std::string, std::uint64_t> read_;  // by robot: hash of the description of the last noteRead()
  std::map<std::string, std::uint64_t> seen_;  // by the names of its parameters: hash of the description as last read
  std::uint64_t reads_ = 0;                    // number of calls that changed the members above
  bool ends_ = false;
  std::thread thread_;  // declared last, because it uses the members above
};

}  // namespace hgrid
