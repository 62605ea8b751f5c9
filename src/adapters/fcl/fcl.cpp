// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/fcl.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <optional>
#include <tuple>

#include "adapters/fcl/fcl_solid.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr double kTolerance = 1e-10;    // [m] of FCL's iterations
constexpr double kDisagreement = 1e-6;  // [m] between nearest points and distance, beside their rounding
constexpr double kTouching = 1e-9;      // [m] as far apart is in contact, for one way or another of rounding
constexpr double kHair = 1e-6;          // [m] moved apart by so much more, two solids must be free of each other
constexpr double kMaybeInside = 0.25;   // winding number from which an open mesh may enclose a point

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

/// Whether the two are to be asked in the other order, so that the order of the question does not show: they are sorted
/// by what they are, then by what is around them and where they are.
bool goesAfter(const Side& a, const Side& b) {
  if (b.solid.before(a.solid)) return true;
  if (a.solid.before(b.solid)) return false;
  if (a.around != b.around) return b.around < a.around;
  const auto &m = a.world_from_shape.matrix(), &n = b.world_from_shape.matrix();
  for (Eigen::Index i = 0; i < 16; ++i) {
    if (m.data()[i] != n.data()[i]) return n.data()[i] < m.data()[i];
  }
  return false;
}

/// Two meshes, by FCL: triangles against triangles, which it measures rightly.
CoreGap gapOfMeshes(const FclMesh& a, const FclMesh& b, const Pose& a_from_b, double up_to) {
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  request.enable_signed_distance = false;
  request.distance_tolerance = kTolerance;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::DistanceResultd result;
  result.min_distance = std::nextafter(up_to, std::numeric_limits<double>::infinity());  // FCL looks no farther
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

/// How far the cores are apart, in the first one's frame; infinite if it is more than `up_to`.
CoreGap gapOfCores(const FclSolid& a, const FclSolid& b, const Pose& a_from_b, double up_to) {
  CoreGap gap = b.mesh()   ? gapOfMeshes(*a.mesh(), *b.mesh(), a_from_b, up_to)
                : a.mesh() ? a.mesh()->gapTo(b.core(), b.volume(), a_from_b, up_to)
                           : gapOf(a.core(), b.core(), a_from_b, up_to);
  if (gap.lower > up_to) gap.lower = gap.upper = std::numeric_limits<double>::infinity();
  return gap;
}

/// Depth and normal of two convex cores that meet, of FCL where it says something.
struct Overlap {
  double depth = 0.0;  // [m] of the cores
  Vector normal = Vector::Zero(), point = Vector::Zero();
};

std::optional<Overlap> overlapByFcl(const Side& a, const Side& b, const Pose& a_from_b) {
  fcl::CollisionRequestd request;
  request.num_max_contacts = 1;
  request.enable_contact = true;
  request.gjk_solver_type = fcl::GST_LIBCCD;
  fcl::CollisionResultd found;
  fcl::collide(a.solid.geometry(), fcl::Transform3d::Identity(), b.solid.geometry(),
               fcl::Transform3d(a_from_b.matrix()), request, found);
  if (!found.isCollision()) return std::nullopt;
  const fcl::Contactd& contact = found.getContact(0);
  const double depth = contact.penetration_depth, length = contact.normal.norm();
  if (!(depth >= 0.0) || !std::isfinite(depth) || !(std::abs(length - 1.0) < 1e-6)) return std::nullopt;
  if (!contact.pos.allFinite()) return std::nullopt;
  return Overlap{depth, contact.normal / length, contact.pos};
}

/// Of cores that do no more than touch, as what stands on something does: a hair's breadth farther apart they have
/// nearest points.
std::optional<Overlap> touchOf(const Side& a, const Side& b, const Pose& a_from_b) {
  const double distance = a_from_b.translation().norm();
  if (!(distance > 0.0)) return std::nullopt;
  Pose apart = a_from_b;
  apart.translation() += kHair / distance * a_from_b.translation();
  const CoreGap gap = gapOf(a.solid.core(), b.solid.core(), apart, kHair);
  if (!(gap.lower > 0.0)) return std::nullopt;
  const Vector between = gap.on_second - gap.on_first;
  return Overlap{0.0, between.normalized(), gap.on_first + 0.5 * between};
}

/// Depth, normal and place of two convex cores that meet, where they stand the test of moving the solids apart by them.
void describeContact(const Side& a, const Side& b, const Pose& a_from_b, Proximity& result) {
  if (a.solid.geometry() == nullptr || b.solid.geometry() == nullptr) return;
  const double around = a.around + b.around;
  for (const auto& describe : {overlapByFcl, touchOf}) {
    const std::optional<Overlap> overlap = describe(a, b, a_from_b);
    if (!overlap) continue;
    const double depth = overlap->depth;
    const Vector& normal = overlap->normal;
    Pose apart = a_from_b;
    apart.translation() += (depth + around + kHair) * normal;
    if (!(gapOf(a.solid.core(), b.solid.core(), apart, around).lower > around)) continue;
    result.normal = normal;
    result.depth = depth + around;
    result.on_first = overlap->point + (0.5 * depth + a.around) * normal;
    result.on_second = overlap->point - (0.5 * depth + b.around) * normal;
    return;
  }
}

/// Whether one solid lies within the other, and a point of it.
struct Enclosed {
  Measure status = Measure::apart;
  Vector point = Vector::Zero();
};

/// Whether a part of `inner` lies within the mesh `outer`, the surfaces being apart; in the frame of `outer`.
Enclosed enclosedBy(const FclSolid& outer, const FclSolid& inner, const Pose& outer_from_inner) {
  Enclosed result;
  if (!outer.mesh()) return result;  // what is not a mesh is solid: its core was met
  const Enclosure& enclosure = outer.mesh()->enclosure();
  const double least = enclosure.closed() ? 0.5 : kMaybeInside;
  const bool inside = inner.anyPart([&](const Vector* begin, const Vector* end) {
    const auto in_box = [&](const Vector& point) { return enclosure.boxHolds(outer_from_inner * point); };
    result.point = outer_from_inner * *begin;
    return std::all_of(begin, end, in_box) && std::abs(enclosure.windingNumber(result.point)) >= least;
  });
  if (inside) result.status = enclosure.closed() ? Measure::contained : Measure::containment_unknown;
  return result;
}

/// The same either way round, in the frame of the first.
Enclosed enclosed(const FclSolid& a, const FclSolid& b, const Pose& a_from_b) {
  const Enclosed second = enclosedBy(a, b, a_from_b);
  if (second.status != Measure::apart) return second;
  Enclosed first = enclosedBy(b, a, a_from_b.inverse());
  first.point = a_from_b * first.point;
  return first;
}

/// Where two parts are in contact whose cores are not farther apart than what is around them.
Contact contactOf(const Side& a, const Side& b, const CoreGap& gap) {
  const double around = a.around + b.around;
  const Vector between = gap.on_second - gap.on_first;
  const double length = between.norm();
  Contact contact;
  if (length <= around + kDisagreement) {  // otherwise that they meet was not disproved, but no more
    contact.point = gap.on_first + (around > 0.0 ? a.around / around : 0.5) * between;
  }
  if (gap.lower > 0.0) {
    contact.normal = between / length;
    contact.depth = std::max(0.0, around - length);
  }
  return contact;
}

Proximity answer(Measure status, double distance) {
  Proximity result;
  result.status = status;
  result.distance = distance;
  return result;
}

/// The pair in the order of goesAfter(), in the frame of the first.
Proximity measured(const Side& a, const Side& b, double up_to) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Pose a_from_b = a.world_from_shape.inverse() * b.world_from_shape;
  const double around = a.around + b.around;
  if (!a_from_b.matrix().allFinite() || !(around >= 0.0)) return answer(Measure::failed, 0.0);
  const bool has_mesh = a.solid.mesh() || b.solid.mesh();
  if (a_from_b.translation().norm() - (a.solid.reach() + b.solid.reach()) - around > up_to) {
    return answer(Measure::apart, kInfinity);
  }
  const CoreGap gap = gapOfCores(a.solid, b.solid, a_from_b, std::max(0.0, up_to) + around + kTouching);
  if (std::isnan(gap.lower) || std::isnan(gap.upper)) return answer(Measure::failed, 0.0);
  if (gap.lower <= 0.0) {
    Proximity result = answer(Measure::contact, 0.0);
    if (!has_mesh) describeContact(a, b, a_from_b, result);
    return result;
  }
  if (has_mesh) {
    const Measure inside = enclosed(a.solid, b.solid, a_from_b).status;
    if (inside != Measure::apart) return answer(inside, 0.0);
  }
  Proximity result = answer(Measure::apart, std::max(0.0, gap.upper - around));
  if (result.distance > up_to) return answer(Measure::apart, kInfinity);
  const Vector between = gap.on_second - gap.on_first;
  const double length = between.norm();
  const double rounding = 1e-12 * (a.solid.reach() + b.solid.reach() + a_from_b.translation().norm());
  if (!(std::abs(length - gap.upper) <= kDisagreement + rounding)) return answer(Measure::failed, 0.0);
  if (!(std::min(gap.lower, gap.upper) > around)) {  // their rounding may have crossed
    result.status = Measure::contact;
    result.distance = 0.0;
    if (!has_mesh) result.depth = std::max(0.0, around - gap.upper);  // a mesh may be in the way of moving apart
  }
  if (length > 0.0) {
    result.normal = between / length;
    result.on_first = gap.on_first + a.around * result.normal;
    result.on_second = gap.on_second - b.around * result.normal;
  }
  return result;
}

