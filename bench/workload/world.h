// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bench/workload/walker.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// What a peer is told of a frame: all boxes, which ones moved (ids ascending), and those alone once more.
struct Frame {
  const std::vector<Aabb>& boxes;
  const std::vector<ProxyId>& moved;
  const std::vector<Aabb>& moved_boxes;
};

/// Names of the workloads: uniform, mixed, floor, robots.
const std::vector<std::string>& workloads();

/// n moving boxes of one workload; two worlds of the same arguments are equal in every frame.
///
/// - uniform: cubes of edge 0.8 .. 1.2, centres in a cube of side (4n)^(1/3): about one overlap per box.
/// - mixed: cubes with edges log-uniform over 0.01 .. 10, the cube's side chosen for about as many overlaps.
/// - floor: cubes as in uniform over a square of side (2n)^(1/2), 90 % within 0.1 of the ground, the others up to 20.
/// - robots: chains of 30 boxes (the last one what is left) on a square of side 1.5 (n/30)^(1/2); links share the
///   motion of their base and sway against each other.
class World {
 public:
  /// @param moving  fraction of the boxes that move, always the same ones; of robots whole ones.
  /// @throws std::invalid_argument if there is no such workload.
  World(const std::string& workload, std::size_t n, double moving);

  /// Back to frame 0.
  void reset();
  /// On to the next frame.
  void step();

  std::uint64_t frameNumber() const { return frame_; }
  Frame frame() const { return {boxes_, moved_, moved_boxes_}; }
  const std::vector<Aabb>& boxes() const { return boxes_; }
  /// [m] Side of the cube or square that the boxes stand in.
  double side() const { return side_; }

 private:
  static constexpr std::size_t kLinks = 30;

  void makeCubes(const std::string& workload);
  void makeRobots();
  void chooseMoving(double fraction);
  void place(std::size_t i);

  std::size_t n_;
  double side_ = 0.0;
  std::unique_ptr<Region[]> regions_;    // walkers point to them
  std::vector<Walker> walkers_, bases_;  // one per box; one per robot
  std::vector<Eigen::Vector3f> rest_;    // of a robot's link, from its base
  std::vector<Eigen::Vector3f> half_;    // half of each box's edges
  std::vector<Walker> first_walkers_, first_bases_;
  std::uint64_t frame_ = 0;
  std::vector<Aabb> boxes_;
  std::vector<ProxyId> moved_;
  std::vector<ProxyId> moved_bases_;
  std::vector<Aabb> moved_boxes_;
};

}  // namespace bench
}  // namespace hgrid
