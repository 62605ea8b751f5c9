// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/query_answer.h"
#include "src/node/world/world.h"

namespace hgrid {
namespace test {

/// A World with clocks that the test sets. It needs no ROS master, and wait() returns immediately.
///
/// The world frame is "base". For each name in `frames` there is an obstacle: a sphere of radius 0.1 m at the origin of
/// the tf frame of this name.
class SimulatedWorld {
 public:
  enum class Clock { wall, simulated };
  static constexpr double kStart = 1e6;  ///< [s] ROS time when a test begins

  explicit SimulatedWorld(const std::vector<std::string>& frames, Clock clock = Clock::wall, Params params = Params{});
  /// Uses a ledger that outlives this object. If many worlds share one ledger, they log at most one line per second in
  /// total.
  SimulatedWorld(const std::vector<std::string>& frames, Clock clock, Params params, Ledger& ledger);

  /// Returns the time since the start by the ROS clock [s].
  double now() const { return now_; }
  /// Advances both clocks by this time [s].
  void wait(double duration);
  /// Sets the ROS clock to another time [s] since the start. The steady clock does not change.
  void setRosClock(double time) { now_ = time; }

  /// Receives a transform of a publisher on /tf: `child` is at (x, y, 0) [m] in `parent`, `stamp` [s] after the start.
  void send(const std::string& publisher, const std::string& parent, const std::string& child, double x, double stamp,
            double y = 0.0);
  /// Like send(), with the current time as stamp.
  void sendNow(const std::string& publisher, const std::string& parent, const std::string& child, double x) {
    send(publisher, parent, child, x, now_);
  }
  /// Like send(), but on /tf_static.
  void fix(const std::string& publisher, const std::string& parent, const std::string& child, double x,
           double stamp = 0.0, double y = 0.0);
  /// Receives a transform from /tf or /tf_static.
  void take(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher);

  /// Runs the next tick and returns it.
  const Tick& tick();
  /// Returns the newest tick.
  const Tick& last() const { return *tick_; }
  const Snapshot& snapshot() const { return *tick_->snapshot; }
  /// Returns the pose of the obstacle at a frame, as the newest tick uses it.
  const BodyPose& pose(const std::string& frame) const;
  double x(const std::string& frame) const { return pose(frame).world_from_body.translation().x(); }
  /// Returns the stamp of pose(frame), counted from the start [s].
  double stamp(const std::string& frame) const;
  /// Returns the time of the newest tick, counted from the start [s].
  double tickTime() const;
  /// Returns the entry of the newest tick about the obstacle at a frame; null if there is none.
  const BodyTrouble* trouble(const std::string& frame) const;
  /// Returns whether the newest tick reports the obstacles at two frames as a pair.
  bool near(const std::string& first, const std::string& second) const;
  /// Returns the verdict of a query with a sphere at (x, 0, 0) [m] in the newest tick.
  Verdict sphere(double x, double radius) const;

  /// Returns the value of the counter `name` of the ledger; 0 if the ledger has no such counter.
  std::uint64_t counter(const std::string& name) const;
  World& world() { return *world_; }
  Moment moment() const;
  const Params& params() const { return params_; }

 private:
  geometry_msgs::TransformStamped stamped(const std::string& parent, const std::string& child, double x, double y,
                                          double stamp) const;

  Params params_;
  Ledger own_ledger_;
  Ledger& ledger_;
  double now_ = 0.0, steady_ = 0.0;
  std::unique_ptr<World> world_;
  std::shared_ptr<const Tick> tick_;
};

}  // namespace test
}  // namespace hgrid