/// At most so many, of the pair in the order of goesAfter(), in the frame of the first.
std::vector<Contact> contactsOf(const Side& a, const Side& b, std::size_t most) {
  const Pose a_from_b = a.world_from_shape.inverse() * b.world_from_shape;
  const double reach = a.around + b.around + kTouching;
  std::vector<Contact> contacts;
  const Measure status = most > 0 ? measured(a, b, 0.0).status : Measure::not_measured;
  if (!isContact(status) || status == Measure::failed) return contacts;
  const auto met = [&](const CoreGap& gap) {
    contacts.push_back(contactOf(a, b, gap));
    return contacts.size() < most;
  };
  if (b.solid.mesh()) {
    a.solid.mesh()->meetings(*b.solid.mesh(), a_from_b, reach, met);
  } else if (a.solid.mesh()) {
    a.solid.mesh()->meetings(b.solid.core(), b.solid.volume(), a_from_b, reach, met);
  } else {
    const CoreGap gap = gapOf(a.solid.core(), b.solid.core(), a_from_b, reach);
    met(gap);
    if (gap.lower <= 0.0) {
      Proximity described;
      describeContact(a, b, a_from_b, described);
      contacts.front().normal = described.normal;
      contacts.front().depth = described.depth;
    }
  }
  if (!contacts.empty()) return contacts;
  const Enclosed inside = enclosed(a.solid, b.solid, a_from_b);
  if (inside.status != Measure::apart) {
    contacts.emplace_back();
    contacts.back().point = inside.point;
  }
  return contacts;
}

