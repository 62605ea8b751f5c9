// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/fcl.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include "adapters/fcl/fcl_solid.h"
#include "narrow/convex_pair.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kTolerance = 1e-10;   // [m] tolerance for FCL's iterations
constexpr double kMaybeInside = 0.25;  // an open mesh may enclose a point with at least this winding number

bool isMesh(const Side& side) { return side.solid.kind() == ShapeKind::mesh; }
const FclMesh& meshOf(const Side& side) { return static_cast<const FclMeshSolid&>(side.solid).mesh(); }
const FclConvexSolid& convexOf(const Side& side) { return static_cast<const FclConvexSolid&>(side.solid); }

/// Returns the gap of two meshes, in the frame of the first. FCL measures it, since its distance of two triangles is
/// correct.
CoreGap gapOfMeshes(const FclMesh& a, const FclMesh& b, const Pose& a_from_b, double up_to) {
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  request.enable_signed_distance = false;
  request.distance_tolerance = kTolerance;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result;
  result.min_distance = std::nextafter(up_to, std::numeric_limits<double>::infinity());  // limits the search
  fcl::distance(&a.model(), fcl::Transform3d::Identity(), &b.model(), fcl::Transform3d(a_from_b.matrix()), request,
                result);
  CoreGap gap;
  gap.lower = std::numeric_limits<double>::infinity();
  if (result.o1 == nullptr) return gap;
  gap.lower = gap.upper = result.min_distance;
  gap.on_first = result.nearest_points[0];
  gap.on_second = result.nearest_points[1];
  return gap;
}

/// Returns the gap of a mesh and another solid, in the frame of the mesh. It is infinite if it is larger than `up_to`
/// [m].
CoreGap gapOfMesh(const Side& mesh, const Side& other, const Pose& mesh_from_other, double up_to) {
  CoreGap gap = isMesh(other)
                    ? gapOfMeshes(meshOf(mesh), meshOf(other), mesh_from_other, up_to)
                    : meshOf(mesh).gapTo(convexOf(other).core(), convexOf(other).volume(), mesh_from_other, up_to);
  if (gap.lower > up_to) gap.lower = gap.upper = std::numeric_limits<double>::infinity();
  return gap;
}

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

