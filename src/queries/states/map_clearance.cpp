// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/map_clearance.h"

#include "queries/states/cover_clearance.h"

namespace hgrid {

MapClearance::MapClearance(const PlacedMap& map, const Eigen::Vector3d& origin) : blocks_(map.cells.distances.get()) {
  if (blocks_ == nullptr) return;
  const double edge = blocks_->edge();
  const Eigen::Vector3d shift = (map.map_from_world * origin - blocks_->corner()) / edge;
  for (Eigen::Index row = 0; row < 3; ++row) {
    shift_[row] = static_cast<float>(shift[row]);
    for (Eigen::Index k = 0; k < 3; ++k) turn_[row][k] = static_cast<float>(map.map_from_world.linear()(row, k) / edge);
  }
  per_edge_ = static_cast<float>(1.0 / edge);
}

unsigned MapClearance::farther(const FourShapes& shape, const SphereCover& cover, const Four& reach,
                               unsigned lanes) const {
  if (blocks_ == nullptr) return 0;
  const TiltedBox<Four>& box = shape.box;
  const auto turned = [&](const Four(&vector)[3], std::size_t row) {
    return allFour(turn_[row][0]) * vector[0] + allFour(turn_[row][1]) * vector[1] + allFour(turn_[row][2]) * vector[2];
  };
  Four center[3], size = allFour(1.0f + cover.whole * per_edge_);
  for (std::size_t row = 0; row < 3; ++row) {
    center[row] = turned(box.center, row) + shift_[row];
    size += absolute(box.center[row]) * per_edge_ + std::abs(shift_[row]);
  }
  const Four more = (reach + shape.rounding) * per_edge_ + size * kPointRounding;
  const auto axis = [&](std::size_t i, std::size_t row) { return turned(box.axes[cover.axis[i]], row); };
  return coverIsFarther(cover, center, axis, per_edge_, more, lanes,
                        [this](const Four(&points)[3]) { return blocks_->lowerBounds(points); });
}

}  // namespace hgrid
