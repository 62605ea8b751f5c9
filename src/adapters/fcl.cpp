// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/fcl.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>

#include "hgrid_proximity/refusal.h"
#include "narrowphase/enclosure.h"

namespace hgrid {
namespace {

using Geometry = fcl::CollisionGeometryd;
using Vector = Eigen::Vector3d;

constexpr double kTolerance = 1e-10;    // [m] of FCL's iterations
constexpr double kDisagreement = 1e-6;  // [m] between FCL's nearest points and its distance, beside their rounding
constexpr double kMaybeInside = 0.25;   // winding number from which an open mesh may enclose a point

/// What FCL makes of a mesh, and what it encloses; equal meshes share it.
struct MeshCore {
  explicit MeshCore(const std::shared_ptr<const TriangleMesh>& source) : mesh(source), enclosure(*source) {
    model.beginModel(static_cast<int>(source->triangles.size()), static_cast<int>(source->vertices.size()));
    for (const auto& triangle : source->triangles) {
      const Vector &a = source->vertices[triangle[0]], &b = source->vertices[triangle[1]],
                   &c = source->vertices[triangle[2]];
      if ((b - a).cross(c - a).squaredNorm() > 0.0) model.addTriangle(a, b, c);  // FCL divides by the area
    }
    model.endModel();
  }
  std::shared_ptr<const TriangleMesh> mesh;  // lives as long, so that its address is no other mesh's
  Enclosure enclosure;
  fcl::BVHModel<fcl::OBBRSSd> model;
};

/// A shape as FCL measures it: a core, and a radius around it.
class FclSolid final : public Solid {
 public:
  FclSolid(const Shape& shape, std::shared_ptr<const MeshCore> mesh)
      : kind_(shape.kind()), reach_(shape.reach()), mesh_(std::move(mesh)) {
    const std::vector<double> size = shape.dimensions();
    switch (kind_) {
      case ShapeKind::sphere:
        radius_ = size[0];
        core_ = std::make_unique<fcl::Sphered>(0.0);
        break;
      case ShapeKind::box:
        core_ = std::make_unique<fcl::Boxd>(size[0], size[1], size[2]);
        break;
      case ShapeKind::cylinder:
        core_ = std::make_unique<fcl::Cylinderd>(size[1], size[0]);
        break;
      case ShapeKind::cone:
        core_ = std::make_unique<fcl::Coned>(size[1], size[0]);
        break;
      case ShapeKind::capsule:
        radius_ = size[1];
        core_ = std::make_unique<fcl::Capsuled>(0.0, size[0]);
        break;
      case ShapeKind::hull:
        // Without faces: FCL then goes through all vertices, which is right whatever they are.
        core_ = std::make_unique<fcl::Convexd>(std::make_shared<const std::vector<Vector>>(shape.mesh()->vertices), 0,
                                               std::make_shared<const std::vector<int>>());
        some_point_ = shape.mesh()->vertices.front();
        break;
      case ShapeKind::mesh:
        break;
    }
  }

  FclSolid(ShapeKind kind, double reach, std::unique_ptr<const Geometry> core)
      : kind_(kind), reach_(reach), core_(std::move(core)) {}

  const Geometry& core() const { return mesh_ ? static_cast<const Geometry&>(mesh_->model) : *core_; }
  const MeshCore* mesh() const { return mesh_.get(); }
  double radius() const { return radius_; }
  double reach() const { return reach_; }
  ShapeKind kind() const { return kind_; }

  /// Whether a part of the core, told by some points in its frame, is as asked.
  template <class Ask>
  bool anyPart(const Ask& ask) const {
    if (!mesh_) return ask(&some_point_, &some_point_ + 1);
    const std::vector<Enclosure::Part>& parts = mesh_->enclosure.parts();
    return std::any_of(parts.begin(), parts.end(),
                       [&](const Enclosure::Part& part) { return ask(part.data(), part.data() + part.size()); });
  }

