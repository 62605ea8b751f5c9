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
/// It looks about once per second on a thread of its own, because the ROS master may take long to answer. The thread
/// spends at most 1/50 of its time on that. A description that is absent is not a change, because that is also so after
/// a restart of the master.
class DescriptionWatch {
 public:
  /// Starts to look, unless ~watch_descriptions is false. All parameters must outlive this object.
  DescriptionWatch(const RobotSource& source, const Params& params);
  ~DescriptionWatch();
  DescriptionWatch(const DescriptionWatch&) = delete;
  DescriptionWatch& operator=(const DescriptionWatch&) = delete;

  /// Notes that this description of a robot was read. From now on, another description is a change.
  void noteRead(const RobotParams& robot, const RobotDescription& description);
  /// Returns the robots whose newest description is not the one that was read last. Never waits for the ROS master.
  std::vector<const RobotParams*> changed() const;

 private:
  void run();
  void look(const RobotParams& robot);

  const RobotSource& source_;
  const Params& params_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  // The members below are guarded by mutex_. The maps hold a hash of each description, by robot.
  std::map<std::string, std::size_t> read_, seen_;
  std::uint64_t reads_ = 0;  // number of calls of noteRead()
  bool ends_ = false;
  std::thread thread_;  // declared last, because it uses the members above
};

}  // namespace hgrid
