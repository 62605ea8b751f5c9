// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <unordered_map>

#include "partitions/id_set.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// Spreads the lowest 21 bits of a number: bit i moves to bit 3 i (section 7.3.5, for 64 bits).
std::uint64_t spreadBits(std::uint64_t value);
/// The locational code of a node (section 7.3.4): its three indices interleaved (Morton order), after a leading 1 bit
/// that encodes the depth. The root is 1; the children of a node are 8 * code .. 8 * code + 7.
std::uint64_t nodeCode(int depth, std::uint64_t x, std::uint64_t y, std::uint64_t z);

/// A loose, linear octree (Ericson, Real-Time Collision Detection, 2005, sections 7.3.3 to 7.3.6).
///
/// Each node is enlarged by half of its width on every side. So a node contains each box whose center is in the node
/// itself and whose longest side is at most the width of the node. The longest side alone gives the depth, and the
/// center gives the node. So no box sticks to a dividing plane. Nodes are in a hash table under their locational codes,
/// without child pointers. An 8-bit mask tells which children exist, so a search looks up only nodes that exist.
///
/// Differs from the book:
/// - Codes have 64 bits, and the largest depth is 20. Smaller boxes are also stored at this depth. So a box that is a
///   point has a node too.
/// - A box whose center is outside of the root, or that is longer than the root is wide, is in a list. If the list
///   becomes long, the next search builds the tree again with a larger root.
/// - An empty node without children is removed, and so are its ancestors if they become empty.
/// - The search for all pairs queries the tree with each box. The depth-first search of 7.3.2 compares a node only with
///   its ancestors. That is not sufficient here, because loose nodes also overlap their neighbors.
class LooseOctree final : public Partition {
 public:
  LooseOctree() : Partition("LooseOctree") {}

 private:
  static constexpr int kMostDepth = 20;
  struct Node {
    std::vector<ProxyId> ids;
    std::uint8_t children = 0;  // bit i: child i exists
  };
  /// The place of a node: its depth (0 for the root) and its indices among the nodes of this depth.
  struct Place {
    int depth = -1;  // -1: no node, the box belongs to the list `outside_`
    std::uint64_t x = 0, y = 0, z = 0;
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  void findPairs(PairSink& sink) const override { findPairsByQueries(sink); }
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  /// The node that a box belongs to.
  Place placeOf(const Aabb& box) const;
  static std::uint64_t codeOf(const Place& place) { return nodeCode(place.depth, place.x, place.y, place.z); }
  /// The enlarged region of a node.
  Aabb regionOf(const Place& place) const;

  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();  // [m] smallest corner of the root
  double width_ = 1.0;                             // [m] width of the root
  std::unordered_map<std::uint64_t, Node> nodes_;
  IdSet outside_;  // the boxes that the root does not contain
};

}  // namespace book
}  // namespace hgrid
