// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/sources/cloud_source.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "hgrid_proximity/refusal.h"
#include "node/health/guarded.h"
#include "node/text/frame_names.h"
#include "node/tick/tick.h"
#include "node/time/ros_time.h"

namespace hgrid {
namespace {

constexpr auto kLookAgain = std::chrono::milliseconds(2);  // pause between two checks for a missing transform

Time steadyNow() { return std::chrono::steady_clock::now().time_since_epoch(); }
Time rosNow() { return fromRos(ros::Time::now()); }
Time durationOf(double length) { return Time(std::llround(1e9 * length)); }

}  // namespace

CloudSource::CloudSource(const ros::NodeHandle& node, const CloudParams& cloud, const Params& params,
                         const SelfShapes& self_shapes, const TransformLookup& transforms,
                         std::shared_ptr<const NarrowPhase> narrow_phase, NewestTick newest, Sink sink, Ledger& ledger)
    : cloud_(cloud),
      what_("cloud '" + cloud.name + "' of " + cloud.topic),
      counter_("cloud/" + cloud.name + "."),
      failed_(counter_ + "failed"),
      simulated_(ros::Time::isSimTime()),
      params_(params),
      self_shapes_(self_shapes),
      transforms_(transforms),
      narrow_phase_(std::move(narrow_phase)),
      newest_(std::move(newest)),
      sink_(std::move(sink)),
      ledger_(ledger),
      cells_(cloud.resolution, durationOf(cloud.lifetime), static_cast<std::size_t>(params.map_max_leaves)),
      node_(node) {
  loaded_.name = cloud.name;
  loaded_.lifetime = cloud.lifetime;
  loaded_.range = cloud.range;
  node_.setCallbackQueue(&queue_);
  const boost::function<void(const boost::shared_ptr<const CloudMessage>&)> on_message =
      [this](const boost::shared_ptr<const CloudMessage>& message) {
        guarded(ledger_, failed_.c_str(), [&] { onMessage(*message); });
      };
  subscriber_ = node_.subscribe<CloudMessage>(cloud_.topic, 1, on_message);
  const double period = std::min(0.1, std::max(0.01, 0.25 * cloud_.lifetime));  // [s] of onTimer()
  timer_ = node_.createSteadyTimer(ros::WallDuration(period), [this](const ros::SteadyTimerEvent&) {
    guarded(ledger_, failed_.c_str(), [&] { onTimer(); });
  });
  spinner_ = std::make_unique<ros::AsyncSpinner>(1, &queue_);
  spinner_->start();
}

CloudSource::~CloudSource() {
  stopping_ = true;
  timer_.stop();
  subscriber_.shutdown();
  spinner_->stop();
}

void CloudSource::onMessage(const CloudMessage& message) {
  Refusal refused(Code::ok, "");
  try {
    take(message);
    ledger_.count(counter_ + "accepted");
    return;
  } catch (const Refusal& refusal) {
    refused = refusal;
  } catch (...) {
    const Refusal fault = caughtRefusal();
    refused = Refusal(fault.code(), what_ + ": " + fault.what());
  }
  sink_.miss(std::string(name(refused.code())) + " " + refused.what());
  grace_.refuse(ledger_, counter_ + "refused", refused);
}

void CloudSource::take(const CloudMessage& message) {
  const auto received = std::chrono::steady_clock::now();
  if (!message.flaw.empty()) throw Refusal(Code::truncated, what_ + ": " + printable(message.flaw, 200));
  if (message.data.size() > static_cast<std::size_t>(params_.map_max_bytes)) {
    throw Refusal(Code::limit, what_ + " has " + std::to_string(message.data.size()) + " bytes; at most " +
                                   std::to_string(params_.map_max_bytes) + " are allowed (~limits/max_map_bytes)");
  }
  const std::shared_ptr<const Tick> tick = newest_();
  if (!tick || tick->world_frame.empty()) {
    throw Refusal(
        Code::not_ready,
        what_ + " cannot be placed yet: the world frame is not known; load the first robot or set ~world_frame");
  }
  const Time now = rosNow();
  const Time given = fromRos(message.stamp);
  const Time stamp = given.count() == 0 ? now : given;
  if (given.count() == 0) {
    ledger_.refuse(
        counter_ + "unstamped",
        Refusal(Code::clock, what_ + " has no stamp; its time of arrival is used instead, so its points may be "
                                     "placed wrongly while the sensor moves: let its publisher set header.stamp"));
  }
  if (seconds(stamp - now) > params_.max_future) {
    throw Refusal(Code::clock, what_ + " is stamped " + secondsText(seconds(stamp - now)) +
                                   " in the future; at most ~limits/max_future, " + secondsText(params_.max_future) +
                                   ", is allowed");
  }
  PointCloud cloud = readPointCloud(message.format, message.data, cloud_.min_range, what_);
  const double reach = cloud_.resolution * CloudCells::kReach;  // [m] points farther away have no cells
  const std::size_t points = returnsWithin(cloud_.range > 0.0 ? std::min(cloud_.range, reach) : reach, cloud);
  const std::uint64_t too_near = cloud.too_near;
  const std::string frame = frameOfData(message.frame, what_);
  if (frame != frame_) {
    sink_.follow(frame);
    frame_ = frame;
  }
  const Pose world_from_sensor = sensorPose(frame, tick->world_frame, stamp);
  const std::vector<Voxel> voxels = voxelsOf(std::move(cloud), world_from_sensor, stamp);
  const Time latency = std::max(Time{0}, now - stamp);
  try {
    cells_.see(voxels, simulated_ ? stamp : Time(received.time_since_epoch()) - latency);
  } catch (const Refusal& refusal) {
    throw Refusal(refusal.code(), what_ + ": " + refusal.what() + " by ~limits/max_map_leaves");
  }
  cells_.forget(cellTime());
  const bool seen = cloud_.empty == EmptyCloud::clear || points >= static_cast<std::size_t>(cloud_.min_points);
  if (seen) noteNewest(stamp, now, received, world_from_sensor.translation());
  noteTooNear(stamp, now, too_near, world_from_sensor.translation());
  if (seen || loaded_.cells) put();
  if (!seen) {
    throw Refusal(Code::out_of_range,
                  "a message of " + what_ + " has " + std::to_string(points) + " points; it needs at least " +
                      std::to_string(cloud_.min_points) +
                      " (min_points) to count as new data; if few points mean free space, set 'empty' of this cloud to "
                      "'clear'");
  }
}

/// Stores the age of the newest message. A message that is older than another one only adds its points. It does not
/// change the age of the cloud, unless the clock was set back.
void CloudSource::noteNewest(Time stamp, Time now, std::chrono::steady_clock::time_point received,
                             const Eigen::Vector3d& sensor) {
  const bool clock_went_back = seconds(loaded_.stamp - now) > params_.max_future;
  if (stamp <= loaded_.stamp && !clock_went_back) {
    ledger_.count(counter_ + "out_of_order");
    return;
  }
  loaded_.received = received;
  loaded_.stamp = stamp;
  loaded_.latency = std::max(0.0, seconds(now - stamp));
  loaded_.sensor = sensor;
}

/// Stores whether something is nearer than the sensor can see. A message that is older than another one does not change
/// that, unless the clock was set back.
void CloudSource::noteTooNear(Time stamp, Time now, std::uint64_t too_near, const Eigen::Vector3d& sensor) {
  const bool clock_went_back = seconds(loaded_.blind_stamp - now) > params_.max_future;
  if (stamp < loaded_.blind_stamp && !clock_went_back) return;
  loaded_.too_near = too_near;
  loaded_.blind_stamp = stamp;
  loaded_.blind = {sensor, cloud_.blind_range};
}

/// Returns the time that measures the age of cells: ROS time if /clock drives it, otherwise the steady clock. So
/// setting the wall clock changes no age.
Time CloudSource::cellTime() const { return simulated_ ? rosNow() : steadyNow(); }

/// Waits until tf knows the poses of the sensor and of the robot's own shapes at the stamp, at most
/// ~limits/max_sync_wait.
void CloudSource::waitFor(const std::string& world_frame, const std::string& frame, Time stamp) const {
  std::vector<std::string> frames;
  if (self_shapes_.wanted()) frames = self_shapes_.frames();
  frames.push_back(frame);
  const auto known = [&](const std::string& one) { return transforms_.isKnown(world_frame, one, stamp); };
  const auto deadline = std::chrono::steady_clock::now() + durationOf(params_.max_sync_wait);
  while (!stopping_ && !frames.empty() && std::chrono::steady_clock::now() < deadline) {
    while (!frames.empty() && known(frames.back())) frames.pop_back();
    if (!frames.empty()) std::this_thread::sleep_for(kLookAgain);
  }
}

/// Returns the pose of the sensor at the stamp.
/// @throws Refusal extrapolation or unknown_frame if tf does not know this pose within ~limits/max_sync_wait
Pose CloudSource::sensorPose(const std::string& frame, const std::string& world_frame, Time stamp) const {
  waitFor(world_frame, frame, stamp);
  std::string why;
  const auto world_from_sensor = transforms_.at(world_frame, frame, stamp, &why);
  if (!world_from_sensor) {
    throw Refusal(transforms_.newest(world_frame, frame) ? Code::extrapolation : Code::unknown_frame,
                  what_ + ": the pose of its frame '" + printable(frame) + "' in '" + world_frame + "' at its stamp, " +
                      text(seconds(stamp)) + " s, is still unknown after ~limits/max_sync_wait, " +
                      secondsText(params_.max_sync_wait) + ": " + printable(why, 300));
  }
  checkWithin(world_from_sensor->translation, params_.world_limit, what_ + ": the pose of its sensor");
  return world_from_sensor->pose();
}

/// Returns the cells that contain the points of a message. Leaves out the cells of the robot itself.
std::vector<Voxel> CloudSource::voxelsOf(PointCloud cloud, const Pose& world_from_sensor, Time stamp) {
  for (Eigen::Vector3d& point : cloud.points) point = world_from_sensor * point;
  const Eigen::Vector3d sensor = world_from_sensor.translation();
  std::size_t out_of_reach = 0;
  const std::size_t forgotten = cells_.follow(sensor);
  std::vector<Voxel> voxels = cells_.cellsOf(cloud.points, sensor, out_of_reach);
  ledger_.count(counter_ + "points", cloud.points.size());
  if (cloud.not_finite > 0) ledger_.count(counter_ + "points_not_finite", cloud.not_finite);
  if (cloud.too_near > 0) ledger_.count(counter_ + "points_too_near", cloud.too_near);
  if (cloud.no_return > 0) ledger_.count(counter_ + "points_without_return", cloud.no_return);
  if (cloud.without_row_step) ledger_.count(counter_ + "without_row_step");
  if (out_of_reach > 0) ledger_.count(counter_ + "points_out_of_reach", out_of_reach);
  if (forgotten > 0) ledger_.count(counter_ + "cells_out_of_reach", forgotten);
  if (!self_shapes_.wanted()) return voxels;
  const Pose world_from_keys(Eigen::Translation3d(cells_.corner()));
  OthersCells others = withoutSelf(voxels, cells_.edge(), world_from_keys, self_shapes_.at(stamp), *narrow_phase_);
  if (others.left_out > 0) ledger_.count(counter_ + "own_cells", others.left_out);
  if (others.undecided > 0) ledger_.count(counter_ + "cells_undecided", others.undecided);
  return std::move(others.voxels);
}

/// Removes cells that no point has hit for their lifetime, even if no message arrives.
void CloudSource::onTimer() {
  if (!loaded_.cells || cells_.forget(cellTime()) == 0) return;
  put();
}

void CloudSource::put() {
  loaded_.cells = makeMapCells(std::make_shared<StaticGrid>(cells_.edge(), cells_.cells()), *narrow_phase_, nullptr,
                               false);  // the next message replaces the cells
  loaded_.corner = cells_.corner();
  sink_.put(loaded_);
}

}  // namespace hgrid
