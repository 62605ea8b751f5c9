// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/narrow/convex_narrow_phase.h"

#include "narrow/convex_pair.h"

namespace hgrid {
namespace {

class ConvexNarrowPhase final : public OrderedNarrowPhase {
 public:
  std::shared_ptr<const Solid> solidOf(const Shape& shape) override {
    if (shape.kind() == ShapeKind::mesh) return nullptr;
    return std::make_shared<ConvexSolid>(shape);
  }
  std::shared_ptr<const Solid> point() const override { return point_; }
  std::shared_ptr<const Solid> needle(double length) const override {
    return std::make_shared<ConvexSolid>(ConvexCore::segment(length), std::vector<double>{length});
  }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const override {
    return std::make_shared<ConvexSolid>(ConvexCore::box(size), std::vector<double>{size.x(), size.y(), size.z()});
  }

 protected:
  Proximity measureInOrder(const Side& a, const Side& b, double up_to) const override {
    return measureConvex(a, b, up_to, noOverlap);
  }
  std::vector<Contact> contactsInOrder(const Side& a, const Side& b, std::size_t most) const override {
    return contactsOfConvex(a, b, most, noOverlap);
  }

 private:
  const std::shared_ptr<const Solid> point_ = std::make_shared<ConvexSolid>(ConvexCore::point(), std::vector<double>{});
};

}  // namespace

std::shared_ptr<NarrowPhase> makeConvexNarrowPhase() { return std::make_shared<ConvexNarrowPhase>(); }

}  // namespace hgrid
