// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "adapters/fcl_mesh.h"

#include <array>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

FclMesh::FclMesh(const std::shared_ptr<const TriangleMesh>& source) : source_(source), enclosure_(*source) {
  model_.beginModel(static_cast<int>(source->triangles.size()), static_cast<int>(3 * source->triangles.size()));
  for (const auto& triangle : source->triangles) {
    const Eigen::Vector3d &a = source->vertices[triangle[0]], &b = source->vertices[triangle[1]],
                          &c = source->vertices[triangle[2]];
    if ((b - a).cross(c - a).squaredNorm() > 0.0) model_.addTriangle(a, b, c);  // FCL divides by the area
  }
  model_.endModel();
  if (model_.num_tris == 0) throw Refusal(Code::bad_geometry, "mesh: none of its triangles has an area");
}

CoreGap FclMesh::gapTo(const ConvexCore& core, const fcl::OBBRSSd& core_volume, const Pose& mesh_from_core,
                       double up_to) const {
  CoreGap best;
  best.lower = best.upper = up_to;
  visit(0, 0.0, core, core_volume, mesh_from_core, best);
  if (best.upper == up_to) best.lower = best.upper = std::numeric_limits<double>::infinity();
  return best;
}

/// The nearer child first: what it gives may spare the other. @param bound  [m] no triangle below is nearer
void FclMesh::visit(int node, double bound, const ConvexCore& core, const fcl::OBBRSSd& core_volume,
                    const Pose& mesh_from_core, CoreGap& best) const {
  if (bound >= best.upper || best.lower <= 0.0) return;
  const auto& here = model_.getBV(node);
  if (here.isLeaf()) {
    const fcl::Triangle& triangle = model_.tri_indices[here.primitiveId()];
    const std::array<Eigen::Vector3d, 3> corners{model_.vertices[triangle[0]], model_.vertices[triangle[1]],
                                                 model_.vertices[triangle[2]]};
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

}  // namespace hgrid
