// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "test/support/grids.h"
#include "test/support/sweep.h"

namespace hgrid {
namespace test {

/// A world that comes, goes, moves and grows at random, in a grid and beside it in a plain array.
class ChurnWorld {
 public:
  explicit ChurnWorld(unsigned seed);

  /// Another kind of world: how many boxes, how large, how far apart; how the grid works.
  void begin(std::size_t most_boxes);
  /// One random deed, from the move of one box to an update of all.
  void act();
  /// Compares pairs and some queries with what a look at all boxes finds.
  void check();

  const HGrid& grid() const { return grid_; }
  std::size_t mostBoxes() const { return boxes_.size(); }  ///< of all worlds so far
  std::size_t deeds() const { return deeds_; }
  std::size_t pairsSeen() const { return pairs_seen_; }

 private:
  Aabb someBox();
  Aabb changed(const Aabb& box);
  std::vector<ProxyId> storedIds() const;
  void actOnOne(ProxyId id);
  void moveSome();
  void updateAll(double kept, double coming);
  void fixOthers();
  void expectRightPairs();
  void expectRightQueries();

  Random random_;
  HGrid grid_;
  std::size_t most_ = 0, deeds_ = 0, pairs_seen_ = 0;  // most_: ids of the present world
  double hall_ = 1.0, smallest_ = 0.1, largest_ = 1.0;
  bool lattice_ = false, filtered_ = false;
  std::vector<Aabb> boxes_;  // by id
  std::vector<bool> stored_, fixed_;
};

}  // namespace test
}  // namespace hgrid
