// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "control_measurement.h"

#include <hgrid_proximity/QuerySphere.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "bench/measure/median.h"
#include "processor_time.h"
#include "running_node.h"
#include "test/node/support/child_process.h"
#include "tf_publisher.h"

namespace hgrid {
namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTurns = 10;        // spans of time into which a comparison is divided
constexpr double kLonger = 15.0;  // a 99th percentile needs many round trips
constexpr int kStarts = 5;        // how often the programs are started that only receive /tf
constexpr int kTripTurns = 30;    // spans of time into which the round trips are divided
constexpr double kCache = 10.0;   // [s] how long the node keeps transforms; this is also the default

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

/// Returns the processor time per second of wall time since `before` [percent of one processor].
class Share {
 public:
  explicit Share(std::function<double()> processor_time)
      : processor_time_(std::move(processor_time)), before_(processor_time_()), begin_(Clock::now()) {}
  double percent() const {
    return 100.0 * (processor_time_() - before_) / std::chrono::duration<double>(Clock::now() - begin_).count();
  }

 private:
  std::function<double()> processor_time_;
  double before_;
  Clock::time_point begin_;
};

/// Returns a workload in which the node makes as few ticks as it can.
Workload withFewTicks(Workload workload) {
  workload.params["rate"] = 1.0;
  workload.params["heartbeat"] = 1.0;
  workload.params["valid_for"] = 3.0;
  workload.params["audit_rate"] = 0.0;
  workload.params["tf_cache"] = kCache;
  // Otherwise the margins of old poses grow, and a tick finds many more pairs.
  for (const char* limit : {"late_after", "stale_after", "lost_after"}) workload.params[limit] = 3600.0;
  return workload;
}

/// Measures the processor times of the node and of a control that ignores /tf. Both receive the same messages at the
/// same time.
Receiving receiving(const Workload& workload, double duration) {
  const Control control("ignore");
  const Workload calm = withFewTicks(workload);
  const RunningNode node(calm, duration);  // it also waits until the control has started
  sleepFor(kCache + 1.0);                  // from then on, a new transform takes the memory of one that is dropped
  std::vector<double> node_percent, control_percent;
  for (int turn = 0; turn < kTurns; ++turn) {
    const Share of_node([&] { return node.processorTime(); }), of_control([&] { return control.processorTime(); });
    sleepFor(duration / kTurns);
    node_percent.push_back(of_node.percent());
    control_percent.push_back(of_control.percent());
  }
  if (control.processorTime() == 0.0) throw std::runtime_error("a control does not run");
  return {medianOf(node_percent), medianOf(control_percent)};
}

/// A persistent connection to a service that answers QuerySphere.
class Caller {
 public:
  explicit Caller(const std::string& service) : service_(service) {
    ros::NodeHandle node;
    client_ = node.serviceClient<msg::QuerySphere>(service, true);
    if (!client_.waitForExistence(ros::Duration(20.0))) throw std::runtime_error(service + " is not offered");
    client_ = node.serviceClient<msg::QuerySphere>(service, true);
    question_.request.radius = 0.5;
  }
  /// Calls the service, and appends the time that it took [s].
  void call(std::vector<double>& seconds) {
    const auto begin = Clock::now();
    if (!client_.call(question_)) throw std::runtime_error(service_ + " did not answer");
    seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
  }

