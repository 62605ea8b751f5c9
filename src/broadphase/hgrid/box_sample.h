// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {

/// Returns a pseudorandom number (the output function of SplitMix64; Steele, Lea and Flood 2014).
///
/// Samples use it, because the ids of boxes may be ordered with a period, for example link after link and robot after
/// robot. Boxes at equal distances in the list may then be of one kind or at one place. So each part of the list gives
/// the box at a random place of it.
constexpr std::uint64_t scattered(std::uint64_t number) {
  std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// Returns a pseudorandom number below `range`, which must be at most 2^32. Divides nothing, because that is slow.
constexpr std::size_t scatteredBelow(std::size_t range, std::uint64_t number) {
  return static_cast<std::size_t>(((scattered(number) >> 32) * range) >> 32);
}

/// A sample of boxes. It stores their minimum corners and estimates from them how all boxes are distributed along an
/// axis, even if they are spread unevenly. Allocates nothing.
class BoxSample {
 public:
  /// Samples at most 256 of the boxes of `count` ids. `count` must be at least 1.
  BoxSample(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count);

  /// Estimates the coordinate [m] below which 1 % of the minimum corners are. For fewer than 100 boxes, returns the
  /// lowest of them.
  double low(std::size_t axis) const { return low_[axis]; }
  /// Estimates the coordinate [m] above which 1 % of the minimum corners are. For fewer than 100 boxes, returns the
  /// highest of them.
  double high(std::size_t axis) const { return high_[axis]; }
  /// Estimates how many boxes follow a box along the axis, on average: their minimum is at most `length` [m] above the
  /// minimum of the box. The estimate is too low if the ids are ordered so that the sample has one box of each cluster.
  double followers(std::size_t axis, double length) const;
  /// Estimates a number that followers() is hardly ever below if boxes are spread evenly, from a few of the sampled
  /// boxes. If they are clustered, it is too high more often. Takes a small part of the time of followers().
  double leastFollowers(std::size_t axis, double length) const;

  /// Returns whether boxes that are near each other on this axis are also near each other on the other two, so that the
  /// bounds of successive boxes are small.
  /// @param sides  [m] mean sides of the boxes
  bool isThin(std::size_t axis, const std::array<double, 3>& sides) const;

 private:
  static constexpr std::size_t kMost = 256;  // largest number of sampled boxes

  /// Returns the coordinates of the sampled minimum corners on an axis, in the order of the ids.
  std::array<float, kMost> onAxis(std::size_t axis) const;

  std::array<std::array<float, 3>, kMost> corners_;  // in the order of the ids
  std::array<float, 3> low_, high_;                  // see low() and high()
  std::size_t size_ = 0;
  double boxes_per_sampled_box_;
};

}  // namespace hgrid
