// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/maps/cloud_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

CloudCells::CloudCells(double edge, Time lifetime, std::size_t most)
    : edge_(edge), per_edge_(1.0 / edge), lifetime_(lifetime), most_(most) {}

CloudCells::Keys CloudCells::keysOf(const Eigen::Vector3d& point) const {
  Keys keys;
  // Multiplies like OctoMap, so that a point is in the same cell in a cloud and in a map.
  for (int axis = 0; axis < 3; ++axis) {  // like std::floor, but without a call; -0.1 is in cell -1
    const double cells = point[axis] * per_edge_;
    const auto whole = static_cast<std::int64_t>(cells);
    keys[static_cast<std::size_t>(axis)] = whole - (cells < static_cast<double>(whole) ? 1 : 0);
  }
  return keys;
}

Eigen::Vector3d CloudCells::corner() const {
  return edge_ * Eigen::Vector3d(static_cast<double>(middle_[0]), static_cast<double>(middle_[1]),
                                 static_cast<double>(middle_[2]));
}

std::size_t CloudCells::follow(const Eigen::Vector3d& sensor) {
  const Keys keys = keysOf(sensor);
  bool far = false;
  for (std::size_t axis = 0; axis < 3; ++axis) far = far || std::abs(keys[axis] - middle_[axis]) >= kReach;
  if (!far) return 0;
  Keys step;
  for (std::size_t axis = 0; axis < 3; ++axis) step[axis] = keys[axis] - middle_[axis];
  std::vector<Seen> kept;
  for (const Seen& one : seen_) {
    const Voxel voxel = finestVoxelOf(one.code);
    const Keys moved{voxel.x - step[0], voxel.y - step[1], voxel.z - step[2]};
    if (std::any_of(moved.begin(), moved.end(), [](std::int64_t key) { return key < 0 || key > 0xffff; })) continue;
    const Voxel there{static_cast<std::uint16_t>(moved[0]), static_cast<std::uint16_t>(moved[1]),
                      static_cast<std::uint16_t>(moved[2]), 0};
    kept.push_back({mortonOf(there), one.stamp});
  }
  std::sort(kept.begin(), kept.end(), [](const Seen& a, const Seen& b) { return a.code < b.code; });
  middle_ = keys;
  seen_.swap(kept);
  return kept.size() - seen_.size();
}

std::vector<Voxel> CloudCells::cellsOf(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& sensor,
                                       std::size_t& left_out) const {
  left_out = 0;
  const Keys from = keysOf(sensor);
  const double reach = edge_ * kReach;
  std::vector<std::uint64_t> codes;
  Keys last{};
  for (const Eigen::Vector3d& point : points) {
    if (!((point - sensor).cwiseAbs().maxCoeff() < reach + edge_)) {  // the keys of a point far away might overflow
      ++left_out;
      continue;
    }
    const Keys keys = keysOf(point);
    if (!codes.empty() && keys == last) continue;  // points next to each other in a scan are mostly in the same cell
    Voxel voxel;
    bool near = true;
    std::uint16_t* const key_of[] = {&voxel.x, &voxel.y, &voxel.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      near = near && std::abs(keys[axis] - from[axis]) < kReach;
      *key_of[axis] = static_cast<std::uint16_t>(keys[axis] - middle_[axis] + Voxel::kOriginKey);
    }
    if (!near) {
      ++left_out;
      continue;
    }
    last = keys;
    codes.push_back(mortonOf(voxel));
  }
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  std::vector<Voxel> cells(codes.size());
  std::transform(codes.begin(), codes.end(), cells.begin(), finestVoxelOf);
  return cells;
}

void CloudCells::see(const std::vector<Voxel>& cells, Time stamp) {
  std::vector<Seen> all;
  all.reserve(seen_.size() + cells.size());
  auto known = seen_.begin();
  for (const Voxel& cell : cells) {
    const std::uint64_t code = mortonOf(cell);
    for (; known != seen_.end() && known->code < code; ++known) all.push_back(*known);
    Time newest = stamp;
    if (known != seen_.end() && known->code == code) newest = std::max(newest, (known++)->stamp);
    all.push_back({code, newest});
  }
  all.insert(all.end(), known, seen_.end());
  if (all.size() > most_) {
    throw Refusal(Code::limit, "there would be " + std::to_string(all.size()) + " cells; at most " +
                                   std::to_string(most_) + " are allowed");
  }
  seen_.swap(all);
}

std::size_t CloudCells::forget(Time now) {
  const std::size_t before = seen_.size();
  seen_.erase(
      std::remove_if(seen_.begin(), seen_.end(),
                     [&](const Seen& one) { return now - one.stamp > lifetime_ || one.stamp - now > lifetime_; }),
      seen_.end());
  return before - seen_.size();
}

std::vector<Voxel> CloudCells::cells() const {
  std::vector<Voxel> cells(seen_.size());
  std::transform(seen_.begin(), seen_.end(), cells.begin(), [](const Seen& one) { return finestVoxelOf(one.code); });
  return cells;
}

}  // namespace hgrid
