// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "measurement.h"

#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/Pairs.h>
#include <hgrid_proximity/Status.h>
#include <ros/param.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "test/node/support/child_process.h"
#include "tf_publisher.h"

namespace hgrid {
namespace bench {
namespace {

namespace msg = ::hgrid_proximity;

constexpr double kWarmUp = 11.0;  // [s] until tf's cache of 10 s is full: a fuller one is a slower one

/// What the table shows of the node's timings, and under which name.
const std::vector<std::pair<const char*, const char*>> kParts = {
    {"tick", "tick"},        {"poses", "tick.poses"},     {"boxes", "tick.boxes"},         {"broad phase", "tick.grid"},
    {"pairs", "tick.pairs"}, {"publish", "tick.publish"}, {"distances", "tick.distances"}, {"tf", "tf"},
};

/// Notes what the node says. Callbacks run on one other thread.
class Listener {
 public:
  explicit Listener(const std::string& space, bool distances) {
    if (distances) distances_ = node_.subscribe<msg::Distances>(space + "/distances", 10, ignore);
    pairs_ =
        node_.subscribe<msg::Pairs>(space + "/pairs", 1000,
                                    boost::function<void(const ros::MessageEvent<msg::Pairs const>&)>(
                                        [this](const ros::MessageEvent<msg::Pairs const>& event) { onPairs(event); }),
                                    ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
    status_ = node_.subscribe<msg::Status>(space + "/status", 1000, &Listener::onStatus, this);
  }

  void begin() {
    const std::lock_guard<std::mutex> lock(mutex_);
    seconds_.clear();
    latencies_.clear();
    pair_count_ = messages_ = 0;
  }
  /// Whether the whole world is known and the node has ticked on.
  bool serves(std::size_t bodies) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return newest_ && newest_->world.complete && newest_->body_count == bodies;
  }
  std::string troubles() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!newest_) return "it never said anything";
    std::string text = std::to_string(newest_->body_count) + " bodies";
    for (const std::string& reason : newest_->world.reasons) text += "; " + reason;
    return text;
  }
  void report(Measurement& measurement) const;

 private:
  static void ignore(const msg::Distances::ConstPtr&) {}
  void onPairs(const ros::MessageEvent<msg::Pairs const>& event) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const msg::Pairs& pairs = *event.getConstMessage();
    pair_count_ += pairs.total;
    ++messages_;
    if (pairs.header.stamp == last_stamp_) return;
    last_stamp_ = pairs.header.stamp;
    latencies_.push_back((event.getReceiptTime() - last_stamp_).toSec());
  }
  void onStatus(const msg::Status::ConstPtr& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = status;
    for (const msg::Timing& timing : status->timings) seconds_[timing.name].push_back(timing.last);
  }

  mutable std::mutex mutex_;
  msg::Status::ConstPtr newest_;
  std::map<std::string, std::vector<double>> seconds_;
  std::vector<double> latencies_;
  std::size_t pair_count_ = 0, messages_ = 0;
  ros::Time last_stamp_;
  ros::NodeHandle node_;
  ros::Subscriber pairs_, status_, distances_;
};

Spread spreadOf(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {1e3 * values[values.size() / 2], 1e3 * values[values.size() * 99 / 100]};
}

void Listener::report(Measurement& measurement) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& part : kParts) {
    const auto found = seconds_.find(part.second);
    if (found != seconds_.end()) measurement.parts.push_back({part.first, spreadOf(found->second)});
  }
  measurement.parts.push_back({"latency", spreadOf(latencies_)});
  measurement.ticks = messages_;
  if (messages_ > 0) measurement.pairs = static_cast<double>(pair_count_) / static_cast<double>(messages_);
}

/// [s] of processor that a process has used.
double processorTime(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 1));  // the name before may hold anything
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

void sleepFor(double duration) { std::this_thread::sleep_for(std::chrono::duration<double>(duration)); }

}  // namespace

Measurement measure(const Workload& workload, double duration) {
  static int count = 0;
  const std::string space = "/bench_" + std::to_string(++count), node = space + "/proximity";
  for (const auto& robot : workload.descriptions) ros::param::set(space + "/" + robot.first, robot.second);
  ros::param::set(node, workload.params);

  const double tick = 1.0 / workload.rate;
  Listener listener(node, workload.distances);
  TfPublisher publisher(workload, tick * (1.0 + tick / duration));
  const char* folder = std::getenv("ROS_LOG_DIR");
  test::ChildProcess process({HGRID_NODE, "__ns:=" + space, "__name:=proximity"},
                             std::string(folder == nullptr ? "/tmp" : folder) + space + ".log", {});
  for (double waited = 0.0; !listener.serves(workload.bodies); waited += 0.1) {
    if (waited > 60.0 || !process.alive()) throw std::runtime_error("the node does not serve: " + listener.troubles());
    sleepFor(0.1);
  }
  sleepFor(kWarmUp);

  Measurement measurement;
  measurement.title = workload.title;
  measurement.bodies = workload.bodies;
  measurement.rate = workload.rate;
  measurement.distances = workload.distances;
  const std::size_t late_before = publisher.lateCycles();
  listener.begin();
  const double before = processorTime(process.pid());
  const auto begin = std::chrono::steady_clock::now();
  sleepFor(duration);
  const double used = processorTime(process.pid()) - before;
  const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  listener.report(measurement);
  measurement.cpu_percent = 100.0 * used / took;
  measurement.late_cycles = publisher.lateCycles() - late_before;
  return measurement;
}

}  // namespace bench
}  // namespace hgrid
