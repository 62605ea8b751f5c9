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
/// If boxes are spread evenly, a single grid is good. If not, its cells are far too large in dense places. So each
/// region has its own grid. A box belongs to the region of its minimum corner; it may extend into other regions.
class RegionTree {
 public:
  /// Creates a tree with one region, which is all space.
  RegionTree();

  /// Divides space for the boxes of `count` ids. If the boxes are spread evenly, there is one region.
  ///
  /// The model is that minimum corners are spread evenly within each region. A split is made only if it raises the
  /// log-likelihood of the corners by more than the cost of a split.
  static RegionTree dividing(const std::vector<Aabb>& boxes, const ProxyId* ids, std::size_t count);

  /// Makes all space one region again. Allocates nothing.
  void join();

  std::size_t size() const { return regions_.size(); }
  const kernels::Region& region(std::size_t number) const { return regions_[number]; }
  const kernels::Region* regions() const { return regions_.data(); }
  const kernels::Branch* branches() const { return branches_.data(); }
  /// Returns the index of the region that contains a minimum corner.
  std::uint32_t regionOf(const float* corner) const;
  /// Sets the levels of a region. `first_level` is the index of the first of them among the levels of all regions,
  /// `levels` is how many there are.
  void setLevels(std::size_t region, std::uint32_t first_level, std::uint32_t levels);

  /// Returns the allocated memory [bytes].
  std::size_t bytes() const;

 private:
  static constexpr int kMostDepth = 62;
  class Division;

  std::vector<kernels::Branch> branches_;  // each branch is stored before its parts
  std::vector<kernels::Region> regions_;
};

}  // namespace hgrid
