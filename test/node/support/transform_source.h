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

/// Returns a transform with this translation [m] and a rotation about z by `yaw` [rad].
geometry_msgs::Transform at(double x, double y = 0.0, double z = 0.0, double yaw = 0.0);

geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child,
                                        const geometry_msgs::Transform& transform, ros::Time stamp = ros::Time());

/// Returns the time of the system clock, even if /use_sim_time is true.
ros::Time wallTime();

/// Publishes transforms: streams at 50 Hz like those of a robot, and single messages, which may be faulty. All
/// functions may be called from any thread.
class TransformSource {
 public:
  explicit TransformSource(std::function<ros::Time()> now = wallTime);

  ros::Time now() const { return now_(); }
  /// Publishes the transforms on /tf as one message. Waits for a subscriber first.
  void send(const std::vector<geometry_msgs::TransformStamped>& transforms);
  /// Publishes the transforms on /tf_static, together with the transforms of all earlier calls of fix().
  void fix(const std::vector<geometry_msgs::TransformStamped>& transforms);
  /// Publishes a transform on /tf at 50 Hz from now on. Its stamp is `delay` [s] before the current time. Another call
  /// for the same child replaces the transform.
  void stream(const std::string& parent, const std::string& child, const geometry_msgs::Transform& transform,
              double delay = 0.0);
  /// Stops the stream of the transform of `child`.
  void stop(const std::string& child);
  /// Returns the stamp of the newest streamed transforms without a delay. Only while the streams pause.
  ros::Time newestStamp() const { return newest_; }
  /// Runs the function. All streams pause while it runs.
  void pauseFor(const std::function<void()>& function);
  /// Waits until /tf and /tf_static have at least `count` subscribers each. @throws std::runtime_error after 20 s
  void waitForListeners(std::size_t count = 1);
  /// Returns the number of transforms that send() has published.
  std::uint64_t sent() const { return sent_; }

 private:
  struct Streamed {
    geometry_msgs::TransformStamped transform;
    double delay = 0.0;
  };
  void publishStreams();

  std::function<ros::Time()> now_;
  std::uint64_t sent_ = 0;
  ros::Time newest_;
  std::mutex mutex_;
  std::map<std::string, Streamed> streams_;
  tf2_msgs::TFMessage fixed_;
  ros::NodeHandle node_;
  ros::Publisher moving_, static_;
  Ticker ticker_;
};

}  // namespace test
}  // namespace hgrid
