// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "change_measurement.h"

#include <hgrid_proximity/ApplyObstacles.h>
#include <hgrid_proximity/ObstacleOperation.h>
#include <hgrid_proximity/ShapeKind.h>
#include <hgrid_proximity/Status.h>
#include <ros/node_handle.h>

#include <mutex>
#include <random>
#include <string>

#include "bench/measure/median.h"
#include "call.h"
#include "running_node.h"

namespace hgrid {
namespace bench {
namespace {

namespace msg = ::hgrid_proximity;

constexpr double kRate = 100.0;  // [Hz] of /tf and ticks
constexpr std::size_t kBodies = 10000;
constexpr double kHalfSide = 30.0;  // [m] half the side of the cube that the added obstacles are in

/// Returns a request that adds boxes at random places.
msg::ApplyObstacles requestToAddBoxes(std::size_t count, const std::string& prefix, std::mt19937& random) {
  std::uniform_real_distribution<double> place(-kHalfSide, kHalfSide);
  msg::ApplyObstacles change;
  for (std::size_t i = 0; i < count; ++i) {
    msg::Obstacle box;
    box.name = prefix + std::to_string(i);
    box.operation = msg::ObstacleOperation::ADD;
    box.pose.position.x = place(random);
    box.pose.position.y = place(random);
    box.pose.position.z = place(random);
    box.pose.orientation.w = 1.0;
    msg::Shape shape;
    shape.kind = msg::ShapeKind::BOX;
    shape.dimensions = {0.3, 0.3, 0.3};
    shape.pose.orientation.w = 1.0;
    box.shapes.push_back(shape);
    change.request.changes.push_back(box);
  }
  return change;
}

/// Receives the timing "tick" of ~status.
class TickTimes {
 public:
  explicit TickTimes(const std::string& node)
      : subscriber_(handle_.subscribe<msg::Status>(node + "/status", 1,
                                                   [this](const msg::Status::ConstPtr& status) { take(*status); })) {}

  msg::Timing newest() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return tick_;
  }

 private:
  void take(const msg::Status& status) {
    for (const msg::Timing& timing : status.timings) {
      if (timing.name != "tick") continue;
      const std::lock_guard<std::mutex> lock(mutex_);
      tick_ = timing;
    }
  }

  std::mutex mutex_;
  msg::Timing tick_;
  ros::NodeHandle handle_;
  ros::Subscriber subscriber_;
};

}  // namespace

ChangeMeasurement measureChanges() {
  constexpr double kSettle = 8.0;  // [s] ~status then covers only ticks after the last request: 500 ticks, 5 s
  constexpr double kUpdate = 1.5;  // [s] ~status computes its timings once per second
  const Workload workload = freeBodies(kBodies, 100, kRate);
  const RunningNode node(workload, kSettle);
  TickTimes ticks(node.name());
  ros::NodeHandle handle;
  ros::ServiceClient apply = handle.serviceClient<msg::ApplyObstacles>(node.name() + "/apply_obstacles", true);
  std::mt19937 random(1);

  ChangeMeasurement result;
  result.bodies = kBodies;
  ros::WallDuration(kSettle).sleep();
  result.resting_ms = 1e3 * ticks.newest().median;
  result.longest_resting_ms = 1e3 * ticks.newest().max;
  const std::size_t added[] = {1, 1000, 10000}, requests[] = {20, 3, 1};
  for (std::size_t row = 0; row < 3; ++row) {
    std::vector<double> answers;
    for (std::size_t i = 0; i < requests[row]; ++i) {
      msg::ApplyObstacles change =
          requestToAddBoxes(added[row], "row" + std::to_string(row) + "_" + std::to_string(i) + "_", random);
      const ros::WallTime begin = ros::WallTime::now();
      call(apply, change);
      answers.push_back(1e3 * (ros::WallTime::now() - begin).toSec());
      ros::WallDuration(0.1).sleep();
    }
    ros::WallDuration(kUpdate).sleep();
    result.rows.push_back({added[row], requests[row], 1e3 * ticks.newest().max, medianOf(answers)});
    ros::WallDuration(kSettle).sleep();
  }
  return result;
}

}  // namespace bench
}  // namespace hgrid