 private:
  ShapeKind kind_;
  double reach_, radius_ = 0.0;
  std::unique_ptr<const Geometry> core_;  // of all but meshes
  std::shared_ptr<const MeshCore> mesh_;
  Vector some_point_ = Vector::Zero();
};

/// A solid, its core's pose, and all that is around the core.
struct Side {
  explicit Side(const PlacedSolid& placed)
      : solid(static_cast<const FclSolid&>(placed.solid)),
        world_from_shape(placed.world_from_shape),
        around(solid.radius() + placed.padding) {}
  const FclSolid& solid;
  const Pose& world_from_shape;
  double around;
};

/// Whether the two are to be asked in the other order: meshes go first, which is how FCL names points rightly; then by
/// what they are and where, so that the order of the question does not show.
bool goesAfter(const Side& a, const Side& b) {
  const auto key = [](const Side& side) {
    const std::size_t triangles = side.solid.mesh() ? side.solid.mesh()->mesh->triangles.size() : 0;
    return std::make_tuple(-static_cast<int>(side.solid.kind()), triangles, side.solid.reach(), side.around);
  };
  if (key(a) != key(b)) return key(b) < key(a);
  const auto &m = a.world_from_shape.matrix(), &n = b.world_from_shape.matrix();
  for (Eigen::Index i = 0; i < 16; ++i) {
    if (m.data()[i] != n.data()[i]) return n.data()[i] < m.data()[i];
  }
  if (!a.solid.mesh() || a.solid.mesh() == b.solid.mesh()) return false;
  const auto &v = a.solid.mesh()->mesh->vertices, &w = b.solid.mesh()->mesh->vertices;
  for (std::size_t i = 0; i < std::min(v.size(), w.size()); ++i) {
    if (v[i] != w[i]) return std::lexicographical_compare(w[i].data(), w[i].data() + 3, v[i].data(), v[i].data() + 3);
  }
  return false;
}

/// Nearest points of two cores in the first one's frame.
struct CoreDistance {
  double distance = std::numeric_limits<double>::infinity();  // [m] <= 0: they meet; infinite: farther than asked
  Vector on_first = Vector::Zero(), on_second = Vector::Zero();
};

fcl::DistanceRequestd distanceRequest() {
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  request.enable_signed_distance = false;
  request.distance_tolerance = kTolerance;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  return request;
}

CoreDistance distanceOf(const FclSolid& a, const FclSolid& b, const Pose& a_from_b, double up_to) {
  const fcl::Transform3d identity = fcl::Transform3d::Identity(), placed(a_from_b.matrix());
  fcl::DistanceResultd result;
  result.min_distance = std::nextafter(up_to, std::numeric_limits<double>::infinity());  // FCL looks no farther
  fcl::distance(&a.core(), identity, &b.core(), placed, distanceRequest(), result);
  if (result.o1 == nullptr) return {};
  CoreDistance found;
  found.distance = result.min_distance;
  found.on_first = result.nearest_points[0];
  found.on_second = result.nearest_points[1];
  // The core of a ball is its centre. Beside a triangle FCL names that point in the ball's own frame.
  if (a.kind() == ShapeKind::sphere) found.on_first.setZero();
  if (b.kind() == ShapeKind::sphere) found.on_second = a_from_b.translation();
  return found;
}

/// Depth, normal and place of two cores that meet, where FCL's contact stands the test of moving them apart by it.
void describeContact(const Side& a, const Side& b, const Pose& a_from_b, Proximity& result) {
  if (a.solid.mesh() || b.solid.mesh()) return;  // of meshes FCL knows depths of single triangles only
  const fcl::Transform3d identity = fcl::Transform3d::Identity(), placed(a_from_b.matrix());
  fcl::CollisionRequestd request;
  request.num_max_contacts = 1;
  request.enable_contact = true;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd found;
  fcl::collide(&a.solid.core(), identity, &b.solid.core(), placed, request, found);
  if (!found.isCollision()) return;
  const fcl::Contactd& contact = found.getContact(0);
  const double depth = contact.penetration_depth, length = contact.normal.norm();
  if (!(depth >= 0.0) || !std::isfinite(depth) || !(std::abs(length - 1.0) < 1e-6) || !contact.pos.allFinite()) return;
  const Vector normal = contact.normal / length;
  Pose apart = a_from_b;
  apart.translation() += (depth + 1e-5) * normal;
  if (!(distanceOf(a.solid, b.solid, apart, 1.0).distance > 0.0)) return;
  result.normal = normal;
  result.depth = depth + a.around + b.around;
  result.on_first = contact.pos + (0.5 * depth + a.around) * normal;
  result.on_second = contact.pos - (0.5 * depth + b.around) * normal;
}

/// Whether a part of `inner` lies within the mesh `outer`, the surfaces being apart.
Measure enclosed(const FclSolid& outer, const FclSolid& inner, const Pose& outer_from_inner) {
  if (!outer.mesh()) return Measure::apart;  // what is not a mesh is solid: FCL has found it
  const Enclosure& enclosure = outer.mesh()->enclosure;
  const double least = enclosure.closed() ? 0.5 : kMaybeInside;
  const bool inside = inner.anyPart([&](const Vector* begin, const Vector* end) {
    const auto in_box = [&](const Vector& point) { return enclosure.boxHolds(outer_from_inner * point); };
    return std::all_of(begin, end, in_box) && std::abs(enclosure.windingNumber(outer_from_inner * *begin)) >= least;
  });
  if (!inside) return Measure::apart;
  return enclosure.closed() ? Measure::contained : Measure::containment_unknown;
}

/// The pair in the order of goesAfter(), in the frame of the first.
Proximity measured(const Side& a, const Side& b, double up_to) {
  Proximity result;
  result.status = Measure::failed;
  result.distance = 0.0;
  const Pose a_from_b = a.world_from_shape.inverse() * b.world_from_shape;
  if (!a_from_b.matrix().allFinite() || !(a.around >= 0.0) || !(b.around >= 0.0)) return result;
  const double around = a.around + b.around;
  const bool has_mesh = a.solid.mesh() || b.solid.mesh();
  const bool far = a_from_b.translation().norm() - (a.solid.reach() + b.solid.reach()) - around > up_to;
  CoreDistance cores;
  if (!far) cores = distanceOf(a.solid, b.solid, a_from_b, std::max(0.0, up_to) + around);
  if (std::isnan(cores.distance)) return result;
  if (cores.distance <= 0.0) {
    result.status = Measure::contact;
    describeContact(a, b, a_from_b, result);
    return result;
  }
  if (has_mesh && !far) {
    Measure inside = enclosed(a.solid, b.solid, a_from_b);
    if (inside == Measure::apart) inside = enclosed(b.solid, a.solid, a_from_b.inverse());
    if (inside != Measure::apart) {
      result.status = inside;
      return result;
    }
  }
  if (std::isinf(cores.distance)) {
    result.status = Measure::apart;
    result.distance = cores.distance;
    return result;
  }
  const Vector between = cores.on_second - cores.on_first;
  const double length = between.norm();
  const double rounding = 1e-12 * (a.solid.reach() + b.solid.reach() + a_from_b.translation().norm());
  if (!(std::abs(length - cores.distance) <= kDisagreement + rounding)) return result;
  result.distance = std::max(0.0, cores.distance - around);
  result.status = cores.distance > around ? Measure::apart : Measure::contact;
  if (result.status == Measure::contact) result.depth = around - cores.distance;
  if (length > 0.0) {
    result.normal = between / length;
    result.on_first = cores.on_first + a.around * result.normal;
    result.on_second = cores.on_second - b.around * result.normal;
  }
  return result;
}

class FclNarrowPhase final : public NarrowPhase {
 public:
  std::shared_ptr<const Solid> solidOf(const Shape& shape) override {
    std::shared_ptr<const MeshCore> mesh;
    if (shape.kind() == ShapeKind::mesh) mesh = meshOf(shape.mesh());
    return std::make_shared<FclSolid>(shape, mesh);
  }

