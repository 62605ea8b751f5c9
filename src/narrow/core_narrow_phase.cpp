// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/core_narrow_phase.h"

#include <cmath>

#include "narrow/depth_bound.h"
#include "narrow/mesh_pair.h"

namespace hgrid {

std::shared_ptr<const Solid> CoreNarrowPhase::solidOf(const Shape& shape) {
  if (shape.kind() == ShapeKind::plane) return plane_;
  if (shape.kind() == ShapeKind::mesh) return std::make_shared<MeshSolid>(shape, meshes_.of(shape.mesh()));
  return std::make_shared<ConvexSolid>(shape);
}

std::shared_ptr<const Solid> CoreNarrowPhase::needle(double length) const {
  return std::make_shared<ConvexSolid>(ConvexCore::segment(length), std::vector<double>{length});
}

std::shared_ptr<const Solid> CoreNarrowPhase::block(const Eigen::Vector3d& size) const {
  return std::make_shared<ConvexSolid>(ConvexCore::box(size), std::vector<double>{size.x(), size.y(), size.z()});
}

// Planes come first in the order of solids, then meshes. So only `a` needs to be tested.
Proximity CoreNarrowPhase::measureInOrder(const Side& a, const Side& b, double up_to) const {
  if (a.solid.kind() == ShapeKind::plane) return measurePlane(a, b, up_to);
  return a.solid.kind() == ShapeKind::mesh ? measureMesh(a, b, up_to) : measureConvex(a, b, up_to);
}

Contact CoreNarrowPhase::measureContactInOrder(const Side& a, const Side& b) const {
  if (a.solid.kind() == ShapeKind::plane) return contactOfPlane(a, b);
  const bool is_mesh = a.solid.kind() == ShapeKind::mesh;
  Contact contact = is_mesh ? contactOfMesh(a, b) : contactOfConvex(a, b);
  if (std::isnan(contact.depth)) boundDepth(a, b, contact);
  return contact;
}

std::vector<Contact> CoreNarrowPhase::contactsInOrder(const Side& a, const Side& b, std::size_t most) const {
  if (a.solid.kind() == ShapeKind::plane) return contactsOfPlane(a, b, most);
  return a.solid.kind() == ShapeKind::mesh ? contactsOfMesh(a, b, most) : contactsOfConvex(a, b, most);
}

std::shared_ptr<NarrowPhase> makeCoreNarrowPhase() { return std::make_shared<CoreNarrowPhase>(); }

}  // namespace hgrid