/// Whether the core of one solid is inside the other, and a point of the inner core.
struct Enclosed {
  Measure status = Measure::apart;
  Vector point = Vector::Zero();
  double crossing = 0.0;  ///< [m] if the gap of the cores is at most this, the surfaces of the solids touch or cross
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
  const double least = enclosure.closed() ? 0.5 : kMaybeInside;
  const bool inside = anyPart(inner, [&](const Vector* begin, const Vector* end) {
    const auto in_box = [&](const Vector& point) { return enclosure.boxHolds(outer_from_inner * point); };
    result.point = outer_from_inner * *begin;
    return std::all_of(begin, end, in_box) && std::abs(enclosure.windingNumber(result.point)) >= least;
  });
  if (inside) result.status = enclosure.closed() ? Measure::contained : Measure::containment_unknown;
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

/// Measures a mesh and another solid, in the frame of the mesh. It sets no depth for a contact, since another part of
/// the mesh may prevent the move that would separate the two.
Proximity measureMesh(const Side& mesh, const Side& other, double up_to) {
  const Pose mesh_from_other = mesh.world_from_shape.inverse() * other.world_from_shape;
  if (const auto answer = answerByReach(mesh, other, mesh_from_other, up_to)) return *answer;
  const double around = mesh.around + other.around;
  const CoreGap gap = gapOfMesh(mesh, other, mesh_from_other, std::max(0.0, up_to) + around + kTouchingGap);
  if (std::isnan(gap.lower) || std::isnan(gap.upper)) return answerOf(Measure::failed, 0.0);
  if (gap.lower <= 0.0) return answerOf(Measure::contact, 0.0);
  const Enclosed inside = enclosed(mesh, other, mesh_from_other);
  if (inside.status != Measure::apart) {
    return answerOf(gap.lower > inside.crossing ? inside.status : Measure::contact, 0.0);
  }
  return answerByGap(mesh, other, mesh_from_other, gap, up_to);
}

/// Returns at most `most` contacts of a mesh with another solid, in the frame of the mesh.
std::vector<Contact> contactsOfMesh(const Side& mesh, const Side& other, std::size_t most) {
  const Measure status = most > 0 ? measureMesh(mesh, other, 0.0).status : Measure::not_measured;
  if (!isContact(status) || status == Measure::failed) return {};
  const Pose mesh_from_other = mesh.world_from_shape.inverse() * other.world_from_shape;
  const double reach = mesh.around + other.around + kTouchingGap;
  std::vector<Contact> contacts;
  const auto met = [&](const CoreGap& gap) {
    contacts.push_back(contactByGap(mesh, other, gap));
    return contacts.size() < most;
  };
  if (isMesh(other)) {
    meshOf(mesh).meetings(meshOf(other), mesh_from_other, reach, met);
  } else {
    meshOf(mesh).meetings(convexOf(other).core(), convexOf(other).volume(), mesh_from_other, reach, met);
  }
  if (!contacts.empty()) return contacts;
  const Enclosed inside = enclosed(mesh, other, mesh_from_other);
  if (inside.status != Measure::apart) {
    contacts.emplace_back();
    contacts.back().point = inside.point;
  }
  return contacts;
}

/// Measures two meshes with FCL, and all other pairs with the solver in src/narrow/. For overlapping convex shapes it
/// asks FCL for depth and normal.
class FclNarrowPhase final : public OrderedNarrowPhase {
 public:
  std::shared_ptr<const Solid> solidOf(const Shape& shape) override {
    if (shape.kind() == ShapeKind::mesh) return std::make_shared<FclMeshSolid>(shape, treeOf(shape.mesh()));
    return std::make_shared<FclConvexSolid>(shape);
  }

  std::shared_ptr<const Solid> point() const override { return point_; }
  std::shared_ptr<const Solid> needle(double length) const override {
    return std::make_shared<FclConvexSolid>(ConvexCore::segment(length), std::vector<double>{length});
  }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const override {
    return std::make_shared<FclConvexSolid>(ConvexCore::box(size), std::vector<double>{size.x(), size.y(), size.z()});
  }

 protected:
  // Meshes come first in the order of solids, so only `a` needs to be tested.
  Proximity measureInOrder(const Side& a, const Side& b, double up_to) const override {
    return isMesh(a) ? measureMesh(a, b, up_to) : measureConvex(a, b, up_to, overlapByFcl);
  }
  std::vector<Contact> contactsInOrder(const Side& a, const Side& b, std::size_t most) const override {
    return isMesh(a) ? contactsOfMesh(a, b, most) : contactsOfConvex(a, b, most, overlapByFcl);
  }

 private:
  /// Returns the FCL tree of a mesh, and creates it if no solid has it yet.
  std::shared_ptr<const FclMesh> treeOf(const std::shared_ptr<const TriangleMesh>& mesh) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (auto known = meshes_[mesh.get()].lock()) return known;
    }
    auto made = std::make_shared<const FclMesh>(mesh);  // slow, so it runs without the lock
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto known = meshes_.begin(); known != meshes_.end();) {
      known = known->second.expired() ? meshes_.erase(known) : std::next(known);
    }
    meshes_[mesh.get()] = made;
    return made;
  }

  const std::shared_ptr<const Solid> point_ =
      std::make_shared<FclConvexSolid>(ConvexCore::point(), std::vector<double>{});
  std::mutex mutex_;
  std::map<const TriangleMesh*, std::weak_ptr<const FclMesh>> meshes_;
};

}  // namespace

std::shared_ptr<NarrowPhase> makeFclNarrowPhase() { return std::make_shared<FclNarrowPhase>(); }

}  // namespace hgrid
