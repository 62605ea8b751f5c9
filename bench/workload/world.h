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

/// The input of a peer for one frame: all boxes, the ids of the boxes that moved (ascending), and these boxes again.
struct Frame {
  const std::vector<Aabb>& boxes;
  const std::vector<ProxyId>& moved;
  const std::vector<Aabb>& moved_boxes;
};

/// Which boxes move in a frame if only a fraction of them moves.
enum class Movers {
  same,      ///< the same boxes in every frame
  changing,  ///< other boxes in each frame, chosen at random
};

const char* name(Movers movers);

/// The n moving boxes of one workload. Two worlds with the same arguments are equal in every frame.
class World {
 public:
  /// @param moving  fraction of the boxes that move in a frame; a robot moves as a whole
  /// @throws std::invalid_argument if there is no such workload.
  World(const std::string& workload, std::size_t n, double moving, Movers movers = Movers::same);

  /// Goes back to frame 0.
  void reset();
  /// Goes on to the next frame: moves the boxes.
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
  std::vector<Walker> first_walkers_, first_bases_;
  Movers movers_;
  std::size_t moved_groups_;
  Random choice_;                // selects the groups that move
  std::vector<ProxyId> groups_;  // numbers of single boxes or of robots; those that move come first
  std::uint64_t frame_ = 0;
  std::vector<Aabb> boxes_;
  std::vector<ProxyId> moved_;
  std::vector<ProxyId> moved_bases_;
  std::vector<Aabb> moved_boxes_;
};

}  // namespace bench
}  // namespace hgrid
