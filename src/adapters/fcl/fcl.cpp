// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/fcl.h"

#include <fcl/narrowphase/collision.h>

#include <cmath>
#include <optional>

#include "adapters/fcl/fcl_solid.h"
#include "narrow/core_narrow_phase.h"

namespace hgrid {
namespace {

/// Returns the overlap of two convex cores that FCL finds, or nullopt. Both solids must have been created from shapes.
std::optional<Overlap> overlapByFcl(const ConvexSolid& a, const ConvexSolid& b, const Pose& a_from_b) {
  fcl::CollisionRequestd request;
  request.num_max_contacts = 1;
  request.enable_contact = true;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd found;
  fcl::collide(static_cast<const FclConvexSolid&>(a).geometry(), fcl::Transform3d::Identity(),
               static_cast<const FclConvexSolid&>(b).geometry(), fcl::Transform3d(a_from_b.matrix()), request, found);
  if (!found.isCollision()) return std::nullopt;
  const fcl::Contactd& contact = found.getContact(0);
  const double depth = contact.penetration_depth, length = contact.normal.norm();
  if (!(depth >= 0.0) || !std::isfinite(depth) || !(std::abs(length - 1.0) < 1e-6)) return std::nullopt;
  if (!contact.pos.allFinite()) return std::nullopt;
  return Overlap{depth, contact.normal / length, contact.pos};
}

/// Measures like the narrow phase of the core. For overlapping convex shapes it asks FCL for depth and normal.
class FclNarrowPhase final : public CoreNarrowPhase {
 public:
  FclNarrowPhase() : CoreNarrowPhase(overlapByFcl) {}

 private:
  std::shared_ptr<const Solid> convexSolidOf(const Shape& shape) const override {
    return std::make_shared<FclConvexSolid>(shape);
  }
};

}  // namespace

std::shared_ptr<NarrowPhase> makeFclNarrowPhase() { return std::make_shared<FclNarrowPhase>(); }

}  // namespace hgrid
