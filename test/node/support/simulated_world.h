// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/queries/query_answer.h"
#include "src/node/world/world.h"

namespace hgrid {
namespace test {

/// A World whose clocks the test sets. It needs no ROS master and never waits.
///
/// The world frame is "base". Each name of `frames` is an obstacle of one sphere (radius 0.1 m) at the origin of the tf
/// frame of that name.
class SimulatedWorld {
 public:
  enum class Clock { wall, simulated };
  static constexpr double kStart = 1e6;  ///< [s] ROS time when a test begins

  explicit SimulatedWorld(const std::vector<std::string>& frames, Clock clock = Clock::wall, Params params = Params{});
  /// With a ledger that outlives this object, so that many worlds together log one line per second.
  SimulatedWorld(const std::vector<std::string>& frames, Clock clock, Params params, Ledger& ledger);

  /// [s] Time by the ROS clock since the start.
  double now() const { return now_; }
  /// Lets both clocks advance [s].
  void wait(double duration);
  /// Sets the ROS clock to another time [s] since the start. The steady clock goes on as it was.
  void setRosClock(double time) { now_ = time; }

  /// Publishes child in parent at (x, y, 0) [m] on /tf, stamped `stamp` [s] since the start.
  void send(const std::string& publisher, const std::string& parent, const std::string& child, double x, double stamp,
            double y = 0.0);
  /// The same, stamped now.
  void sendNow(const std::string& publisher, const std::string& parent, const std::string& child, double x) {
    send(publisher, parent, child, x, now_);
  }
  /// The same on /tf_static.
  void fix(const std::string& publisher, const std::string& parent, const std::string& child, double x,
           double stamp = 0.0, double y = 0.0);
  void take(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher);

  /// Makes the next tick.
  const Tick& tick();
  /// The newest tick.
  const Tick& last() const { return *tick_; }
  const Snapshot& snapshot() const { return *tick_->snapshot; }
  /// The pose in use of the body at a frame, in the newest tick.
  const BodyPose& pose(const std::string& frame) const;
  double x(const std::string& frame) const { return pose(frame).world_from_body.translation().x(); }
  /// [s] since the start: the stamp of the pose in use.
  double stamp(const std::string& frame) const;
  /// [s] since the start: the time of the newest tick.
  double tickTime() const;
  /// The newest tick's entry about the body at a frame; null if there is none.
  const BodyTrouble* trouble(const std::string& frame) const;
  /// Whether the newest tick reports the bodies at two frames as near.
  bool near(const std::string& first, const std::string& second) const;
  /// The verdict about a sphere [m] in the newest tick.
  Verdict sphere(double x, double radius) const;

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
