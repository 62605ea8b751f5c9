// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/queries/distance_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/infinity.h"
#include "geometry/inner_depth.h"
#include "hgrid_proximity/geometry/float_environment.h"
#include "hgrid_proximity/queries/query.h"
#include "hgrid_proximity/refusal.h"
#include "queries/around_point.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

/// What is nearest to a point.
struct Nearest {
  double distance = kInfinity;                              // [m] negative inside
  Vector gradient = Vector::Constant(Proximity::kUnknown);  // in the world frame

  void take(double other, const Vector& direction) {
    if (!(other < distance)) return;
    distance = other;
    gradient = direction;
  }
};

/// Decides whether something unseen may be nearer to a point than what is known.
class UnseenAround final : public AroundPoint {
 public:
  using AroundPoint::AroundPoint;
  bool gather(std::size_t, std::vector<QueryHit>&, std::vector<ProxyId>&) override { return false; }
  bool hitsBox(ProxyId, QueryHit&) const override { return false; }
  bool hitsShape(ProxyId, const NarrowPhase&, QueryHit&) const override { return false; }
  bool hitsMap(const PlacedMap&, QueryHit&) const override { return false; }
  bool hitsPlane(const PlacedPlane&, QueryHit&) const override { return false; }
};

/// Returns the unit vector from one point to another; NaN if they are equal.
Vector directionTo(const Vector& from, const Vector& to) {
  const Vector between = to - from;
  const double length = between.norm();
  return length > 0.0 ? Vector(between / length) : Vector::Constant(Proximity::kUnknown);
}

/// Measures points against the bodies of a snapshot.
class PointMeter {
 public:
  PointMeter(const Snapshot& snapshot, NarrowPhase& narrow_phase, const QueryScope& scope)
      : snapshot_(snapshot), narrow_phase_(narrow_phase), point_(narrow_phase.point()) {
    const std::size_t count = snapshot.structure().bodies.size();
    in_scope_.reserve(count);
    for (std::uint32_t body = 0; body < count; ++body) in_scope_.push_back(inScope(snapshot, scope, body));
    forEachPlane(snapshot, scope, [&](const PlacedPlane& plane) { planes_.push_back(plane); });
    forEachMap(snapshot, scope, [&](const PlacedMap& map) { maps_.push_back(map); });
  }

  /// Returns the signed distance and the gradient of what is nearest to a point, if it is at most `limit` [m] away.
  /// @param limit    [m] > 0
  /// @param deepest  [m] depths need to be known only up to this value
  Nearest nearestTo(const Vector& point, double limit, double deepest) {
    Nearest nearest;
    const Vector local = point - snapshot_.origin();
    for (const PlacedPlane& plane : planes_) {
      nearest.take(plane.signedDistanceOf(local), plane.world_from_plane.linear().col(2));
    }
    gather(local, limit);
    for (const auto& [distance, proxy] : candidates_) {
      if (distance > std::max(0.0, std::min(nearest.distance, limit))) break;
      measure(point, proxy, std::max(0.0, std::min(nearest.distance, limit)), deepest, nearest);
    }
    for (const PlacedMap& map : maps_) measureMap(map, point, limit, nearest);
    return nearest;
  }

 private:
  /// Finds boxes within `limit` [m] of a point, nearest first.
  void gather(const Vector& local, double limit) {
    snapshot_.broadPhase().overlapping({local, limit}, found_);
    candidates_.clear();
    for (const ProxyId proxy : found_) {
      if (!in_scope_[snapshot_.structure().body_of_proxy[proxy]]) continue;
      candidates_.emplace_back(distance(snapshot_.boxes()[proxy], local), proxy);
    }
    std::sort(candidates_.begin(), candidates_.end());
  }

