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

/// What a peer is told of a frame: all boxes, which ones moved (ids ascending), and those alone once more.
struct Frame {
  const std::vector<Aabb>& boxes;
  const std::vector<ProxyId>& moved;
  const std::vector<Aabb>& moved_boxes;
};

/// Which boxes move in a frame, where only a fraction does.
enum class Movers {
  same,      ///< the same ones in every frame
  changing,  ///< others in every frame, chosen at random
};

const char* name(Movers movers);

/// n moving boxes of one workload; two worlds of the same arguments are equal in every frame.
class World {
 public:
  /// @param moving  fraction of the boxes that move in a frame; of robots whole ones.
  /// @throws std::invalid_argument if there is no such workload.
  World(const std::string& workload, std::size_t n, double moving, Movers movers = Movers::same);

  /// Back to frame 0.
  void reset();
  /// On to the next frame.
  void step();

  std::uint64_t frameNumber() const { return frame_; }
  Frame frame() const { return {boxes_, moved_, moved_boxes_}; }
  const std::vector<Aabb>& boxes() const { return boxes_; }
  /// [m] Side of the cube or square that the boxes stand in.
  double side() const { return layout_.side; }

 private:
  void chooseMoved();
  void place(std::size_t i);

  std::size_t n_;
  Layout layout_;
  std::vector<Walker> first_walkers_, first_bases_;
  Movers movers_;
  std::size_t moved_groups_;
  Random choice_;                // of the groups that move
  std::vector<ProxyId> groups_;  // single boxes, or robots; those that move are shuffled to the front
  std::uint64_t frame_ = 0;
  std::vector<Aabb> boxes_;
  std::vector<ProxyId> moved_;
  std::vector<ProxyId> moved_bases_;
  std::vector<Aabb> moved_boxes_;
};

}  // namespace bench
}  // namespace hgrid
