// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#include "maps/map_gap.h"
#include "queries/placed_map.h"
#include "queries/probe.h"

namespace hgrid {

/// The part of the world that a query asks about. A query that found nothing asks its region what may have come there
/// unseen.
class Snapshot::Region {
 public:
  virtual ~Region() = default;
  /// Whether a box of the snapshot is at most `reach` [m] away.
  virtual bool meets(ProxyId proxy, double reach) const = 0;
  /// Whether the shape of that box is, as measured by the narrow phase. True if the shape cannot be measured.
  virtual bool meetsShape(ProxyId proxy, double reach, const NarrowPhase& exact) const = 0;
  /// Whether an occupied cell of a map is.
  virtual bool meets(const PlacedMap& map, double reach) const = 0;
  /// Whether a sphere of the world is.
  virtual bool meets(const Sphere& sphere) const = 0;
  /// Whether the region lies in space that no map knows to be free.
  virtual bool isUnmapped(const QueryScope& scope) const = 0;
  /// The body that the query asks from, or Structure::kNone.
  virtual std::uint32_t askingBody() const { return Structure::kNone; }

 protected:
  explicit Region(const Snapshot& asked) : snapshot(asked) {}
  std::uint32_t bodyOf(ProxyId proxy) const { return snapshot.structure().body_of_proxy[proxy]; }
  std::uint32_t shapeOf(ProxyId proxy) const { return proxy - snapshot.structure().first_proxy[bodyOf(proxy)]; }
  static bool within(const Proximity& found, double limit) {
    return found.status == Measure::not_measured || found.distance <= limit;
  }

  const Snapshot& snapshot;
};

/// A sphere. A query for what is nearest to a point within a limit asks about a sphere as well.
class Snapshot::SphereRegion final : public Region {
 public:
  SphereRegion(const Snapshot& asked, const Sphere& sphere) : Region(asked), sphere_(sphere) {}

  bool meets(ProxyId proxy, double reach) const override {
    return touches({sphere_.center - snapshot.origin(), sphere_.radius + reach}, snapshot.boxes()[proxy]);
  }
  bool meetsShape(ProxyId proxy, double reach, const NarrowPhase& exact) const override {
    const Probe center{exact, exact.point(), Pose(Eigen::Translation3d(sphere_.center))};
    return within(center.measure(snapshot, bodyOf(proxy), shapeOf(proxy), radius() + reach), radius() + reach);
  }
  bool meets(const PlacedMap& map, double reach) const override {
    std::vector<NearVoxel> near;
    const Eigen::AlignedBox3d center(map.map_from_world * sphere_.center);
    map.cells.grid->nearest(center, 1, radius() + reach, near);
    return !near.empty();
  }
  bool meets(const Sphere& other) const override {
    return (other.center - sphere_.center).norm() <= radius() + other.radius;
  }
  bool isUnmapped(const QueryScope& scope) const override { return snapshot.unmapped(sphere_, scope); }

 private:
  double radius() const { return sphere_.radius + touchSlack(sphere_.center, sphere_.radius); }
  Sphere sphere_;
};

/// A segment with a radius.
class Snapshot::SegmentRegion final : public Region {
 public:
  SegmentRegion(const Snapshot& asked, const Segment& segment, const Pose& world_from_needle)
      : Region(asked), segment_(segment), world_from_needle_(world_from_needle) {}

  bool meets(ProxyId proxy, double reach) const override {
    const Eigen::Vector3d& origin = snapshot.origin();
    return meet({segment_.from - origin, segment_.to - origin, segment_.radius + reach}, snapshot.boxes()[proxy])
        .has_value();
  }
  bool meetsShape(ProxyId proxy, double reach, const NarrowPhase& exact) const override {
    const double length = (segment_.to - segment_.from).norm();
    const double limit = segment_.radius + touchSlack(segment_.from, segment_.radius + length) + reach;
    const Probe axis{exact, length > 0.0 ? exact.needle(length) : exact.point(), world_from_needle_};
    return within(axis.measure(snapshot, bodyOf(proxy), shapeOf(proxy), limit), limit);
  }
  bool meets(const PlacedMap& map, double reach) const override {
    const Segment in_map{map.map_from_world * segment_.from, map.map_from_world * segment_.to, segment_.radius + reach};
    return map.cells.grid->firstAlong(in_map).has_value();
  }
  bool meets(const Sphere& sphere) const override {
    const Eigen::Vector3d way = segment_.to - segment_.from;
    const double square = way.squaredNorm();
    const double along = square > 0.0 ? std::clamp((sphere.center - segment_.from).dot(way) / square, 0.0, 1.0) : 0.0;
    const double limit = segment_.radius + sphere.radius;
    return (sphere.center - segment_.from - along * way).norm() <= limit + touchSlack(sphere.center, limit);
  }
  bool isUnmapped(const QueryScope& scope) const override { return snapshot.unmapped(segment_, scope); }