  /// Measures one shape. If the narrow phase returns no depth for a point inside the shape: primitives use formulas,
  /// hulls measure the contact, and meshes search their surface.
  void measure(const Vector& point, ProxyId proxy, double limit, double deepest, Nearest& nearest) const {
    const Structure& structure = snapshot_.structure();
    const std::uint32_t body = structure.body_of_proxy[proxy];
    const BodyShape& shape = structure.bodies[body].shapes[structure.shapeOf(proxy)];
    if (!shape.solid) {
      const Vector local = point - snapshot_.origin();
      const Eigen::AlignedBox3d box = inDouble(snapshot_.boxes()[proxy]);
      const double away = distance(snapshot_.boxes()[proxy], local);
      nearest.take(signedDistance(box, Eigen::AlignedBox3d(local), away), directionTo(nearestPoint(box, local), local));
      return;
    }
    const Pose world_from_shape = snapshot_.poses()[body].world_from_body * shape.body_from_shape;
    const PlacedSolid solid{*shape.solid, world_from_shape, shape.padding};
    const Pose world_from_point(Eigen::Translation3d{point});
    Proximity found = narrow_phase_.measure({*point_, world_from_point, 0.0}, solid, limit);
    if (found.status == Measure::apart) {
      nearest.take(found.distance, -found.normal);
    } else if (!std::isnan(found.depth)) {
      nearest.take(0.0 - found.depth, -found.normal);
    } else if (const auto inner = depthInside(shape.shape, world_from_shape.inverse() * point)) {
      nearest.take(0.0 - inner->depth - shape.padding, world_from_shape.linear() * inner->outward);
    } else if (shape.shape.kind() == ShapeKind::hull) {
      const Contact contact = narrow_phase_.measureContact({*point_, world_from_point, 0.0}, solid);
      nearest.take(std::isnan(contact.depth) ? 0.0 - shape.padding : 0.0 - contact.depth, -contact.normal);
    } else {
      found = narrow_phase_.measure({*point_, world_from_point, 0.0}, solid, deepest);
      const double unknown = found.status == Measure::contained ? -deepest : 0.0 - shape.padding;
      nearest.take(std::isnan(found.depth) ? unknown : 0.0 - found.depth, -found.normal);
    }
  }

  void measureMap(const PlacedMap& map, const Vector& point, double limit, Nearest& nearest) {
    const Vector in_map = map.map_from_world * point;
    const double most = std::max(0.0, std::min(nearest.distance, limit));
    map.cells.grid->nearest(Eigen::AlignedBox3d(in_map), 1, most, voxels_);
    if (voxels_.empty()) return;
    const Eigen::AlignedBox3d cube = map.cubeOf(voxels_.front().voxel);
    const double away = voxels_.front().distance;
    if (away > 0.0) {
      nearest.take(away, map.world_from_map.linear() * directionTo(nearestPoint(cube, in_map), in_map));
      return;
    }
    const auto inner = depthInside(Shape::box(cube.sizes(), {0.0, kQueryReach}), in_map - cube.center());
    nearest.take(0.0 - inner->depth, map.world_from_map.linear() * inner->outward);
  }

  const Snapshot& snapshot_;
  NarrowPhase& narrow_phase_;
  const std::shared_ptr<const Solid> point_, tiny_sphere_;
  std::vector<std::uint8_t> in_scope_;  // for each body
  std::vector<PlacedPlane> planes_;
  std::vector<PlacedMap> maps_;
  std::vector<ProxyId> found_;
  std::vector<std::pair<double, ProxyId>> candidates_;  // distance of the box [m]
  std::vector<NearVoxel> voxels_;
};

/// Measures the points of a lattice, row after row.
class FieldWork {
 public:
  FieldWork(const Snapshot& snapshot, const Lattice& lattice, const FieldRequest& request, NarrowPhase& narrow_phase,
            const QueryScope& scope)
      : snapshot_(snapshot),
        lattice_(lattice),
        request_(request),
        scope_(scope),
        meter_(snapshot, narrow_phase, scope),
        has_doubts_(!snapshot.gaps().empty() || !snapshot.doubtful().empty() || snapshot.reportsUnmapped()),
        time_(scope.deadline) {
    scope_.exact = &narrow_phase;
    scope_.deadline.reset();
  }

  DistanceField run() {
    field_.distance.reserve(lattice_.pointCount());
    if (request_.gradients) field_.gradient.reserve(lattice_.pointCount());
    double of_layer = kInfinity;  // [m] distance of the first point of the layer before this one
    for (std::uint32_t k = 0; k < lattice_.count[2]; ++k) {
      double of_row = of_layer;
      for (std::uint32_t j = 0; j < lattice_.count[1]; ++j) {
        double before = of_row;
        for (std::uint32_t i = 0; i < lattice_.count[0]; ++i) {
          before = addPoint({i, j, k}, before);
          if (i == 0) of_row = before;
          if (i == 0 && j == 0) of_layer = before;
        }
      }
    }
    return std::move(field_);
  }

