// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <string>

#include "src/node/audit/audit.h"
#include "test/node/support/simulated_world.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// A SimulatedWorld whose transforms are recorded for audits. It has ten moving bodies with different shapes and three
/// fixed bodies. addRobot() adds a robot. The frames "f0" to "f9" move in frame "hub", which moves in the world frame.
class AuditedWorld {
 public:
  /// Changes a transform that was recorded before the node receives it. Returns false if the node must not receive the
  /// transform.
  using Tamper = std::function<bool(geometry_msgs::TransformStamped& transform)>;

  explicit AuditedWorld(unsigned seed, const Params& params = defaults());
  static Params defaults();

  SimulatedWorld& world() { return world_; }
  Random& random() { return random_; }
  /// Adds a robot with two links of one rigid group.
  /// @param off  [m] the node places the second link this far from the place that the transforms give
  /// @param published  whether /tf_static has the frame of the second link
  void addRobot(double off, bool published = true);

  /// Declares the robot absent or present.
  void declareRobot(bool present);

  /// Records one transform without a change. Then changes it by `tamper` and sends it to the node.
  void send(geometry_msgs::TransformStamped transform, bool is_static = false, const std::string& publisher = "/state");
  /// Returns a random small pose of `child` in `parent`, stamped `delay` [s] before now.
  geometry_msgs::TransformStamped randomTransform(const std::string& parent, const std::string& child, double delay);
  /// Moves all frames, waits 10 ms and makes a tick.
  const Tick& step();
  /// Collects the case of the newest tick.
  AuditCase audited();

  Tamper tamper;                                            ///< empty: no transform is changed
  std::function<bool(const std::string& frame)> is_silent;  ///< whether step() leaves out a frame; empty: no

 private:
  SimulatedWorld world_;
  Random random_;
  TransformRecord record_;
  std::uint64_t epoch_ = 0;
};

}  // namespace test
}  // namespace hgrid
