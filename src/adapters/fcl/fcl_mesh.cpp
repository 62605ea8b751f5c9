// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/fcl/fcl_mesh.h"

#include "hgrid_proximity/refusal.h"

namespace hgrid {

FclMesh::FclMesh(const std::shared_ptr<const TriangleMesh>& source) : source_(source), enclosure_(*source) {
  model_.beginModel(static_cast<int>(source->triangles.size()), static_cast<int>(3 * source->triangles.size()));
  for (const auto& triangle : source->triangles) {
    const Eigen::Vector3d &a = source->vertices[triangle[0]], &b = source->vertices[triangle[1]],
                          &c = source->vertices[triangle[2]];
    if ((b - a).cross(c - a).squaredNorm() > 0.0)
      model_.addTriangle(a, b, c);  // FCL divides by the area, so it must not be 0
  }
  model_.endModel();
  if (model_.num_tris == 0)
    throw Refusal(Code::bad_geometry, "mesh: none of its triangles has an area; at least one must have an area");
}

CoreGap FclMesh::gapTo(const ConvexCore& core, const fcl::OBBRSSd& core_volume, const Pose& mesh_from_core,
                       double up_to) const {
  CoreGap best;
  best.lower = best.upper = up_to;
  visit(0, 0.0, core, core_volume, mesh_from_core, best);
  if (best.upper == up_to) best.lower = best.upper = std::numeric_limits<double>::infinity();
  return best;
}

std::array<Eigen::Vector3d, 3> FclMesh::triangle(const fcl::BVNode<fcl::OBBRSSd>& leaf) const {
  const fcl::Triangle& corners = model_.tri_indices[leaf.primitiveId()];
  return {model_.vertices[corners[0]], model_.vertices[corners[1]], model_.vertices[corners[2]]};
}

/// Searches the nearer child first, since its result may make the other child unnecessary.
/// @param bound  [m] lower bound of the distance to all triangles below this node
void FclMesh::visit(int node, double bound, const ConvexCore& core, const fcl::OBBRSSd& core_volume,
                    const Pose& mesh_from_core, CoreGap& best) const {
  if (bound >= best.upper || best.lower <= 0.0) return;
  const auto& here = model_.getBV(node);
  if (here.isLeaf()) {
    const auto corners = triangle(here);
    const CoreGap gap = gapOf(ConvexCore::hull(corners.data(), corners.size()), core, mesh_from_core, best.upper);
    if (gap.lower <= 0.0 || gap.upper < best.upper) best = gap;
    return;
  }
  const auto boundOf = [&](int child) {
    return fcl::distance(mesh_from_core.linear(), mesh_from_core.translation(), model_.getBV(child).bv, core_volume);
  };
  const int left = here.leftChild(), right = here.rightChild();
  const double left_bound = boundOf(left), right_bound = boundOf(right);
  const bool left_first = left_bound <= right_bound;
  visit(left_first ? left : right, left_first ? left_bound : right_bound, core, core_volume, mesh_from_core, best);
  visit(left_first ? right : left, left_first ? right_bound : left_bound, core, core_volume, mesh_from_core, best);
}

bool FclMesh::meetings(const ConvexCore& core, const fcl::OBBRSSd& core_volume, const Pose& mesh_from_core,
                       double reach, const Met& met) const {
  std::vector<int> nodes{0};
  while (!nodes.empty()) {
    const auto& here = model_.getBV(nodes.back());
    nodes.pop_back();
    if (fcl::distance(mesh_from_core.linear(), mesh_from_core.translation(), here.bv, core_volume) > reach) continue;
    if (here.isLeaf()) {
      const auto corners = triangle(here);
      const CoreGap gap = gapOf(ConvexCore::hull(corners.data(), corners.size()), core, mesh_from_core, reach);
      if (!(gap.lower > reach) && !met(gap)) return false;
    } else {
      nodes.insert(nodes.end(), {here.rightChild(), here.leftChild()});
    }
  }
  return true;
}

bool FclMesh::meetings(const FclMesh& other, const Pose& mesh_from_other, double reach, const Met& met) const {
  std::vector<std::pair<int, int>> nodes{{0, 0}};
  while (!nodes.empty()) {
    const auto [mine, theirs] = nodes.back();
    nodes.pop_back();
    const auto &a = model_.getBV(mine), &b = other.model_.getBV(theirs);
    if (fcl::distance(mesh_from_other.linear(), mesh_from_other.translation(), a.bv, b.bv) > reach) continue;
    if (a.isLeaf() && b.isLeaf()) {
      const auto my_corners = triangle(a), their_corners = other.triangle(b);
      const CoreGap gap = gapOf(ConvexCore::hull(my_corners.data(), my_corners.size()),
                                ConvexCore::hull(their_corners.data(), their_corners.size()), mesh_from_other, reach);
      if (!(gap.lower > reach) && !met(gap)) return false;
    } else if (b.isLeaf() || (!a.isLeaf() && a.bv.size() > b.bv.size())) {
      nodes.insert(nodes.end(), {{a.rightChild(), theirs}, {a.leftChild(), theirs}});
    } else {
      nodes.insert(nodes.end(), {{mine, b.rightChild()}, {mine, b.leftChild()}});
    }
  }
  return true;
}

}  // namespace hgrid
