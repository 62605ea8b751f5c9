// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "transform_source.h"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace hgrid {
namespace test {

geometry_msgs::Transform at(double x, double y, double z, double yaw) {
  geometry_msgs::Transform transform;
  transform.translation.x = x;
  transform.translation.y = y;
  transform.translation.z = z;
  transform.rotation.z = std::sin(0.5 * yaw);
  transform.rotation.w = std::cos(0.5 * yaw);
  return transform;
}

geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child,
                                        const geometry_msgs::Transform& transform, ros::Time stamp) {
  geometry_msgs::TransformStamped result;
  result.header.frame_id = parent;
  result.header.stamp = stamp;
  result.child_frame_id = child;
  result.transform = transform;
  return result;
}

ros::Time wallTime() { return ros::Time().fromNSec(ros::WallTime::now().toNSec()); }

TransformSource::TransformSource(std::function<ros::Time()> now)
    : now_(std::move(now)),
      moving_(node_.advertise<tf2_msgs::TFMessage>("/tf", 1000)),
      static_(node_.advertise<tf2_msgs::TFMessage>("/tf_static", 1000, true)),
      ticker_(std::chrono::milliseconds(20), [this] { publishStreams(); }) {}

void TransformSource::waitForListeners(std::size_t count) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (moving_.getNumSubscribers() < count || static_.getNumSubscribers() < count) {
    if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("too few subscribers of /tf within 20 s");
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // polling, because a new connection sends no message
  }
}

void TransformSource::send(const std::vector<geometry_msgs::TransformStamped>& transforms) {
  waitForListeners();
  tf2_msgs::TFMessage message;
  message.transforms = transforms;
  sent_ += transforms.size();
  moving_.publish(message);
}

void TransformSource::fix(const std::vector<geometry_msgs::TransformStamped>& transforms) {
  const std::lock_guard<std::mutex> lock(mutex_);
  fixed_.transforms.insert(fixed_.transforms.end(), transforms.begin(), transforms.end());
  static_.publish(fixed_);
}

void TransformSource::stream(const std::string& parent, const std::string& child,
                             const geometry_msgs::Transform& transform, double delay) {
  const std::lock_guard<std::mutex> lock(mutex_);
  streams_[child] = {stamped(parent, child, transform), delay};
}

void TransformSource::stop(const std::string& child) {
  const std::lock_guard<std::mutex> lock(mutex_);
  streams_.erase(child);
}

void TransformSource::pauseFor(const std::function<void()>& function) {
  const std::lock_guard<std::mutex> lock(mutex_);
  function();
}

void TransformSource::publishStreams() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (streams_.empty()) return;
  const ros::Time now = now_();
  tf2_msgs::TFMessage message;
  for (const auto& named : streams_) {
    message.transforms.push_back(named.second.transform);
    message.transforms.back().header.stamp = now - ros::Duration(named.second.delay);
  }
  moving_.publish(message);
  newest_ = now;
}

}  // namespace test
}  // namespace hgrid
