// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "test/support/grids.h"
#include "test/support/sweep.h"

namespace hgrid {
namespace test {

/// A world of boxes that changes at random. It stores the boxes in a grid and, for comparison, in a plain array.
class ChurnWorld {
 public:
  explicit ChurnWorld(unsigned seed);

  /// Begins another kind of world: with other numbers, sizes and distances of boxes, and other settings of the grid.
  void begin(std::size_t most_boxes);
  /// Makes one random change. It can be a move of a single box, an update of all boxes, or anything between.
  void act();
  /// Compares the pairs and the answers of some queries with a scan of all boxes.
  void check();

  const HGrid& grid() const { return grid_; }
  std::size_t mostBoxes() const { return boxes_.size(); }  ///< number of ids in the largest world so far
  std::size_t changes() const { return changes_; }
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
  std::size_t most_ = 0, changes_ = 0, pairs_seen_ = 0;  // most_: number of ids in the current world
  double hall_ = 1.0, smallest_ = 0.1, largest_ = 1.0;
  bool lattice_ = false, filtered_ = false;
  std::vector<Aabb> boxes_;  // the index is the id of the box
  std::vector<bool> stored_, fixed_;
};

}  // namespace test
}  // namespace hgrid
