// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "node/params/params.h"
#include "node/sources/robot_source.h"

namespace hgrid {

/// Notices that the description of a robot on the parameter server has changed.
///
/// A separate thread reads the descriptions about once per second, because the ROS master may take long to answer. The
/// thread spends at most 1/50 of its time on reading. A missing description does not count as a change, because all
/// descriptions are missing after a restart of the master.
class DescriptionWatch {
 public:
  /// Starts the thread, unless ~watch_descriptions is false. All parameters must outlive this object.
  DescriptionWatch(const RobotSource& source, const Params& params);
  ~DescriptionWatch();
  DescriptionWatch(const DescriptionWatch&) = delete;
  DescriptionWatch& operator=(const DescriptionWatch&) = delete;

  /// Call this before a robot is loaded from a description. From then on, a different description is a change.
  void noteRead(const RobotParams& robot, const RobotDescription& description);
  /// Returns the robots whose newest description differs from that of the last noteRead(). Never waits for the ROS
  /// master.
  std::vector<const RobotParams*> changed() const;

 private:
  void run();
  void look(const RobotParams& robot);

  const RobotSource& source_;
  const Params& params_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // mutex_ guards the members from here to ends_. The two maps contain for each robot (by name) a hash of a
  // description: read_ of that of the last noteRead(), seen_ of the newest one that the thread has read.
  std::map<std::string, std::size_t> read_, seen_;
  std::uint64_t reads_ = 0;  // number of calls of noteRead()
  bool ends_ = false;
  std::thread thread_;  // declared last, because it uses the members above
};

}  // namespace hgrid