 private:
  Segment segment_;
  Pose world_from_needle_;
};

/// A box in any pose.
class Snapshot::BoxRegion final : public Region {
 public:
  BoxRegion(const Snapshot& asked, const QueryBox& box, const NarrowPhase& narrow_phase)
      : Region(asked),
        box_(box),
        narrow_phase_(narrow_phase),
        core_(narrow_phase.block(box.size)),
        slack_(touchSlack(box.world_from_box.translation(), box.size.norm())) {}

  bool meets(ProxyId proxy, double reach) const override {
    const Aabb& target = snapshot.boxes()[proxy];
    const Eigen::Vector3d low = target.min.cast<double>(), high = target.max.cast<double>();
    return meetsBlock(narrow_phase_.block(high - low),
                      Pose(Eigen::Translation3d(snapshot.origin() + 0.5 * (low + high))), reach);
  }
  bool meetsShape(ProxyId proxy, double reach, const NarrowPhase& exact) const override {
    const Probe probe{exact, core_, box_.world_from_box};
    return within(probe.measure(snapshot, bodyOf(proxy), shapeOf(proxy), slack_ + reach), slack_ + reach);
  }
  bool meets(const PlacedMap& map, double reach) const override {
    const Eigen::Vector3d middle = map.map_from_world * box_.world_from_box.translation();
    const double half_diagonal = 0.5 * box_.size.norm() + slack_ + reach;
    bool met = false;
    map.cells.grid->visitNear(Eigen::AlignedBox3d(middle), half_diagonal, [&](const Voxel& voxel, double) {
      met = met || meetsBlock(map.cells.cubes[voxel.level], map.worldFromCube(voxel), reach);
      return met ? kNoFurther : half_diagonal;
    });
    return met;
  }
  bool meets(const Sphere& sphere) const override {
    const Eigen::Vector3d center = box_.world_from_box.inverse() * sphere.center;
    const Eigen::Vector3d beyond = (center.cwiseAbs() - 0.5 * box_.size).cwiseMax(0.0);
    return beyond.norm() <= sphere.radius + slack_ + touchSlack(sphere.center, sphere.radius);
  }
  bool isUnmapped(const QueryScope& scope) const override { return snapshot.unmapped(box_, narrow_phase_, scope); }

 private:
  bool meetsBlock(const std::shared_ptr<const Solid>& block, const Pose& world_from_block, double reach) const {
    const Proximity found =
        narrow_phase_.measure({*core_, box_.world_from_box, 0.0}, {*block, world_from_block, 0.0}, slack_ + reach);
    return found.distance <= slack_ + reach;
  }

  QueryBox box_;
  const NarrowPhase& narrow_phase_;
  std::shared_ptr<const Solid> core_;
  double slack_;
};

/// What lies within a limit of a body, at its last pose.
class Snapshot::BodyRegion final : public Region {
 public:
  BodyRegion(const Snapshot& asked, std::uint32_t from, double limit) : Region(asked), from_(from), limit_(limit) {}

  bool meets(ProxyId proxy, double reach) const override {
    return ownBox(
        [&](const Aabb& own, std::uint32_t) { return distance(own, snapshot.boxes()[proxy]) <= limit_ + reach; });
  }
  bool meetsShape(ProxyId proxy, double reach, const NarrowPhase& exact) const override {
    const Body& body = snapshot.structure().bodies[from_];
    return ownBox([&](const Aabb&, std::uint32_t index) {
      const BodyShape& own = body.shapes[index];
      if (!own.solid) return true;
      const Probe probe{exact, own.solid, snapshot.poses()[from_].world_from_body * own.body_from_shape, own.padding};
      return within(probe.measure(snapshot, bodyOf(proxy), shapeOf(proxy), limit_ + reach), limit_ + reach);
    });
  }
  bool meets(const PlacedMap& map, double reach) const override {
    std::vector<NearVoxel> near;
    return ownBox([&](const Aabb& own, std::uint32_t) {
      map.cells.grid->nearest(boxInMap(map.map_from_world, own, snapshot.origin()), 1, limit_ + reach, near);
      return !near.empty();
    });
  }
  bool meets(const Sphere& sphere) const override {
    const double limit = limit_ + sphere.radius + snapshot.poses()[from_].reach;
    return ownBox([&](const Aabb& own, std::uint32_t) {
      return distance(own, sphere.center - snapshot.origin()) <= limit + touchSlack(sphere.center, limit);
    });
  }
  bool isUnmapped(const QueryScope& scope) const override { return snapshot.unmappedNear(from_, limit_, scope); }
  std::uint32_t askingBody() const override { return from_; }

 private:
  /// Whether the claim holds of one of the body's boxes.
  template <class Claim>
  bool ownBox(const Claim& claim) const {
    const ProxyId first = snapshot.structure().first_proxy[from_];
    for (ProxyId own = first; own < snapshot.structure().first_proxy[from_ + 1]; ++own) {
      if (claim(snapshot.boxes()[own], own - first)) return true;
    }
    return false;
  }

  std::uint32_t from_;
  double limit_;
};

}  // namespace hgrid
