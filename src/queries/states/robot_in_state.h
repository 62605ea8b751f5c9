// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "queries/states/four_spheres.h"
#include "queries/states/robot_shapes.h"

namespace hgrid {

/// A robot in one of four states: where its shapes are. It refers to the arguments of its constructor.
class RobotInState {
 public:
  /// @param groups  poses of the rigid groups in the four states
  /// @param placed  boxes of the shapes in the four states
  RobotInState(const Snapshot& snapshot, const NarrowPhase& narrow_phase, const RobotShapes& robot,
               const std::vector<FourPoses>& groups, const std::vector<FourShapes>& placed, std::size_t lane)
      : snapshot(snapshot), narrow_phase(narrow_phase), robot(robot), groups_(groups), placed_(placed), lane_(lane) {}

  Pose worldFromShape(std::size_t shape) const {
    return groups_[robot.shapes()[shape].group].of(lane_) * robot.shapes()[shape].group_from_shape;
  }
  /// Returns the box around a shape, relative to the origin of the snapshot.
  TiltedBox<float> boxOf(std::size_t shape) const {
    const TiltedBox<Four>& four = placed_[shape].box;
    TiltedBox<float> box;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) box.axes[i][k] = four.axes[i][k][lane_];
      box.center[i] = four.center[i][lane_];
      box.half[i] = four.half[i][lane_];
    }
    box.is_ball = four.is_ball;
    return box;
  }
  /// Returns the axis-aligned box around a shape, relative to the origin of the snapshot.
  Aabb boundsOf(std::size_t shape) const {
    const FourBounds& four = placed_[shape].bounds;
    return {{four.min[0][lane_], four.min[1][lane_], four.min[2][lane_]},
            {four.max[0][lane_], four.max[1][lane_], four.max[2][lane_]}};
  }
  /// Measures a shape of the robot, as the first of two, against a solid.
  /// @param other  null: not known; the result is then Measure::not_measured
  Proximity measure(std::size_t shape, const Solid* other, const Pose& world_from_other, double other_padding,
                    double up_to) const {
    const BodyShape& own = *robot.shapes()[shape].what;
    if (!own.solid || other == nullptr) return {};
    const Pose world_from_shape = worldFromShape(shape);
    return narrow_phase.measure({*own.solid, world_from_shape, own.padding}, {*other, world_from_other, other_padding},
                                up_to);
  }
  /// Measures a shape of the robot against a shape of another body, which is where the snapshot has it.
  Proximity measureBody(std::size_t shape, std::uint32_t body, std::uint32_t body_shape, double up_to) const {
    const BodyShape& other = snapshot.structure().bodies[body].shapes[body_shape];
    return measure(shape, other.solid.get(), snapshot.poses()[body].world_from_body * other.body_from_shape,
                   other.padding, up_to);
  }
  /// Returns the spheres inside a shape, relative to the origin of the snapshot.
  FourSpheres spheresOf(std::size_t shape) const {
    const RobotShape& own = robot.shapes()[shape];
    Pose local_from_group = groups_[own.group].of(lane_);
    local_from_group.translation() -= snapshot.origin();
    return own.spheres.at(local_from_group);
  }
  /// Returns whether the pair filter switches off a shape of the robot and a body.
  bool allowed(std::size_t shape, std::uint32_t body) const {
    return snapshot.structure().filter.allowed(robot.shapes()[shape].body, body);
  }

  const Snapshot& snapshot;
  const NarrowPhase& narrow_phase;
  const RobotShapes& robot;

 private:
  const std::vector<FourPoses>& groups_;
  const std::vector<FourShapes>& placed_;
  const std::size_t lane_;
};

}  // namespace hgrid
