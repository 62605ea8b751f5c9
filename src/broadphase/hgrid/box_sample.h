// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// The minimum corners of some of the boxes, sorted along each axis. Estimates how all boxes are distributed along one
/// axis, also if they are spread unevenly. Allocates nothing.
class BoxSample {
 public:
  /// Takes a sample of the boxes of `count` ids, at least one.
  BoxSample(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count);

  /// Returns the coordinate [m] below which 1 % of the minimum corners are.
  double low(std::size_t axis) const { return sorted_[axis][size_ / 100]; }
  /// Returns the coordinate [m] above which 1 % of the minimum corners are.
  double high(std::size_t axis) const { return sorted_[axis][size_ - 1 - size_ / 100]; }
  /// Estimates how many other boxes have their minimum within `length` [m] after the minimum of a box. Averages over
  /// all boxes.
  double followers(std::size_t axis, double length) const;

 private:
  static constexpr std::size_t kMost = 256;

  std::array<std::array<float, kMost>, 3> sorted_;
  std::size_t size_ = 0;
  double boxes_per_sample_;
};

}  // namespace hgrid
