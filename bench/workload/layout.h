// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "bench/workload/walker.h"

namespace hgrid {
namespace bench {

/// The boxes of a world in frame 0, and where each of them may walk.
///
/// The center of box i is the sum of its walker, its rest position (if the layout has any), and the base of its robot
/// (if the layout has robots).
struct Layout {
  static constexpr std::size_t kLinks = 30;  ///< boxes of one robot; the last robot has what is left

  double side = 0.0;                    ///< [m] side of the cube or square that the boxes stand in
  std::deque<Region> regions;           ///< walkers point to them; a deque keeps them where they are
  std::vector<Walker> walkers;          ///< one per box
  std::vector<Walker> bases;            ///< one per robot; empty: no robots
  std::vector<Eigen::Vector3f> rests;   ///< [m] one per box, or empty
  std::vector<Eigen::Vector3f> halves;  ///< [m] half of each box's edges

  Layout() = default;
  Layout(Layout&&) = default;
  Layout& operator=(Layout&&) = default;
  Layout(const Layout&) = delete;  // its walkers would point to the regions of the other one
  Layout& operator=(const Layout&) = delete;

  /// Adds a region, and returns a reference that stays valid for as long as the layout and what it is moved to.
  const Region& addRegion(const Eigen::Vector3f& low, const Eigen::Vector3f& high);

  /// Adds a cube that walks in a region.
  void addCube(double edge, const Eigen::Vector3f& center, const Region& region);

  /// Adds a box that walks in a region. @param size  [m] a step is 1 to 5 % of it
  void addBox(const Eigen::Vector3f& edges, float size, const Eigen::Vector3f& center, const Region& region);

  /// Adds a box that stays near its rest position. @param sway  how far it may be off, around zero
  void addSwaying(const Eigen::Vector3f& edges, float size, const Eigen::Vector3d& rest, const Region& sway);
};

/// A random point of a region.
Eigen::Vector3f randomPoint(Random& random, const Region& region);

/// The edge of a cube as most workloads have them: 0.8 .. 1.2 m.
inline double usualEdge(Random& random) { return random.uniform(0.8, 1.2); }

/// [m] Side of a cube in which n cubes of the usual edges have about one overlap each.
double usualSide(double n);

}  // namespace bench
}  // namespace hgrid
