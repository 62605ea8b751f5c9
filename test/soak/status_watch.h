// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Status.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace hgrid {
namespace soak {

/// What the messages of ~status said during a span of time.
struct Heard {
  std::size_t messages = 0;
  std::size_t incomplete = 0;                     ///< messages with an incomplete world
  std::string reason;                             ///< why the world was incomplete the last time; empty: it never was
  std::vector<double> ticks;                      ///< [s] duration of each tick
  std::uint64_t sequence = 0;                     ///< number of the newest tick
  std::map<std::string, std::uint64_t> counters;  ///< name -> value, for the newest tick
};

/// Subscribes to ~status of a node.
class StatusWatch {
 public:
  explicit StatusWatch(const std::string& node)
      : subscriber_(node_.subscribe(node + "/status", 1000, &StatusWatch::onStatus, this)) {}

  /// Returns what was heard since the last call.
  Heard take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    Heard taken = heard_;
    heard_.messages = heard_.incomplete = 0;
    heard_.reason.clear();
    heard_.ticks.clear();
    return taken;
  }

 private:
  void onStatus(const ::hgrid_proximity::Status::ConstPtr& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++heard_.messages;
    heard_.sequence = status->world.sequence;
    if (!status->world.complete) {
      ++heard_.incomplete;
      heard_.reason = status->world.reasons.empty() ? "no reason was given" : status->world.reasons.front();
    }
    for (const auto& timing : status->timings) {
      if (timing.name == "tick") heard_.ticks.push_back(timing.last);
    }
    for (const auto& counter : status->counters) heard_.counters[counter.name] = counter.value;
  }

  std::mutex mutex_;
  Heard heard_;  // guarded by mutex_
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
};

}  // namespace soak
}  // namespace hgrid
