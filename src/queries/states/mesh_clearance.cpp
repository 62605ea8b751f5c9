// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/mesh_clearance.h"

namespace hgrid {

MeshClearance::MeshClearance(const BodyShape& shape)
    : mesh_(dynamic_cast<const MeshSolid*>(shape.solid.get())),
      center_(inDouble(boxOf(shape.shape, Pose::Identity(), shape.padding, Eigen::Vector3d::Zero())).center()),
      padding_(roundedUp(shape.padding)) {
  if (mesh_ != nullptr && !mesh_->enclosure().simple()) mesh_ = nullptr;
}

unsigned MeshClearance::farther(const FourShapes& mesh, const FourShapes& other, const SphereCover& cover,
                                const Four& reach, unsigned lanes) const {
  const DistanceLattice* const lattice = mesh_ == nullptr ? nullptr : mesh_->lattice();
  if (lattice == nullptr) return 0;
  const auto per_edge = static_cast<float>(1.0 / lattice->edge());
  const Eigen::Vector3d shift = (center_ - lattice->corner()) / lattice->edge();
  Four way[3], size = allFour(1.0f + static_cast<float>(shift.lpNorm<1>()) + cover.whole * per_edge);
  for (std::size_t k = 0; k < 3; ++k) {
    way[k] = other.box.center[k] - mesh.box.center[k];
    size += (absolute(other.box.center[k]) + absolute(mesh.box.center[k])) * per_edge;
  }
  Four center[3];
  for (std::size_t row = 0; row < 3; ++row) {  // the axes of the box around the mesh are those of its frame
    center[row] = dotOf(mesh.box.axes[row], way) * per_edge + static_cast<float>(shift[static_cast<Eigen::Index>(row)]);
  }
  const auto axis = [&](std::size_t i, std::size_t row) {
    return dotOf(mesh.box.axes[row], other.box.axes[cover.axis[i]]) * per_edge;
  };
  const Four more = (reach + allFour(padding_) + mesh.rounding + other.rounding) * per_edge + size * kPointRounding;
  return coverIsFarther(cover, center, axis, per_edge, more, lanes,
                        [lattice](const Four(&points)[3]) { return lattice->lowerBounds(points); });
}

}  // namespace hgrid