  std::shared_ptr<const Solid> point() const override { return point_; }
  std::shared_ptr<const Solid> needle(double length) const override {
    return std::make_shared<FclSolid>(ShapeKind::capsule, 0.5 * length, std::make_unique<fcl::Capsuled>(0.0, length));
  }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const override {
    return std::make_shared<FclSolid>(ShapeKind::box, 0.5 * size.norm(), std::make_unique<fcl::Boxd>(size));
  }

  Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const override {
    Side a(first), b(second);
    Proximity result;
    try {
      if (!goesAfter(a, b)) return inWorld(measured(a, b, up_to), a);
      result = inWorld(measured(b, a, up_to), b);
      std::swap(result.on_first, result.on_second);
      result.normal = -result.normal;
    } catch (const std::exception&) {
      result = Proximity{};
      result.status = Measure::failed;
      result.distance = 0.0;
    }
    return result;
  }

 private:
  static Proximity inWorld(Proximity result, const Side& frame) {
    result.on_first = frame.world_from_shape * result.on_first;
    result.on_second = frame.world_from_shape * result.on_second;
    result.normal = frame.world_from_shape.linear() * result.normal;
    return result;
  }

  std::shared_ptr<const MeshCore> meshOf(const std::shared_ptr<const TriangleMesh>& mesh) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (auto known = meshes_[mesh.get()].lock()) return known;
    }
    auto made = std::make_shared<const MeshCore>(mesh);  // takes long: others need not wait
    if (made->model.num_tris == 0) throw Refusal(Code::bad_geometry, "mesh: none of its triangles has an area");
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto known = meshes_.begin(); known != meshes_.end();) {
      known = known->second.expired() ? meshes_.erase(known) : std::next(known);
    }
    meshes_[mesh.get()] = made;
    return made;
  }

  const std::shared_ptr<const Solid> point_ =
      std::make_shared<FclSolid>(ShapeKind::sphere, 0.0, std::make_unique<fcl::Sphered>(0.0));
  std::mutex mutex_;
  std::map<const TriangleMesh*, std::weak_ptr<const MeshCore>> meshes_;
};

}  // namespace

std::shared_ptr<NarrowPhase> makeFclNarrowPhase() { return std::make_shared<FclNarrowPhase>(); }

}  // namespace hgrid
