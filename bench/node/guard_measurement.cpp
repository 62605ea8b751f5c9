// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "guard_measurement.h"

#include <hgrid_proximity/ApplyObstacles.h>
#include <hgrid_proximity/Conflicts.h>
#include <hgrid_proximity/Guard.h>
#include <hgrid_proximity/ObstacleOperation.h>
#include <hgrid_proximity/ShapeKind.h>
#include <hgrid_proximity/Verdict.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/measure/median.h"
#include "call.h"
#include "running_node.h"
#include "test/support/robots.h"

namespace hgrid {
namespace bench {
namespace {

namespace msg = ::hgrid_proximity;

constexpr double kRate = 20.0;                  // [Hz] of /tf and ticks
constexpr double kSeconds = 10.0, kStep = 0.1;  // [s] duration of a path, and time between its points
constexpr double kValidFor = 5.0;               // [s] ~valid_for
constexpr int kArms = 4;

std::string armName(int arm) { return "panda" + std::to_string(arm); }

/// Returns the path of an arm: each joint swings slowly about a usual posture.
msg::Guard pathOf(int arm) {
  msg::Guard path;
  path.request.robot = armName(arm);
  const double posture[7] = {0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785};
  for (int joint = 0; joint < 7; ++joint) path.request.joint_names.push_back("panda_joint" + std::to_string(joint + 1));
  for (double time = 0.0; time <= kSeconds + 0.5 * kStep; time += kStep) {
    path.request.time_from_start.push_back(ros::Duration(time));
    for (int joint = 0; joint < 7; ++joint) {
      path.request.positions.push_back(posture[joint] + 0.2 * std::sin(0.6 * time + joint + arm));
    }
  }
  return path;
}

/// Receives ~conflicts.
class Conflicts {
 public:
  explicit Conflicts(const std::string& node)
      : subscriber_(handle_.subscribe<msg::Conflicts>(
            node + "/conflicts", 10, [this](const msg::Conflicts::ConstPtr& message) { take(message); })) {}

  /// Waits for the message about a tick. @param sequence  number of the tick
  /// @returns the first message about this tick or a later one
  msg::Conflicts::ConstPtr of(std::uint64_t sequence) {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto find = [&] {
      return std::find_if(messages_.begin(), messages_.end(),
                          [&](const auto& message) { return message.first->world.sequence >= sequence; });
    };
    if (!changed_.wait_for(lock, std::chrono::seconds(10), [&] { return find() != messages_.end(); })) {
      throw std::runtime_error("~conflicts did not come within 10 s");
    }
    const auto found = *find();
    messages_.clear();
    delay_ms_ = 1e3 * (found.second - (found.first->world.valid_until - ros::Duration(kValidFor))).toSec();
    return found.first;
  }
  /// Returns the time from the tick to the arrival of the message that of() returned last [ms].
  double delay() const { return delay_ms_; }

 private:
  void take(const msg::Conflicts::ConstPtr& message) {
    const ros::Time now = ros::Time::now();
    const std::lock_guard<std::mutex> lock(mutex_);
    messages_.emplace_back(message, now);
    changed_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::pair<msg::Conflicts::ConstPtr, ros::Time>> messages_;
  double delay_ms_ = 0.0;
  ros::NodeHandle handle_;
  ros::Subscriber subscriber_;
};

/// Returns a request that puts a sphere at a place.
msg::ApplyObstacles sphereAt(double x, double y, double z) {
  msg::ApplyObstacles change;
  msg::Obstacle sphere;
  sphere.name = "moved";
  sphere.operation = msg::ObstacleOperation::ADD;
  sphere.replace = true;
  sphere.pose.position.x = x;
  sphere.pose.position.y = y;
  sphere.pose.position.z = z;
  sphere.pose.orientation.w = 1.0;
  msg::Shape shape;
  shape.kind = msg::ShapeKind::SPHERE;
  shape.dimensions.push_back(0.05);
  shape.pose.orientation.w = 1.0;
  sphere.shapes.push_back(shape);
  change.request.changes.push_back(sphere);
  return change;
}

}  // namespace

std::optional<GuardMeasurement> measureGuard(double duration) {
  if (test::sharedData().empty()) return std::nullopt;
  Workload workload = pandas(kArms, kRate);
  workload.params["valid_for"] = kValidFor;
  workload.params["guard"]["deviation"] = 10.0;  // the arms rest while their paths are checked
  const RunningNode node(workload, duration);
  Conflicts conflicts(node.name());
  ros::NodeHandle handle;
  ros::ServiceClient guard = handle.serviceClient<msg::Guard>(node.name() + "/guard", true);
  ros::ServiceClient apply = handle.serviceClient<msg::ApplyObstacles>(node.name() + "/apply_obstacles", true);

  GuardMeasurement result;
  std::vector<double> free, conflict;
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(duration);
  while (ros::WallTime::now() < end || result.moves < 20) {
    if (result.moves % 20 == 0) {  // before the paths end
      for (int arm = 0; arm < kArms; ++arm) {
        msg::Guard path = pathOf(arm);
        call(guard, path);
      }
    }
    const bool blocks = result.moves % 2 == 0;
    msg::ApplyObstacles change = blocks ? sphereAt(0.35, 0.0, 0.6) : sphereAt(0.0, 0.0, 3.0);
    call(apply, change);
    const msg::Conflicts::ConstPtr found = conflicts.of(change.response.world.sequence);
    const bool hit = !found->first.empty();
    if (hit != blocks || found->robots.size() != kArms) throw std::runtime_error("~conflicts does not fit the world");
    (blocks ? conflict : free).push_back(conflicts.delay());
    ++result.moves;
  }
  result.free_ms = medianOf(free);
  result.conflict_ms = medianOf(conflict);
  return result;
}

}  // namespace bench
}  // namespace hgrid
