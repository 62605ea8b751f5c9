// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/description_watch.h"

#include <algorithm>
#include <chrono>
#include <functional>

namespace hgrid {
namespace {

using WatchClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWatchPause{1000};  // shortest pause between two looks at the same description
constexpr int kWatchShare = 50;  // the pause after a look is at least this many times as long as the look

/// Returns a hash of a description. Two descriptions that differ have the same hash with a probability of 2^-64.
std::size_t hashOf(const RobotDescription& description) {
  const std::hash<std::string> hash;
  return hash(description.urdf) + (description.srdf ? 31 * hash(*description.srdf) + 1 : 0);
}

}  // namespace

DescriptionWatch::DescriptionWatch(const RobotSource& source, const Params& params) : source_(source), params_(params) {
  if (params.watch_descriptions) thread_ = std::thread([this] { run(); });
}

DescriptionWatch::~DescriptionWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ends_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void DescriptionWatch::noteRead(const RobotParams& robot, const RobotDescription& description) {
  const std::size_t hash = hashOf(description);
  const std::lock_guard<std::mutex> lock(mutex_);
  ++reads_;
  read_[robot.name] = hash;
  seen_.erase(robot.name);
}

std::vector<const RobotParams*> DescriptionWatch::changed() const {
  std::vector<const RobotParams*> robots;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const RobotParams& robot : params_.robots) {
    const auto seen = seen_.find(robot.name), read = read_.find(robot.name);
    if (seen != seen_.end() && read != read_.end() && seen->second != read->second) robots.push_back(&robot);
  }
  return robots;
}

void DescriptionWatch::run() {
  // One robot after the other, with pauses in between: the ROS master would need milliseconds for many descriptions at
  // once, and other threads may need its processor.
  const std::vector<RobotParams>& robots = params_.robots;
  const WatchClock::duration least_pause = kWatchPause / static_cast<int>(std::max<std::size_t>(1, robots.size()));
  WatchClock::duration pause = least_pause;
  for (std::size_t next = 0;; ++next) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      if (wake_.wait_for(lock, pause, [this] { return ends_; })) return;
    }
    const auto begin = WatchClock::now();
    if (!robots.empty()) look(robots[next % robots.size()]);
    pause = std::max<WatchClock::duration>(least_pause, kWatchShare * (WatchClock::now() - begin));
  }
}

/// Reads the description of a robot and stores its hash. Stores nothing if noteRead() was called during the reading.
void DescriptionWatch::look(const RobotParams& robot) {
  std::uint64_t reads_before = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ends_ || read_.count(robot.name) == 0) return;
    reads_before = reads_;
  }
  try {
    const std::size_t hash = hashOf(source_.describe(robot));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (reads_ == reads_before) seen_[robot.name] = hash;
  } catch (const std::exception&) {
    // There is no description, or no memory for it. The next look tries again.
  }
}

}  // namespace hgrid
