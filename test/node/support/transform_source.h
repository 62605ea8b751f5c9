// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/node_handle.h>
#include <tf2_msgs/TFMessage.h>

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "ticker.h"

namespace hgrid {
namespace test {

/// A transform without rotation, or turned about z by `yaw` [rad].
geometry_msgs::Transform at(double x, double y = 0.0, double z = 0.0, double yaw = 0.0);

geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child,
                                        const geometry_msgs::Transform& transform, ros::Time stamp = ros::Time());

/// The clock on the wall, whatever /use_sim_time says.
ros::Time wallTime();

/// Publishes transforms: as a robot would, at 50 Hz, and single ones as no robot should. Any thread.
class TransformSource {
 public:
  explicit TransformSource(std::function<ros::Time()> now = wallTime);

  ros::Time now() const { return now_(); }
  /// Publishes on /tf at once, as one message; waits first until somebody listens.
  void send(const std::vector<geometry_msgs::TransformStamped>& transforms);
  /// Publishes on /tf_static, together with what was fixed before.
  void fix(const std::vector<geometry_msgs::TransformStamped>& transforms);
  /// From now on at 50 Hz, stamped `delay` [s] before now; again with other values: from now on those.
  void stream(const std::string& parent, const std::string& child, const geometry_msgs::Transform& transform,
              double delay = 0.0);
  void stop(const std::string& child);
  /// Nothing is streamed while the deed is done.
  void pauseFor(const std::function<void()>& deed);
  /// @throws std::runtime_error if fewer than `count` subscribers come
  void waitForListeners(std::size_t count = 1);
  /// How many transforms send() has published.
  std::uint64_t sent() const { return sent_; }

 private:
  struct Streamed {
    geometry_msgs::TransformStamped transform;
    double delay = 0.0;
  };
  void publishStreams();

  std::function<ros::Time()> now_;
  std::uint64_t sent_ = 0;
  std::mutex mutex_;
  std::map<std::string, Streamed> streams_;
  tf2_msgs::TFMessage fixed_;
  ros::NodeHandle node_;
  ros::Publisher moving_, static_;
  Ticker ticker_;
};

}  // namespace test
}  // namespace hgrid
