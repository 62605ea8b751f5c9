// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/four_lanes.h"
#include "narrow/gjk.h"
#include "narrow/triangle_gap.h"

namespace hgrid {

/// A tree of boxes over the triangles of a mesh, for exact distances. Immutable.
///
/// Each node has up to four children. Their boxes are oriented along axes that fit the triangles of the node. The boxes
/// are stored as floats and rounded outward; distances of triangles are computed in double.
class MeshTree {
 public:
  /// @param mesh  must have at least one triangle
  explicit MeshTree(const TriangleMesh& mesh);

  /// Returns the gap between the triangles and a convex core, with points in the frame of the mesh. It is infinite if
  /// it is larger than `up_to` [m].
  CoreGap gapTo(const ConvexCore& core, const Pose& mesh_from_core, double up_to) const;
  /// Returns the gap between the triangles of two meshes, in the same way.
  CoreGap gapTo(const MeshTree& other, const Pose& mesh_from_other, double up_to) const;

  /// Receives the gap of two parts, in the frame of this mesh. @returns whether the search should continue
  using Met = std::function<bool(const CoreGap&)>;
  /// Calls `met` for each triangle that is within `reach` [m] of the core. @returns false if a call returned false
  bool meetings(const ConvexCore& core, const Pose& mesh_from_core, double reach, const Met& met) const;
  /// Calls `met` for each triangle of this mesh and each triangle of the other mesh that are within `reach` [m] of each
  /// other. @returns false if a call returned false
  bool meetings(const MeshTree& other, const Pose& mesh_from_other, double reach, const Met& met) const;

  /// A node with up to four children. Each child is another node or a triangle, in an oriented box.
  struct Node {
    Four axes[3][3];        // axes[i][k]: component k of axis i of the boxes
    Four center[3];         // [m] centers of the boxes, relative to the center of the tree
    Four half[3];           // [m] half of the lengths of the boxes along their axes
    std::int32_t child[4];  // >= 0: number of a node; < 0: ~number of a triangle
    std::int32_t count;     // number of children
  };
  /// A tree as the search sees it. The first node has one child, the root.
  struct Boxes {
    const Node* nodes;
    Eigen::Vector3d center;  // [m] origin of the boxes
    double reach;            // [m] no point is farther from the center
  };

 private:
  class Builder;

  Boxes boxes() const { return {nodes_.data(), center_, reach_}; }

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  Eigen::Vector3d center_;
  double reach_ = 0.0;
};

}  // namespace hgrid
