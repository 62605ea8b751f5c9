// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/mesh_pair.h"

#include <algorithm>
#include <cmath>

#include "narrow/convex_pair.h"
#include "narrow/mesh_solid.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

// [m] To check a depth, a solid is moved by the depth and this length. Then the two must be apart.
constexpr double kAfterMove = 1e-6;

bool isMesh(const Side& side) { return side.solid.kind() == ShapeKind::mesh; }
const MeshSolid& meshOf(const Side& side) { return static_cast<const MeshSolid&>(side.solid); }
const ConvexSolid& convexOf(const Side& side) { return static_cast<const ConvexSolid&>(side.solid); }

/// Returns the gap of a mesh and another solid, in the frame of the mesh. It is infinite if the two are farther apart
/// than `up_to` [m], by more than kTouchingGap.
CoreGap gapOfMesh(const Side& mesh, const Side& other, const Pose& mesh_from_other, double up_to) {
  const MeshTree& tree = meshOf(mesh).tree();
  const GapLimits limits = limitsOf(mesh, other, up_to);
  return isMesh(other) ? tree.gapTo(meshOf(other).tree(), mesh_from_other, limits)
                       : tree.gapTo(convexOf(other), mesh_from_other, limits);
}

/// Whether the core of one solid is inside the other, and a point of the inner core.
struct Enclosed {
  Measure status = Measure::apart;
  Vector point = Vector::Zero();
  double crossing = 0.0;  // [m] if the gap of the cores is at most this, the surfaces of the solids touch or cross
};

/// Calls ask(begin, end) with some points of each part of the solid, until one call returns true.
/// @returns whether a call returned true
template <class Ask>
bool anyPart(const Side& side, const Ask& ask) {
  if (!isMesh(side)) return ask(&convexOf(side).somePoint(), &convexOf(side).somePoint() + 1);
  const std::vector<Enclosure::Part>& parts = meshOf(side).enclosure().parts();
  return std::any_of(parts.begin(), parts.end(),
                     [&](const Enclosure::Part& part) { return ask(part.data(), part.data() + part.size()); });
}

/// Returns whether a part of `inner` is inside `outer`, and a point of this part in the frame of `outer`. The surfaces
/// of the two cores must be apart.
Enclosed enclosedBy(const Side& outer, const Side& inner, const Pose& outer_from_inner) {
  Enclosed result;
  result.crossing = inner.around - outer.around;  // the padding of the outer solid moves its surface away
  if (!isMesh(outer)) return result;              // the gap to a filled convex solid would have been 0
  const Enclosure& enclosure = meshOf(outer).enclosure();
  anyPart(inner, [&](const Vector* begin, const Vector* end) {
    const auto in_box = [&](const Vector& point) { return enclosure.boxHolds(outer_from_inner * point); };
    result.point = outer_from_inner * *begin;
    if (!std::all_of(begin, end, in_box)) return false;
    const DistanceLattice* const lattice = meshOf(outer).lattice();
    if (lattice != nullptr && lattice->isOutside(result.point)) return false;
    const Inside inside = enclosure.holds(result.point);
    if (inside == Inside::yes) result.status = Measure::contained;
    if (inside == Inside::unknown) result.status = Measure::containment_unknown;
    return inside != Inside::no;
  });
  return result;
}

/// Returns whether either solid is inside the other. The point is in the frame of the first solid.
Enclosed enclosed(const Side& a, const Side& b, const Pose& a_from_b) {
  const Enclosed second = enclosedBy(a, b, a_from_b);
  if (second.status != Measure::apart) return second;
  Enclosed first = enclosedBy(b, a, a_from_b.inverse());
  first.point = a_from_b * first.point;
  return first;
}

bool isPoint(const Side& side) { return !isMesh(side) && side.around == 0.0 && side.solid.reach() == 0.0; }

/// Sets depth and normal of a point inside a mesh, if its surface was found within `up_to` [m].
void describeDepth(const Side& mesh, const CoreGap& gap, double up_to, Proximity& result) {
  if (!(gap.upper <= up_to)) return;
  const Vector outward = gap.on_first - gap.on_second;
  result.depth = gap.upper + mesh.around;
  result.normal = outward / outward.norm();
}

}  // namespace

Proximity measureMesh(const Side& mesh, const Side& other, double up_to) {
  const Pose mesh_from_other = relativePose(mesh, other);
  if (const auto answer = answerByReach(mesh, other, mesh_from_other, up_to)) return *answer;
  const CoreGap gap = gapOfMesh(mesh, other, mesh_from_other, up_to);
  if (std::isnan(gap.lower) || std::isnan(gap.upper)) return answerOf(Measure::failed, 0.0);
  if (gap.lower <= 0.0) return answerOf(Measure::contact, 0.0);
  const Enclosed inside = enclosed(mesh, other, mesh_from_other);
  if (inside.status != Measure::apart) {
    Proximity result = answerOf(gap.lower > inside.crossing ? inside.status : Measure::contact, 0.0);
    if (result.status == Measure::contained && isPoint(other)) describeDepth(mesh, gap, up_to, result);
    return result;
  }
  Proximity result = answerByGap(mesh, other, mesh_from_other, gap, up_to);
  if (result.status == Measure::contact && isPoint(other) && !result.normal.hasNaN()) {
    result.depth = std::max(0.0, mesh.around - gap.upper);
  }
  return result;
}

Contact contactOfMesh(const Side& mesh, const Side& other) {
  const Pose mesh_from_other = relativePose(mesh, other);
  const double around = mesh.around + other.around;
  const CoreGap gap = gapOfMesh(mesh, other, mesh_from_other, 0.0);
  if (gap.lower > around) {  // otherwise the surfaces have points in common, also if one is inside the other
    const Enclosed inside = enclosed(mesh, other, mesh_from_other);
    if (inside.status != Measure::apart) {
      Contact contact;
      contact.point = inside.point;
      return contact;
    }
  }
  Contact contact = contactByGap(mesh, other, gap);
  // The move separates the two nearest parts. Other parts may be in its way.
  Pose moved = other.world_from_shape;
  moved.translation() += (contact.depth + kAfterMove) * (mesh.world_from_shape.linear() * contact.normal);
  const double padding = other.around - other.solid.radius();
  if (gap.lower > 0.0 && measureMesh(mesh, Side({other.solid, moved, padding}), 0.0).status == Measure::apart) {
    return contact;
  }
  contact.normal.setConstant(Proximity::kUnknown);
  contact.depth = Proximity::kUnknown;
  return contact;
}

std::vector<Contact> contactsOfMesh(const Side& mesh, const Side& other, std::size_t most) {
  const Measure status = most > 0 ? measureMesh(mesh, other, 0.0).status : Measure::not_measured;
  if (!hasContacts(status)) return {};
  const Pose mesh_from_other = relativePose(mesh, other);
  const GapLimits limits = limitsOf(mesh, other, 0.0);
  std::vector<Contact> contacts;
  const auto met = [&](const CoreGap& gap) {
    contacts.push_back(contactByGap(mesh, other, gap));
    return contacts.size() < most;
  };
  if (isMesh(other)) {
    meshOf(mesh).tree().meetings(meshOf(other).tree(), mesh_from_other, limits, met);
  } else {
    meshOf(mesh).tree().meetings(convexOf(other), mesh_from_other, limits, met);
  }
  if (!contacts.empty()) return contacts;
  const Enclosed inside = enclosed(mesh, other, mesh_from_other);
  if (inside.status != Measure::apart) {
    contacts.emplace_back();
    contacts.back().point = inside.point;
  }
  return contacts;
}

}  // namespace hgrid
