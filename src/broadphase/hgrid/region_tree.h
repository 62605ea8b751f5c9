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

  /// Bounds of the boxes of each region, as they are now. Levels follow each other by region.
  void setBounds(const std::vector<kernels::Level>& levels);
  /// All boxes of the region are within.
  const kernels::Box& boundsOf(std::size_t region) const { return bounds_[leaf_[region]]; }

  /// Calls visit(region) for the regions whose bounds pass the test, in ascending order.
  /// @param test  as in bool test(const kernels::Box&); if it holds for a box, then also for all boxes that contain it
  template <class Test, class Visit>
  void visit(const Test& test, const Visit& visit) const {
    std::uint32_t stack[kMostDepth + 2];
    int waiting = 0;
    for (std::uint32_t number = 0;;) {
      const kernels::Branch& branch = branches_[number];
      if (test(bounds_[number])) {
        if (branch.axis >= 0) {
          stack[waiting++] = branch.above;
          number = branch.below;
          continue;
        }
        visit(branch.below);
      }
      if (waiting == 0) return;
      number = stack[--waiting];
    }
  }

  std::size_t bytes() const;

 private:
  static constexpr int kMostDepth = 62;
  class Division;

  std::vector<kernels::Branch> branches_;  // each before its parts
  std::vector<kernels::Region> regions_;
  std::vector<std::uint32_t> leaf_;   // by region: number of its branch
  std::vector<kernels::Box> bounds_;  // by branch: of all boxes of its regions
};

}  // namespace hgrid
