// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/description_watch.h"

#include <algorithm>
#include <chrono>
#include <set>

namespace hgrid {
namespace {

using WatchClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWatchPause{1000};  // shortest pause between two looks at the same description
constexpr int kWatchShare = 50;  // the pause after a look is at least this many times as long as the look

/// Returns the names of the parameters that hold the description of a robot.
std::string keyOf(const RobotSpec& robot) { return robot.params.description + " " + robot.params.semantic; }

}  // namespace

DescriptionWatch::DescriptionWatch(const RobotSource& source, const Params& params) : source_(source) {
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

void DescriptionWatch::setRobots(Robots robots) {
  robots.erase(std::remove_if(robots.begin(), robots.end(), [](const auto& robot) { return robot->text != nullptr; }),
               robots.end());
  std::map<std::string, std::shared_ptr<const RobotSpec>> by_key;
  for (const auto& robot : robots) by_key.emplace(keyOf(*robot), robot);
  Robots distinct;
  for (const auto& one : by_key) distinct.push_back(one.second);
  std::set<std::string> names;
  for (const auto& robot : robots) names.insert(robot->params.name);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto read = read_.begin(); read != read_.end();) {
    read = names.count(read->first) == 0 ? read_.erase(read) : std::next(read);
  }
  robots_.swap(robots);
  distinct_.swap(distinct);
}

void DescriptionWatch::noteRead(const std::string& robot, std::uint64_t hash) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++reads_;
  read_[robot] = hash;
  seen_.clear();  // what was seen before may be older than what was read
}

void DescriptionWatch::noteLike(const std::string& robot, const std::string& other) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto read = read_.find(other);
  if (read != read_.end()) read_[robot] = read->second;
}

DescriptionWatch::Robots DescriptionWatch::changed() const {
  Robots robots;
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const auto& robot : robots_) {
    const auto seen = seen_.find(keyOf(*robot)), read = read_.find(robot->params.name);
    if (seen != seen_.end() && read != read_.end() && seen->second != read->second) robots.push_back(robot);
  }
  return robots;
}

void DescriptionWatch::run() {
  // One description after the other, with pauses in between: the ROS master would need milliseconds for many of them at
  // once, and other threads may need its processor.
  WatchClock::duration pause = kWatchPause;
  for (std::size_t next = 0;; ++next) {
    std::shared_ptr<const RobotSpec> robot;
    std::size_t count = 1;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      if (wake_.wait_for(lock, pause, [this] { return ends_; })) return;
      count = std::max<std::size_t>(1, distinct_.size());
      if (!distinct_.empty()) robot = distinct_[next % count];
    }
    const auto begin = WatchClock::now();
    if (robot) look(*robot);
    pause = std::max<WatchClock::duration>(kWatchPause / static_cast<int>(count),
                                           kWatchShare * (WatchClock::now() - begin));
  }
}

/// Reads a description and stores its hash. Stores nothing if noteRead() was called during the reading.
void DescriptionWatch::look(const RobotSpec& robot) {
  std::uint64_t reads_before = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto was_read = [&](const auto& one) {
      return keyOf(*one) == keyOf(robot) && read_.count(one->params.name) != 0;
    };
    if (ends_ || std::none_of(robots_.begin(), robots_.end(), was_read)) return;
    reads_before = reads_;
  }
  try {
    const std::uint64_t hash = source_.describe(robot).hash();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (reads_ == reads_before) seen_[keyOf(robot)] = hash;
  } catch (const std::exception&) {
    // There is no description, or no memory for it. The next look tries again.
  }
}

}  // namespace hgrid
