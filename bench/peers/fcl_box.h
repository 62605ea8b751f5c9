// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision_object.h>

#include <memory>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// An FCL object that has only an AABB. FCL uses this AABB unchanged.
class FclBox : public fcl::CollisionObject<double> {
 public:
  FclBox(ProxyId id, const Aabb& box) : CollisionObject(sharedGeometry()), id_(id) { setBox(box); }

  void setBox(const Aabb& box) {
    aabb.min_ = box.min.cast<double>();
    aabb.max_ = box.max.cast<double>();
  }
  ProxyId id() const { return id_; }

 private:
  /// Returns a geometry that all objects share. FCL's managers read its type, but nothing else.
  static const std::shared_ptr<fcl::CollisionGeometry<double>>& sharedGeometry() {
    static const std::shared_ptr<fcl::CollisionGeometry<double>> sphere = std::make_shared<fcl::Sphere<double>>(1.0);
    return sphere;
  }

  ProxyId id_;
};

}  // namespace bench
}  // namespace hgrid
