// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/workload/layout.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// One frame, which is one time step of the benchmark: all boxes, the ids of the boxes that moved in ascending order,
/// and the boxes with these ids.
struct Frame {
  const std::vector<Aabb>& boxes;
  const std::vector<ProxyId>& moved;
  const std::vector<Aabb>& moved_boxes;
};

/// Selects the boxes that move in a frame (time step) if only a fraction of the boxes moves.
enum class Movers {
  same,      ///< the same boxes move in all frames
  changing,  ///< different boxes move in each frame; they are chosen at random
};

const char* name(Movers movers);

/// The n moving boxes of one workload. Two worlds with the same arguments are equal in every frame.
class World {
 public:
  /// @param moving  fraction of the boxes that move in a frame; all boxes of a robot move together
  /// @throws std::invalid_argument if there is no such workload.
  World(const std::string& workload, std::size_t n, double moving, Movers movers = Movers::same);
  /// A world in which all boxes move to and fro: `even` holds the boxes of all frames with an even number, `odd` the
  /// others. Both have the same size.
  World(std::vector<Aabb> even, std::vector<Aabb> odd);

  /// Goes back to frame 0.
  void reset();
  /// Moves the boxes to their places in the next frame.
  void step();

  std::uint64_t frameNumber() const { return frame_; }
  Frame frame() const { return {boxes_, moved_, moved_boxes_}; }
  const std::vector<Aabb>& boxes() const { return boxes_; }
  /// Returns the side [m] of the cube or square that the boxes are in.
  double side() const { return layout_.side; }

 private:
  void chooseMoved();
  void place(std::size_t i);

  std::size_t n_;
  Layout layout_;
  std::vector<Aabb> even_, odd_;  // empty if walkers move the boxes
  std::vector<Walker> first_walkers_, first_bases_;
  Movers movers_ = Movers::same;
  std::size_t moved_groups_ = 0;
  Random choice_{0};             // selects the groups that move
  std::vector<ProxyId> groups_;  // indices of boxes or of robots; those that move come first
  std::uint64_t frame_ = 0;
  std::vector<Aabb> boxes_;
  std::vector<ProxyId> moved_;
  std::vector<ProxyId> moved_bases_;
  std::vector<Aabb> moved_boxes_;
};

}  // namespace bench
}  // namespace hgrid
