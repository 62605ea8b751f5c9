// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "distances/map_meter.h"

#include <algorithm>

#include "geometry/infinity.h"
#include "maps/map_gap.h"
#include "narrow/measured_contact.h"

namespace hgrid {
namespace {

/// A pair of bodies. One of them is a map or cloud, the other has shapes.
class MapPair {
 public:
  MapPair(const Snapshot& snapshot, std::uint32_t first, std::uint32_t second)
      : snapshot_(snapshot),
        map_first_(snapshot.structure().isMap(first)),
        map_(map_first_ ? first : second),
        body_(map_first_ ? second : first),
        cells_(snapshot.cellsOf(map_)),
        map_from_world_(snapshot.poses()[map_].world_from_body.inverse()) {}

  /// Calls `look` for each shape and each voxel that is at most `limit` [m] from the box of the shape. Does nothing if
  /// isReady() is false.
  /// @param look  called as double look(index of the shape, voxel, first solid of the pair, second solid); returns the
  ///              new limit [m]; a negative limit ends the visit
  template <class Look>
  void visit(double limit, const Look& look) const {
    if (!isReady()) return;
    const Structure& structure = snapshot_.structure();
    const std::vector<BodyShape>& shapes = structure.bodies[body_].shapes;
    for (std::uint32_t i = 0; i < shapes.size() && limit >= 0.0; ++i) {
      const BodyShape& shape = shapes[i];
      const Pose world_from_shape = snapshot_.poses()[body_].world_from_body * shape.body_from_shape;
      const Aabb& box = snapshot_.boxes()[structure.first_proxy[body_] + i];
      cells_->grid->visitNear(boxInMap(map_from_world_, box, snapshot_.origin()), limit,
                              [&](const Voxel& voxel, double) {
                                const Pose world_from_cube = worldFromCube(voxel);
                                const PlacedSolid own{*shape.solid, world_from_shape, shape.padding};
                                const PlacedSolid cube{*cells_->cubes[voxel.level], world_from_cube, 0.0};
                                limit = map_first_ ? look(i, voxel, cube, own) : look(i, voxel, own, cube);
                                return limit;
                              });
    }
  }

  Pose worldFromCube(const Voxel& voxel) const {
    return snapshot_.poses()[map_].world_from_body * Eigen::Translation3d(cells_->centerOf(voxel));
  }
  NearCell cellOf(const Voxel& voxel, double distance) const {
    return {worldFromCube(voxel).translation(), edgeOf(voxel, cells_->grid->finestEdge()), distance};
  }
  bool mapIsFirst() const { return map_first_; }
  /// Returns whether both bodies can be measured: the map has cells, the other body has shapes, and there is a solid
  /// for each cell and shape.
  bool isReady() const {
    const std::vector<BodyShape>& shapes = snapshot_.structure().bodies[body_].shapes;
    return cells_ && cells_->cubes.front() && !shapes.empty() &&
           std::all_of(shapes.begin(), shapes.end(), [](const BodyShape& shape) { return shape.solid != nullptr; });
  }

 private:
  const Snapshot& snapshot_;
  bool map_first_;
  std::uint32_t map_, body_;
  std::shared_ptr<const MapCells> cells_;
  Pose map_from_world_;
};

}  // namespace

MapProximity measureMap(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                        std::uint32_t second, double up_to) {
  MapProximity nearest;
  nearest.proximity.status = Measure::apart;
  nearest.proximity.distance = kInfinity;
  double least_bound = kInfinity;
  const MapPair pair(snapshot, first, second);
  if (!pair.isReady()) return {};
  pair.visit(up_to, [&](std::uint32_t shape, const Voxel& voxel, const PlacedSolid& a, const PlacedSolid& b) {
    const bool full = nearest.cells.size() == kNearCells;
    const double limit = full ? nearest.cells.back().distance : up_to;
    const Proximity found = narrow_phase.measure(a, b, limit);
    if (!(found.distance <= limit)) return limit;
    least_bound = std::min(least_bound, found.lower_bound);
    if (found.distance < nearest.proximity.distance) {
      nearest.shape = shape;
      nearest.proximity = found;
      nearest.contact = measuredContact(narrow_phase, a, b, found.status);
    }
    NearCell cell = pair.cellOf(voxel, found.distance);
    auto& cells = nearest.cells;
    // Another shape of the body may have added the same cell before.
    const auto same =
        std::find_if(cells.begin(), cells.end(), [&](const NearCell& known) { return known.center == cell.center; });
    if (same != cells.end()) {
      cell.distance = std::min(cell.distance, same->distance);
      cells.erase(same);
    } else if (full) {
      cells.pop_back();
    }
    cells.insert(std::upper_bound(cells.begin(), cells.end(), cell,
                                  [](const NearCell& m, const NearCell& n) { return m.distance < n.distance; }),
                 cell);
    if (cells.size() < kNearCells) return up_to;
    return cells.back().distance > 0.0 ? cells.back().distance : kNoFurther;
  });
  if (nearest.proximity.status == Measure::apart) nearest.proximity.lower_bound = least_bound;
  return nearest;
}

std::vector<PairContact> contactsWithMap(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                         std::uint32_t second, std::size_t most) {
  std::vector<PairContact> contacts;
  const MapPair pair(snapshot, first, second);
  pair.visit(0.0, [&](std::uint32_t shape, const Voxel&, const PlacedSolid& a, const PlacedSolid& b) {
    for (const Contact& contact : narrow_phase.contacts(a, b, most - contacts.size())) {
      contacts.push_back({pair.mapIsFirst() ? 0 : shape, pair.mapIsFirst() ? shape : 0, contact});
    }
    return contacts.size() < most ? 0.0 : kNoFurther;
  });
  return contacts;
}

}  // namespace hgrid
