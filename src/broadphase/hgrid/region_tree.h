// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadphase/kernels/kernels.h"
#include "hgrid_proximity/broadphase/broad_phase.h"
#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {

/// A k-d tree (Ericson 2005, 7.3.7) that divides space into regions in which boxes are spread evenly.
///
/// One grid suits boxes that are spread evenly. Where they are not, its cells are far too large for the dense places.
/// So each region gets a grid of its own. A box belongs to the region of its minimum corner, and may reach into others.
class RegionTree {
 public:
  /// One region: all space.
  RegionTree();

  /// Divides space for the boxes of `count` ids. Boxes that are spread evenly are one region.
  ///
  /// Regions are chosen by the likelihood of the boxes' minimum corners, if each region is evenly filled: a split must
  /// raise the logarithm of that likelihood by more than what a split costs.
  static RegionTree dividing(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count);

  /// Makes all space one region again. Allocates nothing.
  void join();

  std::size_t size() const { return regions_.size(); }
  const kernels::Region& region(std::size_t number) const { return regions_[number]; }
  const kernels::Region* regions() const { return regions_.data(); }
  const kernels::Branch* branches() const { return branches_.data(); }
  /// Number of the region of a minimum corner.
  std::uint32_t regionOf(const float* corner) const;
  void setLevels(std::size_t region, std::uint32_t first_level, std::uint32_t levels);

  std::size_t bytes() const;

 private:
  static constexpr int kMostDepth = 62;
  class Division;

  std::vector<kernels::Branch> branches_;  // each before its parts
  std::vector<kernels::Region> regions_;
};

}  // namespace hgrid
