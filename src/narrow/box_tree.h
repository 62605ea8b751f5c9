// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/four_lanes.h"
#include "narrow/triangle_gap.h"

namespace hgrid {

/// A node with up to four children. Each child is another node or a triangle, and has an oriented box. The boxes are
/// floats, and one vector holds the same number of all four boxes.
struct BoxNode {
  Four axes[3][3];        // axes[i][k]: component k of axis i of the boxes, shortest sides first
  Four center[3];         // [m] centers of the boxes, relative to BoxTree::center
  Four half[3];           // [m] half of the lengths of the boxes along their axes
  std::int32_t child[4];  // >= 0: number of a node; < 0: ~number of a triangle
  std::int32_t count;     // number of children
};

/// Sets the next child of a node.
/// @param axes  the rows are the axes of its box
/// @param low   [m] smallest coordinates along the axes, relative to BoxTree::center
/// @param high  [m] largest coordinates
void addChild(BoxNode& node, const Eigen::Matrix3d& axes, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
              std::int32_t child);

/// A tree of oriented boxes over triangles (Gottschalk, Lin, Manocha 1996). The box of a node fits the triangles of the
/// node, so it is thin where the surface is nearly flat.
struct BoxTree {
  /// No path from the root to a triangle has more nodes than this. Each child has at most 9/16 of the triangles of its
  /// node, rounded up.
  static constexpr std::size_t kMostLevels = 40;

  std::vector<BoxNode> nodes;                        // the first node has one child, the root
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // [m]
  double reach = 0.0;                                // [m] no corner is farther from the center
};

/// Builds the tree of some triangles, at least one. Sorts the triangles, so that near triangles get near numbers.
BoxTree boxTreeOf(std::vector<Triangle>& triangles);

}  // namespace hgrid
