// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "robots_puppets.h"

#include <sensor_msgs/JointState.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

extern char** environ;

namespace hgrid {
namespace test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kStep = std::chrono::milliseconds(20);
constexpr double kCycle = 10.0;  // [s] time in which a joint moves from one limit to the other and back

/// Triangle wave with period 2: rises from 0 at x = 0 to 1 at x = 1, and falls to 0 at x = 2.
double triangle(double x) {
  const double rest = x - 2.0 * std::floor(x / 2.0);
  return rest < 1.0 ? rest : 2.0 - rest;
}

}  // namespace

Child::Child(std::vector<std::string> arguments) {
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(&argument[0]);
  argv.push_back(nullptr);
  if (posix_spawnp(&pid_, argv[0], nullptr, nullptr, argv.data(), environ) != 0) {
    throw std::runtime_error(arguments.front() + " cannot be started");
  }
}

Child::~Child() {
  kill(pid_, SIGINT);
  for (int i = 0; i < 100; ++i) {
    if (waitpid(pid_, nullptr, WNOHANG) != 0) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

bool Child::running() const {
  siginfo_t info{};
  return waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0;
}

Puppeteer::Puppeteer(ros::NodeHandle& node, const std::vector<Puppet>& puppets, std::uint64_t seed)
    : puppets_(puppets), random_(seed) {
  for (const Puppet& puppet : puppets) {
    publishers_.push_back(node.advertise<sensor_msgs::JointState>("/" + puppet.name + "/joint_states", 1));
    for (const WitnessRobot::Joint& joint : puppet.robot->driven()) driven_.push_back({puppet.name, joint});
  }
  thread_ = std::thread([this] { run(); });
}

Puppeteer::~Puppeteer() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  thread_.join();
}

ros::Time Puppeteer::holdAnother() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Driven& driven : driven_) driven.phase = random_.uniform(0.0, 1.0);
  moving_ = false;
  time_ = 0.0;
  return ros::Time::now();
}

void Puppeteer::move() {
  const std::lock_guard<std::mutex> lock(mutex_);
  moving_ = true;
}

double Puppeteer::positionOf(const Driven& driven) const {
  const WitnessRobot::Joint& joint = driven.joint;
  return joint.lower + (joint.upper - joint.lower) * triangle(driven.phase + 2.0 * time_ / kCycle);
}

WitnessRobot::Positions Puppeteer::positions(const std::string& robot) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  WitnessRobot::Positions positions;
  for (const Driven& driven : driven_) {
    if (driven.robot == robot) positions[driven.joint.name] = positionOf(driven);
  }
  return positions;
}

void Puppeteer::publish() {
  for (std::size_t i = 0; i < puppets_.size(); ++i) {
    sensor_msgs::JointState state;
    state.header.stamp = ros::Time::now();
    for (const Driven& driven : driven_) {
      if (driven.robot != puppets_[i].name) continue;
      state.name.push_back(driven.joint.name);
      state.position.push_back(positionOf(driven));
    }
    publishers_[i].publish(state);
  }
}

void Puppeteer::run() {
  for (Clock::time_point next = Clock::now();; next += kStep) {
    std::this_thread::sleep_until(next);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stop_) return;
    if (moving_) time_ += std::chrono::duration<double>(kStep).count();
    publish();
  }
}

PairsListener::PairsListener(ros::NodeHandle node) : spinner_(1, &queue_) {
  node.setCallbackQueue(&queue_);
  subscriber_ =
      node.subscribe("/proximity/pairs", 100, &PairsListener::onPairs, this, ros::TransportHints().tcpNoDelay());
  spinner_.start();
}

void PairsListener::onPairs(const hgrid_proximity::PairsConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  last_ = message;
  arrived_.push_back(message);
  came_.notify_all();
}

hgrid_proximity::PairsConstPtr PairsListener::waitFor(const std::function<bool(const hgrid_proximity::Pairs&)>& wanted,
                                                      std::chrono::seconds patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  last_.reset();
  const bool came = came_.wait_for(lock, patience, [&] { return last_ && wanted(*last_); });
  return came ? last_ : nullptr;
}

std::vector<hgrid_proximity::PairsConstPtr> PairsListener::next(std::size_t count, std::chrono::seconds patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  arrived_.clear();
  came_.wait_for(lock, patience, [&] { return arrived_.size() >= count; });
  if (arrived_.size() > count) arrived_.resize(count);
  return arrived_;
}

}  // namespace test
}  // namespace hgrid
