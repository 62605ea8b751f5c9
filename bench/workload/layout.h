// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "bench/workload/walker.h"

namespace hgrid {
namespace bench {

/// The boxes of a world before the first step (frame 0), and the region in which each box may move.
///
/// The center of box i is a sum: the position of its walker, its rest position if there are rest positions, and the
/// position of the base of its robot if there are robots.
struct Layout {
  static constexpr std::size_t kLinks = 30;  ///< number of boxes of a robot; the last robot may have fewer

  double side = 0.0;                    ///< [m] side of the cube or square that the boxes are in
  std::deque<Region> regions;           ///< walkers point to the regions; a deque never moves its elements
  std::vector<Walker> walkers;          ///< one per box, moves the box
  std::vector<Walker> bases;            ///< one per robot, moves its base; empty: no robots
  std::vector<Eigen::Vector3f> rests;   ///< [m] rest positions by box; empty if there are none
  std::vector<Eigen::Vector3f> halves;  ///< [m] for each box: half of its edge lengths

  Layout() = default;
  Layout(Layout&&) = default;
  Layout& operator=(Layout&&) = default;
  Layout(const Layout&) = delete;  // walkers of a copy would point to regions of the original
  Layout& operator=(const Layout&) = delete;

  /// Adds a region. The reference is valid while this layout exists, or the layout that this one is moved to.
  const Region& addRegion(const Eigen::Vector3f& low, const Eigen::Vector3f& high);

  /// Adds a cube whose center moves in a region.
  void addCube(double edge, const Eigen::Vector3f& center, const Region& region);

  /// Adds a box whose center moves in a region. @param size  [m] each step of the center is 1 to 5 % of this length
  void addBox(const Eigen::Vector3f& edges, float size, const Eigen::Vector3f& center, const Region& region);

  /// Adds a box that stays near its rest position.
  /// @param size  [m] each step of the center is 1 to 5 % of this length
  /// @param sway  [m] region of the offsets from the rest position
  void addSwaying(const Eigen::Vector3f& edges, float size, const Eigen::Vector3d& rest, const Region& sway);
};

/// Returns a random point in a region.
Eigen::Vector3f randomPoint(Random& random, const Region& region);

/// Returns a random edge length of 0.8 .. 1.2 m, which most workloads use for their cubes.
inline double usualEdge(Random& random) { return random.uniform(0.8, 1.2); }

/// Returns the side [m] of a cube of space in which each of n cubes with usualEdge() has about one overlap.
double usualSide(double n);

}  // namespace bench
}  // namespace hgrid
