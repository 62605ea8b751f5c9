// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <hgrid_proximity/Pairs.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <sys/types.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "robots_witness.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// A program started with its arguments, stopped on destruction.
class Child {
 public:
  explicit Child(std::vector<std::string> arguments);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  bool running() const;
  /// [s] of processor time that it has used.
  double processorTime() const;

 private:
  pid_t pid_ = -1;
};

/// Joint states, 50 times a second: held still, or moving to and fro between the limits.
class Puppeteer {
 public:
  struct Puppet {
    std::string name;  ///< of the robot; its namespace too
    const WitnessRobot* robot;
  };

  Puppeteer(ros::NodeHandle& node, const std::vector<Puppet>& puppets, std::uint64_t seed);
  ~Puppeteer();

  /// Draws a state and holds it. @returns from when on
  ros::Time holdAnother();
  void move();
  /// Positions of a robot's joints; those that are held, while it is held.
  WitnessRobot::Positions positions(const std::string& robot) const;

 private:
  struct Driven {
    std::string robot;
    WitnessRobot::Joint joint;
    double phase = 0.0;
  };
  double positionOf(const Driven& driven) const;
  void publish();
  void run();

  std::vector<Puppet> puppets_;
  std::vector<ros::Publisher> publishers_;
  mutable std::mutex mutex_;  // of what follows
  Random random_;
  std::vector<Driven> driven_;
  bool moving_ = false;
  double time_ = 0.0;  // [s] of movement
  bool stop_ = false;
  std::thread thread_;
};

/// ~pairs as it comes, on a thread of its own.
class PairsListener {
 public:
  explicit PairsListener(ros::NodeHandle node);

  /// The next message that `wanted` says yes to; null after `patience`.
  hgrid_proximity::PairsConstPtr waitFor(const std::function<bool(const hgrid_proximity::Pairs&)>& wanted,
                                         std::chrono::seconds patience);
  /// Times between the messages that come in the next `duration`, sorted [s].
  std::vector<double> gapsOver(std::chrono::seconds duration);

 private:
  void onPairs(const hgrid_proximity::PairsConstPtr& message);

  ros::CallbackQueue queue_;
  std::mutex mutex_;
  std::condition_variable came_;
  hgrid_proximity::PairsConstPtr last_;
  std::vector<std::chrono::steady_clock::time_point> arrivals_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

}  // namespace test
}  // namespace hgrid
