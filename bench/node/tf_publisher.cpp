// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "tf_publisher.h"

#include <chrono>

namespace hgrid {
namespace bench {

TfPublisher::TfPublisher(const Workload& workload, double period)
    : workload_(workload),
      period_(period),
      publisher_(node_.advertise<tf2_msgs::TFMessage>("/tf", 1000)),
      thread_([this] { run(); }) {}

TfPublisher::~TfPublisher() {
  stopping_ = true;
  thread_.join();
}

void TfPublisher::run() {
  using Clock = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_));
  auto due = Clock::now();
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
      publisher_.publish(message);
    }
  }
}

}  // namespace bench
}  // namespace hgrid
