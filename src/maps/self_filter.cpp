// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/maps/self_filter.h"

#include <algorithm>
#include <cmath>

#include "hgrid_proximity/maps/static_grid.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostMeasurements = 4'000'000;  // of distances; so many take some seconds

/// Splits cells until each part is inside a shape or outside all shapes.
class Splitter {
 public:
  Splitter(double edge, const Pose& world_from_map, const std::vector<SelfShape>& shapes,
           const NarrowPhase& narrow_phase)
      : edge_(edge), world_from_map_(world_from_map), narrow_phase_(narrow_phase), point_(narrow_phase.point()) {
    const Pose map_from_world = world_from_map.inverse();
    for (const SelfShape& shape : shapes) {
      if (!shape.solid) continue;
      const Pose map_from_shape = map_from_world * shape.world_from_shape;
      const Aabb box = boxOf(shape.shape, map_from_shape, shape.padding, map_from_shape.translation());
      const Eigen::Vector3d at = map_from_shape.translation();
      placed_.push_back({&shape, {at + box.min.cast<double>(), at + box.max.cast<double>()}});
    }
  }

  /// Returns the cells that overlap the padded box of a shape, in Morton order.
  std::vector<Voxel> nearShapes(const std::vector<Voxel>& voxels) const {
    std::vector<Voxel> all, found;
    if (placed_.empty() || voxels.empty()) return all;
    const StaticGrid grid(edge_, voxels);
    for (const Placed& one : placed_) {
      grid.overlapping(one.box, voxels.size(), found);
      all.insert(all.end(), found.begin(), found.end());
    }
    std::sort(all.begin(), all.end(), [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Adds the parts of a cell that are kept to `others`. @returns whether the whole cell is kept
  bool split(const Voxel& cell, OthersCells& others) {
    const Eigen::AlignedBox3d cube(minCorner(cell, edge_), maxCorner(cell, edge_));
    const double half_diagonal = 0.5 * cube.sizes().norm();
    const Pose world_from_middle = world_from_map_ * Eigen::Translation3d(cube.center());
    bool reaches_in = false;
    for (const Placed& one : placed_) {
      if (!one.box.intersects(cube)) continue;
      if (looks_ == kMostMeasurements) {
        ++others.undecided;
        others.voxels.push_back(cell);
        return true;
      }
      ++looks_;
      const double padding = one.shape->padding;
      const Proximity found =
          narrow_phase_.measure({*point_, world_from_middle, 0.0},
                                {*one.shape->solid, one.shape->world_from_shape, 0.0}, padding + half_diagonal);
      // If it is not known whether the cell lies inside an open mesh, the cell is kept.
      const bool is_known = found.status != Measure::containment_unknown && found.status != Measure::failed;
      const bool inside =
          is_known && (cell.level == 0 ? found.distance <= padding : found.distance + half_diagonal <= padding);
      if (inside) {
        others.left_out += std::uint64_t{1} << 3 * cell.level;
        return false;
      }
      reaches_in = reaches_in || (cell.level > 0 && found.distance <= padding + half_diagonal);
    }
    if (!reaches_in) {
      others.voxels.push_back(cell);
      return true;
    }
    const std::size_t before = others.voxels.size();
    bool whole = true;
    for (unsigned child = 0; child < 8; ++child) whole = split(childOf(cell, child), others) && whole;
    if (whole) {
      others.voxels.resize(before);
      others.voxels.push_back(cell);
    }
    return whole;
  }

 private:
  struct Placed {
    const SelfShape* shape;
    Eigen::AlignedBox3d box;  // [m, map frame] box around the padded shape
  };

  double edge_;
  const Pose& world_from_map_;
  const NarrowPhase& narrow_phase_;
  std::shared_ptr<const Solid> point_;
  std::vector<Placed> placed_;
  std::size_t looks_ = 0;
};

}  // namespace

OthersCells withoutSelf(const std::vector<Voxel>& voxels, double edge, const Pose& world_from_map,
                        const std::vector<SelfShape>& shapes, const NarrowPhase& narrow_phase) {
  Splitter splitter(edge, world_from_map, shapes, narrow_phase);
  OthersCells others;
  others.voxels.reserve(voxels.size());
  auto rest = voxels.begin();
  for (const Voxel& near : splitter.nearShapes(voxels)) {
    for (; *rest != near; ++rest) others.voxels.push_back(*rest);
    splitter.split(near, others);
    ++rest;
  }
  others.voxels.insert(others.voxels.end(), rest, voxels.end());
  return others;
}

}  // namespace hgrid
