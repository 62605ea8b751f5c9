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

/// A World with clocks that the test sets. It needs no ROS master, and wait() returns immediately.
///
/// The world frame is "base". Each name of `frames` is an obstacle of one sphere (radius 0.1 m) at the origin of the tf
/// frame of that name.
class SimulatedWorld {
 public:
  enum class Clock { wall, simulated };
  static constexpr double kStart = 1e6;  ///< [s] ROS time when a test begins

  explicit SimulatedWorld(const std::vector<std::string>& frames, Clock clock = Clock::wall, Params params = Params{});
  /// Uses a ledger that outlives this object. Many worlds can share one ledger, so that they log one line per second
  /// together.
  SimulatedWorld(const std::vector<std::string>& frames, Clock clock, Params params, Ledger& ledger);

  /// [s] Time by the ROS clock since the start.
  double now() const { return now_; }
  /// Advances both clocks by this time [s].
  void wait(double duration);
  /// Sets the ROS clock to another time [s] since the start. The steady clock does not change.
  void setRosClock(double time) { now_ = time; }

  /// Takes in a transform of a publisher on /tf: `child` is at (x, y, 0) [m] in `parent`, `stamp` [s] after the start.
  void send(const std::string& publisher, const std::string& parent, const std::string& child, double x, double stamp,
            double y = 0.0);
  /// Like send(), with the current time as stamp.
  void sendNow(const std::string& publisher, const std::string& parent, const std::string& child, double x) {
    send(publisher, parent, child, x, now_);
  }
  /// Like send(), but on /tf_static.
  void fix(const std::string& publisher, const std::string& parent, const std::string& child, double x,
           double stamp = 0.0, double y = 0.0);
  /// Takes in a transform from /tf or /tf_static.
  void take(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher);

  /// Runs the next tick and returns it.
  const Tick& tick();
  /// The newest tick.
  const Tick& last() const { return *tick_; }
  const Snapshot& snapshot() const { return *tick_->snapshot; }
  /// The pose of the body at a frame, as the newest tick uses it.
  const BodyPose& pose(const std::string& frame) const;
  double x(const std::string& frame) const { return pose(frame).world_from_body.translation().x(); }
  /// [s] Stamp of that pose, since the start.
  double stamp(const std::string& frame) const;
  /// [s] Time of the newest tick, since the start.
  double tickTime() const;
  /// The newest tick's entry about the body at a frame; null if there is none.
  const BodyTrouble* trouble(const std::string& frame) const;
  /// Whether the newest tick reports the bodies at two frames as near.
  bool near(const std::string& first, const std::string& second) const;
  /// The verdict of a query with a sphere at (x, 0, 0) [m] in the newest tick.
  Verdict sphere(double x, double radius) const;

  /// Value of a counter of the ledger; 0 if there is none of this name.
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
