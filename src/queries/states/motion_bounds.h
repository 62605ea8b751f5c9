// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "queries/states/robot_shapes.h"

namespace hgrid {

/// How a joint moves on an edge, that is, while all variables change linearly from one state to another.
struct JointTravel {
  double turn = 0.0;   ///< [rad] by how much it turns its group
  double slide = 0.0;  ///< [m] how far it shifts its group
  double most = 0.0;   ///< [m] the largest distance by which it shifts its group from where the group is at 0
};

/// Bounds of the paths of a robot's shapes. While the joints move, no point of a shape travels farther.
///
/// A joint that turns by an angle moves a point by at most the angle times the largest distance of the point from the
/// axis. This distance is at most the sum of the lengths of the links between them. The bounds of all joints that move
/// the point are added.
class MotionBounds {
 public:
  MotionBounds(const Kinematics& kinematics, const RobotShapes& robot);

  /// Memory for an edge. Edges that are examined at the same time need different memories.
  struct Memory {
    std::vector<JointTravel> joints;  // for each rigid group
    std::vector<double> paths;        // for each shape: its path on the edge, in the frame of each group above it
    std::vector<double> part_paths;   // the same for the parts that were computed last
    double rounding = 0.0;            // [m] bound of the rounding errors of the place of a point, relative to the root
  };
  /// Half of a part of an edge: where the robot is in the middle of the part, and how far it is to both ends.
  struct HalfPart {
    const std::vector<FourPoses>& groups;
    const std::vector<FourShapes>& placed;  ///< boxes of the shapes, relative to `origin`
    const Eigen::Vector3d& origin;
    std::size_t lane;
    double length;  ///< as a part of the edge
  };
  /// Computes the bounds for an edge [m].
  /// @param from, to     value of each variable at both ends of the edge, in this lane
  /// @param difference   how much each variable changes; a joint without limits may turn less than to - from
  /// @param memory       receives the bounds for the path of each shape
  /// @returns the largest bound, of a path in the world or of the change of a distance
  float find(const std::vector<FourDoubles>& from, const std::vector<FourDoubles>& to,
             const std::vector<FourDoubles>& difference, std::size_t lane, Memory& memory) const;
  /// Computes how far a point of a shape can be from where it is in the middle of a part, in the frames of all groups
  /// above the shape. The bound is smaller than the same share of find(), because it uses how far the axes of the
  /// joints are in the middle. Why this suffices: let T be the motion of a joint and x the way of a point in the frame
  /// of the joint. Then |T(t) x(t) - T(m) x(m)| <= |x(t) - x(m)| + |T(t) x(m) - T(m) x(m)|, and the last term is about
  /// x(m).
  /// @param memory  has the result of find() for this edge
  void findPart(std::size_t shape, const HalfPart& part, Memory& memory) const;
  /// Returns the result of findPart() for the world [m].
  float reachOf(std::size_t shape, const Memory& memory) const;
  /// Returns by how much the distance of two shapes can change [m], from the results of findPart() for both shapes.
  /// @param pair  index into RobotShapes::selfPairs()
  float reachOfPair(std::size_t pair, const Memory& memory) const;

 private:
  struct Group {
    std::uint32_t depth;  // number of joints between the group and the root
    double from_parent;   // [m] distance of its origin from the origin of its parent, at 0
    double from_axis;     // [m] distance of its origin from the axis of its parent, at 0
  };
  struct Extent {
    double from_origin,
        from_axis;  // [m] largest distances of a point of the shape from the origin and axis of its group
  };
  void findTravels(const std::vector<FourDoubles>& from, const std::vector<FourDoubles>& difference, std::size_t lane,
                   std::vector<JointTravel>& joints) const;
  double largestAngle(const std::vector<FourDoubles>& values, std::size_t lane) const;
  double sumOf(std::size_t pair, const std::vector<double>& paths) const;
  double findPaths(std::size_t shape, const std::vector<JointTravel>& joints, double* paths) const;

  const Kinematics kinematics_;
  const RobotShapes& robot_;
  std::vector<Group> groups_;
  std::vector<Extent> extents_;              // for each shape
  std::vector<std::uint32_t> common_depth_;  // for each pair: depth of the deepest group that moves both shapes
  std::size_t depths_ = 1;                   // number of different depths
};

}  // namespace hgrid
