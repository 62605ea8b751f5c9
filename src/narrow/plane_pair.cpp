// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/plane_pair.h"

#include <algorithm>
#include <limits>

#include "narrow/convex_pair.h"
#include "narrow/mesh_solid.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

/// Returns the corner of a triangle with the smallest z in the frame of the plane.
Vector lowest(const Triangle& triangle, const Pose& plane_from_mesh) {
  Vector result = plane_from_mesh * triangle[0];
  for (const std::size_t i : {1, 2}) {
    const Vector corner = plane_from_mesh * triangle[i];
    if (corner.z() < result.z()) result = corner;
  }
  return result;
}

/// Returns the point of the core of a convex solid or of a mesh with the smallest z in the frame of the plane.
Vector lowestPoint(const OrderedSolid& other, const Pose& plane_from_other) {
  if (other.kind() != ShapeKind::mesh) {
    const Vector down = -plane_from_other.linear().row(2).transpose();
    return plane_from_other * static_cast<const ConvexSolid&>(other).core().support(down);
  }
  Vector result = Vector::Constant(std::numeric_limits<double>::infinity());
  for (const Triangle& triangle : static_cast<const MeshSolid&>(other).tree().triangles()) {
    const Vector corner = lowest(triangle, plane_from_other);
    if (corner.z() < result.z()) result = corner;
  }
  return result;
}

/// Returns the contact of the padded plane with a part of the other solid whose core has this lowest point.
Contact contactAt(const Side& plane, const Side& other, const Vector& point) {
  const double depth = std::max(0.0, plane.around + other.around - point.z());
  Contact contact;
  contact.normal = Vector::UnitZ();
  contact.depth = depth;
  // The middle of the overlap, but not above the core's lowest point: the core may be thin and tilted there.
  contact.point = {point.x(), point.y(), std::min(point.z(), plane.around - 0.5 * depth)};
  return contact;
}

/// Bound [m] of the rounding errors of a distance from a plane.
double roundingOf(const Side& plane, const Side& other, const Pose& plane_from_other) {
  return gapRounding(other.solid.reach() + plane_from_other.translation().norm() + plane.around + other.around);
}

}  // namespace

Proximity measurePlane(const Side& plane, const Side& other, double up_to) {
  const Pose plane_from_other = relativePose(plane, other);
  const double around = plane.around + other.around;
  if (!plane_from_other.matrix().allFinite() || !(around >= 0.0)) return answerOf(Measure::failed, 0.0);
  if (other.solid.kind() == ShapeKind::plane) return answerOf(Measure::contact, 0.0);
  const double rounding = roundingOf(plane, other, plane_from_other);
  const double infinity = std::numeric_limits<double>::infinity();
  if (plane_from_other.translation().z() - other.solid.reach() - around - rounding > up_to) {
    return answerOf(Measure::apart, infinity);
  }
  const Vector point = lowestPoint(other.solid, plane_from_other);
  const double distance = point.z() - around, lower = distance - rounding;
  if (lower > up_to) return answerOf(Measure::apart, infinity);
  Proximity result = answerOf(Measure::contact, 0.0);
  if (lower > 0.0) {
    result = answerOf(Measure::apart, distance > up_to ? infinity : distance);
    result.lower_bound = lower;
    if (distance > up_to) return result;  // by less than the error of the measurement
  } else {
    result.depth = -lower;
  }
  result.normal = Vector::UnitZ();
  result.on_first = {point.x(), point.y(), plane.around};
  result.on_second = {point.x(), point.y(), point.z() - other.around};
  return result;
}

Contact contactOfPlane(const Side& plane, const Side& other) {
  if (other.solid.kind() == ShapeKind::plane) return {};
  return contactAt(plane, other, lowestPoint(other.solid, relativePose(plane, other)));
}

std::vector<Contact> contactsOfPlane(const Side& plane, const Side& other, std::size_t most) {
  const Proximity found = most > 0 ? measurePlane(plane, other, kTouchingGap) : Proximity{};
  if (found.status == Measure::failed) hasContacts(found.status);  // throws
  if (!(found.distance <= kTouchingGap)) return {};
  if (other.solid.kind() == ShapeKind::plane) return {Contact{}};
  const Pose plane_from_other = relativePose(plane, other);
  if (other.solid.kind() != ShapeKind::mesh) {
    return {contactOfPlane(plane, other)};
  }
  std::vector<Contact> contacts;
  const double highest = plane.around + other.around + kTouchingGap + roundingOf(plane, other, plane_from_other);
  for (const Triangle& triangle : static_cast<const MeshSolid&>(other.solid).tree().triangles()) {
    const Vector corner = lowest(triangle, plane_from_other);
    if (corner.z() > highest) continue;
    contacts.push_back(contactAt(plane, other, corner));
    if (contacts.size() == most) break;
  }
  return contacts;
}

}  // namespace hgrid
