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

/// Runs a program in a child process. The destructor stops it.
class Child {
 public:
  explicit Child(std::vector<std::string> arguments);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  pid_t pid() const { return pid_; }
  bool running() const;

 private:
  pid_t pid_ = -1;
};

/// Publishes the joint states of all robots at 50 Hz. Either all joints rest, or each joint moves back and forth
/// between its limits.
class Puppeteer {
 public:
  struct Puppet {
    std::string name;  ///< name of the robot and of its namespace
    const WitnessRobot* robot;
  };

  Puppeteer(ros::NodeHandle& node, const std::vector<Puppet>& puppets, std::uint64_t seed);
  ~Puppeteer();

  /// Chooses a random state of all joints and holds it. @returns the time from which the state is published
  ros::Time holdAnother();
  /// Moves all joints from now on.
  void move();
  /// Returns the current positions of the joints of a robot.
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
  mutable std::mutex mutex_;  // guards the members below
  Random random_;
  std::vector<Driven> driven_;
  bool moving_ = false;
  double time_ = 0.0;  // [s] total time during which the joints have moved
  bool stop_ = false;
  std::thread thread_;
};

/// Receives ~pairs on a separate thread.
class PairsListener {
 public:
  explicit PairsListener(ros::NodeHandle node);

  /// Waits for the next message for which `wanted` is true. @returns null if no such message comes within `patience`
  hgrid_proximity::PairsConstPtr waitFor(const std::function<bool(const hgrid_proximity::Pairs&)>& wanted,
                                         std::chrono::seconds patience);
  /// Returns the next `count` messages in the order in which they arrived. Returns fewer messages if `patience` ends
  /// before.
  std::vector<hgrid_proximity::PairsConstPtr> next(std::size_t count, std::chrono::seconds patience);

 private:
  void onPairs(const hgrid_proximity::PairsConstPtr& message);

  ros::CallbackQueue queue_;
  std::mutex mutex_;
  std::condition_variable came_;
  hgrid_proximity::PairsConstPtr last_;
  std::vector<hgrid_proximity::PairsConstPtr> arrived_;  // messages since the last call of next()
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

}  // namespace test
}  // namespace hgrid
