// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <ccd/ccd.h>

#include <cmath>

#include "bench/exactness/exactness_peer.h"

namespace hgrid {
namespace bench {
namespace {

/// A shape as libccd sees it: its users write the support functions.
struct CcdShape {
  const Shape& shape;
  const Pose& world_from_shape;
  std::vector<double> size = shape.dimensions();

  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;
  Eigen::Vector3d center() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    if (!shape.mesh()) return sum;
    for (const Eigen::Vector3d& vertex : shape.mesh()->vertices) sum += vertex;
    return sum / double(shape.mesh()->vertices.size());
  }
};

/// Returns the point of the shape that is farthest in a direction, both in the frame of the shape.
Eigen::Vector3d CcdShape::support(const Eigen::Vector3d& direction) const {
  const double across = std::hypot(direction.x(), direction.y()), sign = direction.z() < 0.0 ? -1.0 : 1.0;
  const auto disc = [&](double radius, double z) {
    const double scale = across > 0.0 ? radius / across : 0.0;
    return Eigen::Vector3d(scale * direction.x(), scale * direction.y(), z);
  };
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return size[0] * direction.normalized();
    case ShapeKind::box:
      return 0.5 * Eigen::Vector3d(std::copysign(size[0], direction.x()), std::copysign(size[1], direction.y()),
                                   std::copysign(size[2], direction.z()));
    case ShapeKind::cylinder:
      return disc(size[1], 0.5 * sign * size[0]);
    case ShapeKind::cone:
      return size[0] * direction.z() > size[1] * across ? disc(0.0, 0.5 * size[0]) : disc(size[1], -0.5 * size[0]);
    case ShapeKind::capsule:
      return size[1] * direction.normalized() + 0.5 * sign * size[0] * Eigen::Vector3d::UnitZ();
    default: {
      const Eigen::Vector3d* farthest = nullptr;
      for (const Eigen::Vector3d& vertex : shape.mesh()->vertices) {
        if (!farthest || vertex.dot(direction) > farthest->dot(direction)) farthest = &vertex;
      }
      return *farthest;
    }
  }
}

const CcdShape& shapeOf(const void* object) { return *static_cast<const CcdShape*>(object); }

void writePoint(const CcdShape& shape, const Eigen::Vector3d& point, ccd_vec3_t* to) {
  const Eigen::Vector3d in_world = shape.world_from_shape * point;
  ccdVec3Set(to, in_world.x(), in_world.y(), in_world.z());
}

void writeSupport(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* point) {
  const CcdShape& shape = shapeOf(object);
  const Eigen::Vector3d in_world(direction->v[0], direction->v[1], direction->v[2]);
  writePoint(shape, shape.support(shape.world_from_shape.linear().transpose() * in_world), point);
}

void writeCenter(const void* object, ccd_vec3_t* point) {
  writePoint(shapeOf(object), shapeOf(object).center(), point);
}

/// libccd 2.1 has no distance. By default its tolerances are 1e-4 m, and its steps are not limited. With a smaller
/// tolerance than this one, some searches of EPA never end.
ccd_t settings(double size) {
  ccd_t ccd;
  CCD_INIT(&ccd);
  ccd.support1 = ccd.support2 = writeSupport;
  ccd.center1 = ccd.center2 = writeCenter;
  ccd.max_iterations = 500;
  ccd.epa_tolerance = 1e-10 * size;
  ccd.mpr_tolerance = 1e-16 * size;
  return ccd;
}

template <class Touch, class Penetration>
ExactnessAnswer measure(const test::Case& placed, const Touch& touch, const Penetration& penetration) {
  const CcdShape first{placed.first_shape, placed.world_from_first},
      second{placed.second_shape, placed.world_from_second};
  const ccd_t ccd = settings(placed.first_shape.reach() + placed.second_shape.reach());
  ExactnessAnswer answer;
  answer.given = true;
  answer.touches = touch(&first, &second, &ccd) != 0;
  ccd_vec3_t direction, position;
  if (answer.touches && penetration(&first, &second, &ccd, &answer.depth, &direction, &position) == 0) {
    answer.normal = {direction.v[0], direction.v[1], direction.v[2]};
  }
  return answer;
}

}  // namespace

ExactnessAnswer measureWithCcdGjk(const test::Case& placed) {
  return measure(placed, ccdGJKIntersect, ccdGJKPenetration);
}
ExactnessAnswer measureWithCcdMpr(const test::Case& placed) {
  return measure(placed, ccdMPRIntersect, ccdMPRPenetration);
}

}  // namespace bench
}  // namespace hgrid
