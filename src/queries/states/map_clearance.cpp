// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "queries/states/map_clearance.h"

#include "queries/states/four_boxes.h"

namespace hgrid {
namespace {

constexpr float kPointRounding = 2e-6f;  // relative bound of the rounding errors of a point in the frame of the map

/// Returns one bit for each lane: whether `a` is greater than `b`.
unsigned bitsWhereGreater(const Four& a, const Four& b) { return bitsOf(reinterpret_cast<FourCounts>(a > b)); }

}  // namespace

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
  Four center[3], size = allFour(1.0f);
  for (std::size_t row = 0; row < 3; ++row) {
    center[row] = turned(box.center, row) + shift_[row];
    size += absolute(box.center[row]) * per_edge_ + std::abs(shift_[row]);
  }
  const Four more = reach * per_edge_ + size * kPointRounding;
  const unsigned wholly = bitsWhereGreater(blocks_->lowerBounds(center), more + cover.whole * per_edge_) & lanes;
  if (wholly == lanes || cover.count[0] * cover.count[1] == 1) return wholly;
  Four steps[2][3];
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t row = 0; row < 3; ++row) {
      steps[i][row] = turned(box.axes[cover.axis[i]], row) * cover.step[i];
      center[row] -= steps[i][row] * (0.5f * static_cast<float>(cover.count[i] - 1));
    }
  }
  const Four least = more + cover.radius * per_edge_;
  unsigned far = lanes & ~wholly;
  for (std::uint32_t i = 0; i < cover.count[0]; ++i) {
    Four point[3] = {center[0], center[1], center[2]};
    for (std::uint32_t k = 0; k < cover.count[1]; ++k) {
      far &= bitsWhereGreater(blocks_->lowerBounds(point), least);
      if (far == 0) return wholly;
      for (std::size_t row = 0; row < 3; ++row) point[row] += steps[1][row];
    }
    for (std::size_t row = 0; row < 3; ++row) center[row] += steps[0][row];
  }
  return wholly | far;
}

}  // namespace hgrid