 private:
  std::string service_;
  ros::ServiceClient client_;
  msg::QuerySphere question_;
};

/// The round trips [s] of a service, per span of time.
using Trips = std::vector<std::vector<double>>;

/// Measures the round trips of services, 400 calls per second in total. Each round calls every service once, in random
/// order, so that /tf and other programs delay all services alike.
std::vector<Trips> roundTrips(const std::vector<std::string>& services, double duration) {
  std::vector<Caller> callers(services.begin(), services.end());
  std::vector<Trips> trips(services.size(), Trips(kTripTurns));
  std::vector<std::size_t> order(services.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937 random(1);
  auto due = Clock::now();
  for (std::size_t turn = 0; turn < kTripTurns; ++turn) {
    const auto end = Clock::now() +
                     std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(duration)) / kTripTurns;
    while (Clock::now() < end) {
      std::shuffle(order.begin(), order.end(), random);
      for (const std::size_t which : order) {
        due = std::max(due + std::chrono::microseconds(2500), Clock::now());
        std::this_thread::sleep_until(due);
        callers[which].call(trips[which][turn]);
      }
    }
  }
  return trips;
}

/// Returns the spread of the round trips in these spans of time.
Spread spreadOfTurns(const Trips& trips, const std::vector<std::size_t>& turns) {
  std::vector<double> all;
  for (const std::size_t turn : turns) all.insert(all.end(), trips[turn].begin(), trips[turn].end());
  return spreadOf(all);
}

ServiceTimes timesOf(const Trips& trips) {
  ServiceTimes times;
  for (const std::vector<double>& turn : trips) times.p99_of_turns.push_back(spreadOf(turn).p99);
  std::vector<std::size_t> turns(trips.size());
  std::iota(turns.begin(), turns.end(), std::size_t{0});
  times.all = spreadOfTurns(trips, turns);
  std::sort(times.p99_of_turns.begin(), times.p99_of_turns.end());
  return times;
}

/// Compares two services whose calls alternated. The interval comes from 1000 random samples of the spans of time,
/// drawn with replacement (bootstrap; Efron 1979).
Difference differenceOf(const Trips& trips, const Trips& others) {
  constexpr std::size_t kSelections = 1000;
  std::mt19937 random(1);
  std::vector<std::size_t> turns(trips.size());
  std::iota(turns.begin(), turns.end(), std::size_t{0});
  const auto difference = [&] { return spreadOfTurns(trips, turns).p99 - spreadOfTurns(others, turns).p99; };
  const double all = difference();
  std::vector<double> differences;
  for (std::size_t i = 0; i < kSelections; ++i) {
    for (std::size_t& turn : turns) turn = random() % trips.size();
    differences.push_back(difference());
  }
  std::sort(differences.begin(), differences.end());
  return {all, differences[kSelections / 40], differences[kSelections - 1 - kSelections / 40]};
}

}  // namespace

ControlMeasurement measureControls(const Workload& workload, double duration) {
  ControlMeasurement result;
  result.title = workload.title;
  Workload moving = workload;
  const std::vector<tf2_msgs::TFMessage> cycle = moving.move(0.0);
  for (const tf2_msgs::TFMessage& message : cycle) result.transforms += message.transforms.size();
  result.relay = relayLatency(workload, duration, cycle.size());
  Workload nearly_idle = workload;
  nearly_idle.rate = 1.0;
  result.idle = receiving(nearly_idle, duration);
  // Programs that are started again get other places in memory and on the processors, which changes their times.
  std::vector<Receiving> starts;
  for (int start = 0; start < kStarts; ++start) starts.push_back(receiving(workload, duration));
  std::sort(starts.begin(), starts.end(),
            [&](const Receiving& a, const Receiving& b) { return result.timesOf(a) < result.timesOf(b); });
  result.receiving = starts[starts.size() / 2];
  for (const Receiving& start : starts) result.times.push_back(result.timesOf(start));
  // All services are measured while the node makes ticks.
  const Control control("service"), beside_tf("service_and_tf");
  const RunningNode node(workload, kLonger * duration);
  std::vector<std::string> services{control.name(), beside_tf.name(), node.name()};
  for (std::string& service : services) service += "/query_sphere";
  const std::vector<Trips> trips = roundTrips(services, kLonger * duration);
  result.empty_service = timesOf(trips[0]);
  result.empty_service_beside_tf = timesOf(trips[1]);
  result.sphere = timesOf(trips[2]);
  result.above_empty = differenceOf(trips[2], trips[0]);
  result.above_empty_beside_tf = differenceOf(trips[2], trips[1]);
  return result;
}

}  // namespace bench
}  // namespace hgrid
