// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "geometry/four_lanes.h"
#include "hgrid_proximity/geometry/pose.h"
#include "narrow/box_tree.h"

namespace hgrid {

/// The convex hull of some triangles. It can prove quickly that it is apart from another hull. Immutable.
///
/// Only its corners are known, not its faces. So all corners are visited to find the farthest point in a direction.
class MeshHull {
 public:
  /// Of more different points, no corners are found, because that would take too long.
  static constexpr std::size_t kMostPoints = 1024;

  /// @param points  [m] the corners of the triangles
  explicit MeshHull(std::vector<Eigen::Vector3d> points);

  /// Returns true only if the two hulls are more than `reach` [m] apart. May return false although they are; always
  /// returns false if a hull has no corners.
  ///
  /// Looks for a direction in which the hulls are apart, in a few steps (Chung and Wang 1996, "Quick collision
  /// detection of polytopes in virtual environments").
  bool isApart(const MeshHull& other, const Pose& this_from_other, double reach) const;

  /// Returns the number of corners.
  std::size_t corners() const { return count_; }

 private:
  /// Four corners, relative to center_ [m].
  struct Block {
    Four x, y, z;
  };

  struct FloatDirection;

  float mostAlong(const Eigen::Vector3d& direction) const;
  Eigen::Vector3d cornerAt(const Eigen::Vector3d& direction, float most) const;

  std::vector<Block> blocks_;  // the last block repeats a corner; empty: the hull is not known
  std::size_t count_ = 0;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();  // [m]
  double center_size_ = 0.0;                          // [m] sum of the sizes of its coordinates
  double radius_ = 0.0;                               // [m] no corner is farther from center_
};

/// Returns for each node of a tree the hull of the triangles below it. Nodes whose children are all triangles, and the
/// first node, which only holds the root, have hulls without corners.
std::vector<MeshHull> hullsOf(const BoxTree& tree, const std::vector<Triangle>& triangles);

}  // namespace hgrid
