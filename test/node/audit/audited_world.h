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

/// A SimulatedWorld of ten moving bodies with different shapes, three fixed bodies and a robot, whose transforms are
/// recorded for audits. Frame "f0" .. "f9" move in frame "hub", which moves in the world frame.
class AuditedWorld {
 public:
  /// Changes a transform between the record and the node. Returns false if the node does not get it at all.
  using Tamper = std::function<bool(geometry_msgs::TransformStamped& transform)>;

  explicit AuditedWorld(unsigned seed, const Params& params = defaults());
  static Params defaults();

  SimulatedWorld& world() { return world_; }
  Random& random() { return random_; }
  /// Adds a robot with two links of one group. @param off  [m] how wrong the node places the second link
  void addRobot(double off);

  /// Sends one transform: to the record as it is, and to the node as `tamper` makes it.
  void send(geometry_msgs::TransformStamped transform, bool is_static = false, const std::string& publisher = "/state");
  /// Returns a random small pose of `child` in `parent`, stamped `delay` [s] before now.
  geometry_msgs::TransformStamped randomTransform(const std::string& parent, const std::string& child, double delay);
  /// Moves all frames, waits 10 ms and makes a tick.
  const Tick& step();
  /// Collects the case of the newest tick.
  AuditCase audited();

  Tamper tamper;
  std::function<bool(const std::string& frame)> is_silent;  ///< whether a frame is not published at all

 private:
  SimulatedWorld world_;
  Random random_;
  TransformRecord record_;
  std::uint64_t epoch_ = 0;
};

}  // namespace test
}  // namespace hgrid
