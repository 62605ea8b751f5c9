// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "control_measurement.h"

#include <hgrid_proximity/QuerySphere.h>
#include <ros/ros.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "processor_time.h"
#include "running_node.h"
#include "test/node/support/child_process.h"
#include "tf_publisher.h"

namespace hgrid {
namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTurns = 10;  // of the two services whose round trips are compared

void sleepFor(double duration) { std::this_thread::sleep_for(std::chrono::duration<double>(duration)); }

/// Runs a control in its own process.
class Control {
 public:
  explicit Control(const std::string& mode) : name_("/control_" + mode) {
    const char* folder = std::getenv("ROS_LOG_DIR");
    process_ = std::make_unique<test::ChildProcess>(
        std::vector<std::string>{HGRID_CONTROL, mode, "__name:=control_" + mode},
        std::string(folder == nullptr ? "/tmp" : folder) + name_ + ".log", std::map<std::string, std::string>{});
  }
  const std::string& name() const { return name_; }
  double processorTime() const { return bench::processorTime(process_->pid()); }

 private:
  std::string name_;
  std::unique_ptr<test::ChildProcess> process_;
};

void waitForSubscriber(const TfPublisher& publisher) {
  for (double waited = 0.0; !publisher.heard(); waited += 0.1) {
    if (waited > 20.0) throw std::runtime_error("a control does not subscribe to /tf");
    sleepFor(0.1);
  }
  sleepFor(1.0);
}

/// Measures how long the last message of each cycle takes through a node that relays it.
Spread relayLatency(const Workload& workload, double duration, std::size_t messages) {
  const Control control("relay");
  std::mutex mutex;
  std::vector<double> seconds;  // guarded by mutex
  ros::Time cycle;
  std::size_t seen = 0;
  bool noting = false;
  const boost::function<void(const ros::MessageEvent<const tf2_msgs::TFMessage>&)> note =
      [&](const ros::MessageEvent<const tf2_msgs::TFMessage>& event) {
        const std::lock_guard<std::mutex> lock(mutex);
        const ros::Time stamp = event.getConstMessage()->transforms.front().header.stamp;
        seen = stamp == cycle ? seen + 1 : 1;
        cycle = stamp;
        if (noting && seen == messages) seconds.push_back((event.getReceiptTime() - stamp).toSec());
      };
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<tf2_msgs::TFMessage>(
      control.name() + "/tf", 1000, note, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  const TfPublisher publisher(workload, 1.0 / workload.rate);
  waitForSubscriber(publisher);
  {
    const std::lock_guard<std::mutex> lock(mutex);
    noting = true;
  }
  sleepFor(duration);
  const std::lock_guard<std::mutex> lock(mutex);
  return spreadOf(seconds);
}

/// Returns the processor time of a control that ignores /tf [percent of one processor].
double ignorePercent(const Workload& workload, double duration) {
  const Control control("ignore");
  const TfPublisher publisher(workload, 1.0 / workload.rate);
  waitForSubscriber(publisher);
  const auto begin = Clock::now();
  const double before = control.processorTime();
  sleepFor(duration);
  return 100.0 * (control.processorTime() - before) / std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Returns the processor time of the node while it makes as few ticks as it can [percent of one processor].
double receivePercent(Workload workload, double duration) {
  workload.params["rate"] = 1.0;
  workload.params["heartbeat"] = 1.0;
  workload.params["valid_for"] = 1.0;
  workload.params["audit_rate"] = 0.0;
  RunningNode node(workload, duration);
  Sightings seen;
  node.watch(seen);
  sleepFor(duration);
  node.rest();
  return 100.0 * seen.node_time / seen.duration;
}

/// Measures the round trips [s] of a service, 200 per second, over a persistent connection.
void appendRoundTrips(const std::string& service, double duration, std::vector<double>& seconds) {
  ros::NodeHandle node;
  ros::ServiceClient client = node.serviceClient<msg::QuerySphere>(service, true);
  if (!client.waitForExistence(ros::Duration(20.0))) throw std::runtime_error(service + " is not offered");
  client = node.serviceClient<msg::QuerySphere>(service, true);
  msg::QuerySphere question;
  question.request.radius = 0.5;
  auto due = Clock::now();
  const auto end = due + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(duration));
  for (; due < end; due += std::chrono::milliseconds(5)) {
    std::this_thread::sleep_until(due);
    const auto begin = Clock::now();
    if (!client.call(question)) throw std::runtime_error(service + " did not answer");
    seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
  }
}

}  // namespace

ControlMeasurement measureControls(const Workload& workload, double duration) {
  ControlMeasurement result;
  result.title = workload.title;
  Workload moving = workload;
  const std::vector<tf2_msgs::TFMessage> cycle = moving.move(0.0);
  for (const tf2_msgs::TFMessage& message : cycle) result.transforms += message.transforms.size();
  result.relay = relayLatency(workload, duration, cycle.size());
  result.ignore_percent = ignorePercent(workload, duration);
  result.receive_percent = receivePercent(workload, duration);
  // Both services are measured in turns while the node makes ticks. So other programs delay both equally.
  const Control control("service");
  const RunningNode node(workload, duration);
  std::vector<double> empty, sphere;
  for (int turn = 0; turn < kTurns; ++turn) {
    appendRoundTrips(control.name() + "/query_sphere", duration / kTurns, empty);
    appendRoundTrips(node.name() + "/query_sphere", duration / kTurns, sphere);
  }
  result.empty_service = spreadOf(empty);
  result.sphere = spreadOf(sphere);
  return result;
}

}  // namespace bench
}  // namespace hgrid
