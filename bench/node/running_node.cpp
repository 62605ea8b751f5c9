// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "running_node.h"

#include <ros/param.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "processor_time.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kWarmUp = 11.0;  // [s] the cache of the node's transforms (10 s) is full after this time

void sleepFor(double duration) { std::this_thread::sleep_for(std::chrono::duration<double>(duration)); }

}  // namespace

RunningNode::RunningNode(const Workload& workload, double watched) : workload_(workload) {
  static int count = 0;
  const std::string space = "/bench_" + std::to_string(++count);
  name_ = space + "/proximity";
  for (const auto& robot : workload.descriptions) ros::param::set(space + "/" + robot.first, robot.second);
  ros::param::set(name_, workload.params);

  const double tick = 1.0 / workload.rate;
  listener_ = std::make_unique<Listener>(name_, workload.distances);
  publisher_ = std::make_unique<TfPublisher>(workload_, tick * (1.0 + tick / watched), name_);
  const char* folder = std::getenv("ROS_LOG_DIR");
  const std::string log = std::string(folder == nullptr ? "/tmp" : folder) + space + ".log";
  process_ =
      std::make_unique<test::ChildProcess>(std::vector<std::string>{HGRID_NODE, "__ns:=" + space, "__name:=proximity"},
                                           log, std::map<std::string, std::string>{});
  for (double waited = 0.0; !listener_->serves(workload.bodies); waited += 0.1) {
    if (waited > 60.0 || !process_->alive()) {
      throw std::runtime_error("the node does not know the whole world: " + listener_->troubles());
    }
    sleepFor(0.1);
  }
  sleepFor(kWarmUp);
}

void RunningNode::watch(Sightings& sightings) {
  sightings_ = &sightings;
  listener_->noteIn(sightings_);
  began_ = clocks();
}

void RunningNode::rest() {
  const Clocks ended = clocks();
  listener_->noteIn(nullptr);
  sightings_->duration += ended.now - began_.now;
  sightings_->node_time += ended.node - began_.node;
  sightings_->bench_time += ended.bench - began_.bench;
  const double ours = ended.node - began_.node + ended.bench - began_.bench;
  sightings_->others_time += std::max(0.0, ended.all - began_.all - ours);
  sightings_->late_cycles += ended.late_cycles - began_.late_cycles;
}

double RunningNode::processorTime() const { return bench::processorTime(process_->pid()); }

RunningNode::Clocks RunningNode::clocks() const {
  Clocks clocks;
  clocks.now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  clocks.node = processorTime();
  clocks.bench = bench::processorTime(getpid());
  clocks.all = processorTimeOfAll();
  clocks.late_cycles = publisher_->lateCycles();
  return clocks;
}

}  // namespace bench
}  // namespace hgrid