class FclNarrowPhase final : public NarrowPhase {
 public:
  std::shared_ptr<const Solid> solidOf(const Shape& shape) override {
    std::shared_ptr<const FclMesh> mesh;
    if (shape.kind() == ShapeKind::mesh) mesh = meshOf(shape.mesh());
    return std::make_shared<FclSolid>(shape, mesh);
  }

  std::shared_ptr<const Solid> point() const override { return point_; }
  std::shared_ptr<const Solid> needle(double length) const override {
    return std::make_shared<FclSolid>(ConvexCore::segment(length), std::vector<double>{length});
  }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const override {
    return std::make_shared<FclSolid>(ConvexCore::box(size), std::vector<double>{size.x(), size.y(), size.z()});
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

  std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second, std::size_t most) const override {
    Side a(first), b(second);
    const bool exchanged = goesAfter(a, b);
    const Pose& world_from_frame = exchanged ? b.world_from_shape : a.world_from_shape;
    std::vector<Contact> found;
    try {
      found = exchanged ? contactsOf(b, a, most) : contactsOf(a, b, most);
    } catch (const std::exception&) {
      return {};
    }
    for (Contact& contact : found) {
      contact.point = world_from_frame * contact.point;
      contact.normal = world_from_frame.linear() * contact.normal;
      if (exchanged) contact.normal = -contact.normal;
    }
    std::stable_sort(found.begin(), found.end(), [](const Contact& m, const Contact& n) { return deeper(m, n); });
    return found;
  }

 private:
  static Proximity inWorld(Proximity result, const Side& frame) {
    result.on_first = frame.world_from_shape * result.on_first;
    result.on_second = frame.world_from_shape * result.on_second;
    result.normal = frame.world_from_shape.linear() * result.normal;
    return result;
  }

  std::shared_ptr<const FclMesh> meshOf(const std::shared_ptr<const TriangleMesh>& mesh) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (auto known = meshes_[mesh.get()].lock()) return known;
    }
    auto made = std::make_shared<const FclMesh>(mesh);  // takes long: others need not wait
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto known = meshes_.begin(); known != meshes_.end();) {
      known = known->second.expired() ? meshes_.erase(known) : std::next(known);
    }
    meshes_[mesh.get()] = made;
    return made;
  }

  const std::shared_ptr<const Solid> point_ = std::make_shared<FclSolid>(ConvexCore::point(), std::vector<double>{});
  std::mutex mutex_;
  std::map<const TriangleMesh*, std::weak_ptr<const FclMesh>> meshes_;
};

}  // namespace

std::shared_ptr<NarrowPhase> makeFclNarrowPhase() { return std::make_shared<FclNarrowPhase>(); }

}  // namespace hgrid
