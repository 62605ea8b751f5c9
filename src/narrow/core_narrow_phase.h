// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <vector>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "narrow/convex_pair.h"
#include "narrow/mesh_solid.h"
#include "narrow/plane_pair.h"

namespace hgrid {

/// The narrow phase of the core.
class CoreNarrowPhase final : public OrderedNarrowPhase {
 public:
  std::shared_ptr<const Solid> solidOf(const Shape& shape) final;
  std::shared_ptr<const Solid> point() const final { return point_; }
  std::shared_ptr<const Solid> plane() const final { return plane_; }
  std::shared_ptr<const Solid> needle(double length) const final;
  std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const final;

 private:
  Proximity measureInOrder(const Side& a, const Side& b, double up_to) const final;
  Contact measureContactInOrder(const Side& a, const Side& b) const final;
  std::vector<Contact> contactsInOrder(const Side& a, const Side& b, std::size_t most) const final;

  const std::shared_ptr<const Solid> point_ = std::make_shared<ConvexSolid>(ConvexCore::point(), std::vector<double>{});
  const std::shared_ptr<const Solid> plane_ = std::make_shared<PlaneSolid>();
  PreparedMeshes meshes_;
};

}  // namespace hgrid