 private:
  /// Adds the next point.
  /// @param beside  [m] distance of a neighboring point; infinite if that distance is not known
  /// @returns the distance [m] of the nearest known body, even if the point is unknown
  double addPoint(const std::array<std::uint32_t, 3>& index, double beside) {
    if (time_.isOver(TimeBudget::Step::slow)) {
      addUnknown(Unknown::budget,
                 "the deadline passed before all points were measured; allow more time or ask for fewer points");
      return kInfinity;
    }
    const Vector point = lattice_.world_from_lattice * (lattice_.resolution * Vector(index[0], index[1], index[2]));
    // The distance of a neighbor bounds this distance: it changes by at most the resolution. The factor makes up for
    // rounding.
    constexpr double kGrown = 1.0 + 1e-6;
    const double limit = std::min(request_.max_distance, kGrown * (std::max(0.0, beside) + lattice_.resolution));
    Nearest nearest = meter_.nearestTo(point, limit, request_.max_distance);
    // If nothing is that near, the distance of the neighbor was too small, for example because the neighbor is inside
    // an open mesh. Then the whole distance is searched.
    if (!(nearest.distance <= limit) && limit < request_.max_distance) {
      nearest = meter_.nearestTo(point, request_.max_distance, request_.max_distance);
    }
    const double known = std::min(nearest.distance, request_.max_distance);
    if (has_doubts_ && known > 0.0 && noteUnseen(point, known)) return known;
    field_.distance.push_back(std::max(-request_.max_distance, known));
    if (!request_.gradients) return known;
    const bool far = !(std::abs(field_.distance.back()) < request_.max_distance);
    field_.gradient.push_back(far ? Vector(Vector::Zero())
                                  : Vector(lattice_.world_from_lattice.linear().transpose() * nearest.gradient));
    return known;
  }

  /// If something unseen may be nearer to a point, adds that this point is unknown, and returns true.
  bool noteUnseen(const Vector& point, double distance) {
    const UnseenAround question(snapshot_, scope_, {point, distance});
    QueryAnswer answer;
    noteDoubt(question, answer);
    if (answer.because == Unknown::no) return false;
    addUnknown(answer.because, std::move(answer.reason));
    return true;
  }

  void addUnknown(Unknown because, std::string reason) {
    field_.distance.push_back(DistanceField::kUnknown);
    if (request_.gradients) field_.gradient.push_back(Vector::Constant(DistanceField::kUnknown));
    if (field_.unknown++ > 0) return;
    field_.because = because;
    field_.reason = std::move(reason);
  }

  const Snapshot& snapshot_;
  const Lattice& lattice_;
  const FieldRequest& request_;
  QueryScope scope_;
  PointMeter meter_;
  const bool has_doubts_;
  TimeBudget time_;
  DistanceField field_;
};

void requireLength(double length, const char* what) {
  if (length > 0.0 && length <= kQueryReach) return;
  throw Refusal(Code::out_of_range, std::string(what) + " is " + text(length) +
                                        " m; it must be greater than 0 and at most " + text(kQueryReach) + " m");
}

}  // namespace

DistanceField distanceField(const Snapshot& snapshot, const Lattice& lattice, const FieldRequest& request,
                            NarrowPhase& narrow_phase, const QueryScope& scope) {
  const DefaultFloatEnvironment environment;
  checkScope(snapshot, scope);
  requireLength(lattice.resolution, "the resolution");
  requireLength(request.max_distance, "max_distance");
  constexpr std::uint64_t kMostPoints = 1u << 30;
  const std::uint64_t row = lattice.count[0], layer = row * lattice.count[1];
  if (layer > kMostPoints || layer * lattice.count[2] > kMostPoints) {
    throw Refusal(Code::limit, "the lattice has " + std::to_string(row) + " x " + std::to_string(lattice.count[1]) +
                                   " x " + std::to_string(lattice.count[2]) + " points; at most " +
                                   std::to_string(kMostPoints) + " are allowed");
  }
  const Vector last(lattice.count[0] - 1.0, lattice.count[1] - 1.0, lattice.count[2] - 1.0);  // index of the last point
  checkQueryPoint(lattice.world_from_lattice.translation(), "the first point of the lattice");
  checkQueryPoint(lattice.world_from_lattice * (lattice.resolution * last), "the last point of the lattice");
  return FieldWork(snapshot, lattice, request, narrow_phase, scope).run();
}

}  // namespace hgrid
