// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <vector>

#include "narrow/winding_tree.h"

namespace hgrid {

/// The triangles of a mesh, sorted by whether their directions tell which side of the surface is inside.
///
/// Some programs write each face twice, once for each side, or turn some faces around. A patch is a set of faces that
/// are connected by edges with exactly two faces. Two triangles with the same three corners are one face.
struct FaceDirections {
  /// The triangles of patches whose faces agree, with the directions that the file gives them. Also those of patches
  /// that have no sides: one-sided surfaces (Moebius), and open sheets all of whose faces are given for both sides.
  std::vector<WindingTree::Corners> given;
  /// All other faces, each once. The faces of a patch agree. Those of a closed patch face outward; those of an open
  /// patch have the direction that more of its area was given.
  std::vector<WindingTree::Corners> corrected;
  /// Whether all patches are closed surfaces with two sides, and those of `given` face the same way, all outward or all
  /// inward. Then a point that the triangles wind around 0 times is outside.
  bool simple = true;
};

/// @param triangles  numbers of vertices; equal positions have equal numbers, and no triangle has two equal corners
FaceDirections faceDirections(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<WindingTree::Corners>& triangles);

}  // namespace hgrid
