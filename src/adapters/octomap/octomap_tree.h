// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "hgrid_proximity/geometry/voxel.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {

/// The content of an octant, that is, of one of the eight parts of a cube. The first four numbers are the two-bit
/// values in a `.bt` file.
enum class Octant : std::uint8_t { unknown = 0, free = 1, occupied = 2, node = 3, nan = 4 };

/// A node as it was read. A node without children is a leaf.
struct OctreeNode {
  std::uint16_t
      children;  ///< two bits for each child: its Octant; the first child is in the lowest bits; 0: no children
  Octant leaf;   ///< content of the leaf, if there are no children
};

/// The bytes of the nodes, with the index of the next byte to read.
class NodeBytes {
 public:
  NodeBytes(std::string_view data, const std::string& what) : data_(data), what_(what) {}

  /// Returns the next `count` bytes and moves behind them. @throws Refusal with code truncated if there are fewer bytes
  const unsigned char* take(std::size_t count) {
    if (data_.size() - at_ < count) {
      throw Refusal(Code::truncated, what_ + " ends after " + std::to_string(data_.size()) +
                                         " bytes of nodes, before its tree is complete");
    }
    at_ += count;
    return reinterpret_cast<const unsigned char*>(data_.data()) + at_ - count;
  }

  /// Checks that all bytes were read. @throws Refusal with code parse if there are bytes left
  void finish() const {
    if (at_ == data_.size()) return;
    throw Refusal(Code::parse, what_ + " has " + std::to_string(data_.size() - at_) + " bytes after the " +
                                   std::to_string(at_) + " bytes of its tree; nothing may follow the tree");
  }

 private:
  std::string_view data_;
  const std::string& what_;
  std::size_t at_ = 0;
};

/// Reads the nodes of a `.bt` file. A node with children has two bytes, a node without children has none.
class BinaryNodes : public NodeBytes {
 public:
  using NodeBytes::NodeBytes;

  OctreeNode next() {
    const unsigned char* bytes = take(2);
    const Octant leaf = is_root_ ? Octant::occupied : Octant::free;  // OctoMap treats a node without children like this
    is_root_ = false;
    return {static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8), leaf};
  }

 private:
  bool is_root_ = true;
};

/// Reads the nodes of an `.ot` file. A node has its log-odds as a little-endian float, then three bytes of color in a
/// ColorOcTree, then one byte with a bit for each child.
class FullNodes : public NodeBytes {
 public:
  FullNodes(std::string_view data, const std::string& what, bool has_color, float occupied_from)
      : NodeBytes(data, what), bytes_of_node_(has_color ? 8 : 5), occupied_from_(occupied_from) {}

  OctreeNode next() {
    const unsigned char* bytes = take(bytes_of_node_);
    const unsigned children = bytes[bytes_of_node_ - 1];
    if (children != 0) return {allNodes(children), Octant::node};
    const float log_odds = floatOf(bytes);
    if (log_odds >= occupied_from_) return {0, Octant::occupied};
    return {0, log_odds < occupied_from_ ? Octant::free : Octant::nan};
  }

 private:
  /// Returns two bits for each child: Octant::node if the bit of the child is set, otherwise Octant::unknown.
  static std::uint16_t allNodes(unsigned bits) {
    bits = (bits | bits << 4) & 0x0f0f;
    bits = (bits | bits << 2) & 0x3333;
    bits = (bits | bits << 1) & 0x5555;
    return static_cast<std::uint16_t>(3 * bits);
  }

  static float floatOf(const unsigned char* bytes) {
    const std::uint32_t bits = bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
    float value;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }

  std::size_t bytes_of_node_;
  float occupied_from_;
};

constexpr Voxel kWhole{0, 0, 0, Voxel::kLevels};  ///< the root of the octree: the whole map

/// Returns how many of the bits 0, 2, .. 14 are set. No other bit may be set. It is used instead of the builtin of the
/// compiler, because the builtin would call a function.
inline unsigned bitsIn(unsigned bits) {
  bits = (bits & 0x3333) + (bits >> 2 & 0x3333);
  bits += bits >> 4;
  return ((bits & 0x0f0f) + (bits >> 8)) & 0x0f;
}

/// Reads all nodes and calls functions of `leaves` for them. The nodes are stored depth first, which is Morton order.
///
/// - count(nodes, free) receives how many more nodes and how many more free leaves were read.
/// - add(cube, octant) receives each leaf, in order. It receives free leaves only if wantsFree() is true. It receives
///   octants without a leaf, as Octant::unknown, only if wantsUnknown() is true.
/// @throws Refusal with code parse for a node below a cube of level 0
/// @throws everything that `nodes` and `leaves` throw
template <class Nodes, class Leaves>
void readTree(Nodes& nodes, Leaves& leaves, const std::string& what) {
  struct Inner {
    Voxel cube;
    unsigned children;  // as in OctreeNode::children
    unsigned ahead;     // bit 2 i is set while child i must still be visited
  };
  constexpr unsigned kEach = 0x5555;       // bit 2 i is set for each child i
  std::array<Inner, Voxel::kLevels> path;  // from the root to the current node
  std::size_t depth = 0;
  const unsigned free_wanted = leaves.wantsFree() ? kEach : 0, unknown_wanted = leaves.wantsUnknown() ? kEach : 0;
  const auto read = [&](const Voxel& cube) {
    const OctreeNode node = nodes.next();
    if (node.children == 0) {
      const bool is_free = node.leaf == Octant::free;
      leaves.count(0, is_free);
      if (!is_free || free_wanted) leaves.add(cube, node.leaf);
      return;
    }
    if (cube.level == 0) {
      throw Refusal(Code::parse, what + " has nodes deeper than " + std::to_string(Voxel::kLevels) +
                                     " levels; an OctoMap has at most these");
    }
    const unsigned low = node.children & kEach, high = node.children >> 1 & kEach;
    const unsigned free = low & ~high, unknown = kEach & ~(low | high);
    leaves.count(bitsIn(low | high), bitsIn(free));
    path[depth++] = {cube, node.children, high | (free & free_wanted) | (unknown & unknown_wanted)};
  };

  leaves.count(1, 0);
  read(kWhole);
  while (depth > 0) {
    Inner& inner = path[depth - 1];
    if (inner.ahead == 0) {
      --depth;
      continue;
    }
    const auto bit = static_cast<unsigned>(__builtin_ctz(inner.ahead));
    inner.ahead &= inner.ahead - 1;
    const Voxel cube = childOf(inner.cube, bit / 2);
    const auto octant = static_cast<Octant>(inner.children >> bit & 3);
    if (octant == Octant::node) {
      read(cube);
    } else {
      leaves.add(cube, octant);
    }
  }
  nodes.finish();
}

}  // namespace hgrid
