// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tf_publisher.h"

#include <hgrid_proximity/Poses.h>

#include <chrono>

namespace hgrid {
namespace bench {
namespace {

ros::Publisher advertise(ros::NodeHandle& ros, const Workload& workload, const std::string& node) {
  return workload.by_poses ? ros.advertise<::hgrid_proximity::Poses>(node + "/poses", 10)
                           : ros.advertise<tf2_msgs::TFMessage>("/tf", 1000);
}

}  // namespace

TfPublisher::TfPublisher(const Workload& workload, double period, const std::string& node)
    : workload_(workload), period_(period), publisher_(advertise(node_, workload, node)), thread_([this] { run(); }) {}

TfPublisher::~TfPublisher() {
  stopping_ = true;
  thread_.join();
}

void TfPublisher::run() {
  using Clock = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_));
  auto due = Clock::now();
  double named = -1.0;  // [s] when the names were sent
  for (double t = 0.0; !stopping_; t += period_) {
    std::vector<tf2_msgs::TFMessage> messages = workload_.move(t);  // not part of the latency
    std::this_thread::sleep_until(due);
    const auto now = Clock::now();
    if (now - due > period / 2) {
      ++late_;
      due = now;
    }
    due += period;
    const ros::Time stamp = ros::Time::now();
    for (tf2_msgs::TFMessage& message : messages) {
      for (geometry_msgs::TransformStamped& transform : message.transforms) transform.header.stamp = stamp;
      if (workload_.by_poses) {
        publish(message, t >= named + 1.0);
        if (t >= named + 1.0) named = t;
      } else {
        publisher_.publish(message);
      }
    }
  }
}

/// Publishes a cycle as a message of ~poses. @param named  whether the message contains the names
void TfPublisher::publish(const tf2_msgs::TFMessage& cycle, bool named) {
  ::hgrid_proximity::Poses poses;
  poses.header = cycle.transforms.front().header;
  poses.names_version = 1;
  for (const geometry_msgs::TransformStamped& transform : cycle.transforms) {
    if (named) poses.names.push_back(transform.child_frame_id);
    poses.position.emplace_back();
    poses.position.back().x = transform.transform.translation.x;
    poses.position.back().y = transform.transform.translation.y;
    poses.position.back().z = transform.transform.translation.z;
    poses.orientation.push_back(transform.transform.rotation);
  }
  publisher_.publish(poses);
}

}  // namespace bench
}  // namespace hgrid
