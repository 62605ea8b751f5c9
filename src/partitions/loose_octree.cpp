// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/loose_octree.h"

#include <cmath>
#include <limits>

#include "geometry/rounding.h"
#include "partitions/cell_scale.h"

namespace hgrid {
namespace book {
namespace {

constexpr double kLargestFloat = std::numeric_limits<float>::max();

}  // namespace

std::uint64_t spreadBits(std::uint64_t value) {
  value &= 0x1fffff;
  value = (value ^ value << 32) & 0x001f00000000ffffu;
  value = (value ^ value << 16) & 0x001f0000ff0000ffu;
  value = (value ^ value << 8) & 0x100f00f00f00f00fu;
  value = (value ^ value << 4) & 0x10c30c30c30c30c3u;
  return (value ^ value << 2) & 0x1249249249249249u;
}

std::uint64_t nodeCode(int depth, std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return std::uint64_t{1} << (3 * depth) | spreadBits(x) | spreadBits(y) << 1 | spreadBits(z) << 2;
}

LooseOctree::Place LooseOctree::placeOf(const Aabb& box) const {
  const double side = longestSideInDouble(box);
  const Eigen::Vector3d offset = 0.5 * (box.min.cast<double>() + box.max.cast<double>()) - low_;
  if (side > width_ || !(offset.array() >= 0.0).all() || !(offset.array() < width_).all()) return {};
  // The largest depth at which a node is still at least as wide as the box is long. The quotient is not computed for
  // tiny boxes, because it could overflow.
  Place place;
  place.depth = side * (1 << kMostDepth) > width_ ? std::min(std::ilogb(width_ / side), kMostDepth) : kMostDepth;
  const double nodes = std::ldexp(1.0, place.depth);
  const auto index = [&](double along) {
    return static_cast<std::uint64_t>(std::min(along / width_ * nodes, nodes - 1.0));  // clamps a fraction of 1
  };
  place.x = index(offset.x()), place.y = index(offset.y()), place.z = index(offset.z());
  return place;
}

Aabb LooseOctree::regionOf(const Place& place) const {
  const double width = width_ / static_cast<double>(std::uint64_t{1} << place.depth);
  const Eigen::Vector3d index(static_cast<double>(place.x), static_cast<double>(place.y), static_cast<double>(place.z));
  Aabb region;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = low_[axis] + (index[axis] - 0.5) * width, high = low + 2.0 * width;
    constexpr double kFloats = 2e-7;  // includes the conversions to float
    const double rounding = kFloats * (std::abs(low) + std::abs(high)) + kFloatRoundingNearZero;
    // Boxes are finite, so a finite region is large enough. An infinite one would make its distance from a sphere NaN.
    region.min[axis] = static_cast<float>(std::max(low - rounding, -kLargestFloat));
    region.max[axis] = static_cast<float>(std::min(high + rounding, kLargestFloat));
  }
  return region;
}

// ---- changes

void LooseOctree::build() {
  const Eigen::Vector3d low = world().min.cast<double>(), high = world().max.cast<double>();
  const double side = (high - low).maxCoeff();
  width_ = side > 0.0 ? 1.5 * side : 1.0;  // larger than the world, so boxes may move outward
  low_ = 0.5 * (low + high) - Eigen::Vector3d::Constant(0.5 * width_);
  nodes_.clear();
  outside_.clear();
  for (const ProxyId id : storedIds()) added(id);
}

Partition::Followed LooseOctree::added(ProxyId id) {
  const Place place = placeOf(box(id));
  if (place.depth < 0) {
    outside_.add(id);
    return 8 * outside_.size() > size() + 64 ? Followed::no : Followed::yes;  // no: the root is too small
  }
  std::uint64_t code = codeOf(place);
  bool is_new = nodes_.find(code) == nodes_.end();  // whether the node `code` has no bit in its parent yet
  nodes_[code].ids.push_back(id);
  for (; is_new && code > 1; code >>= 3) {  // makes the missing ancestors
    is_new = nodes_.find(code >> 3) == nodes_.end();
    Node& parent = nodes_[code >> 3];
    parent.children = static_cast<std::uint8_t>(parent.children | 1u << (code & 7));
  }
  return Followed::yes;
}

Partition::Followed LooseOctree::removed(ProxyId id, const Aabb& from) {
  const Place place = placeOf(from);
  if (place.depth < 0) {
    outside_.remove(id);
    return Followed::yes;
  }
  std::uint64_t code = codeOf(place);
  auto node = nodes_.find(code);
  eraseUnordered(node->second.ids, id);
  while (node->second.ids.empty() && node->second.children == 0) {  // drops nodes that became empty
    nodes_.erase(node);
    if (code == 1) break;
    node = nodes_.find(code >> 3);
    node->second.children = static_cast<std::uint8_t>(node->second.children & ~(1u << (code & 7)));
    code >>= 3;
  }
  return Followed::yes;
}

Partition::Followed LooseOctree::moved(ProxyId id, const Aabb& from) {
  const Place before = placeOf(from), now = placeOf(box(id));
  const bool rests = before.depth == now.depth && before.x == now.x && before.y == now.y && before.z == now.z;
  return rests ? Followed::yes : Partition::moved(id, from);
}

// ---- searches

void LooseOctree::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  const Aabb& around = shape.bounds();
  for (const ProxyId id : outside_) {
    if (overlap(around, box(id))) found.push_back(id);
  }
  if (nodes_.empty()) return;
  std::vector<Place> stack{{0, 0, 0, 0}};
  while (!stack.empty()) {
    const Place place = stack.back();
    stack.pop_back();
    if (!shape.mayTouch(regionOf(place))) continue;
    const Node& node = nodes_.find(codeOf(place))->second;
    for (const ProxyId id : node.ids) {
      if (overlap(around, box(id))) found.push_back(id);
    }
    for (std::uint64_t child = 0; child < 8; ++child) {  // the bits of a child: 1 = x, 2 = y, 4 = z
      if ((node.children >> child & 1) == 0) continue;
      stack.push_back(
          {place.depth + 1, 2 * place.x + (child & 1), 2 * place.y + (child >> 1 & 1), 2 * place.z + (child >> 2)});
    }
  }
}

void LooseOctree::checkStructure() const {
  std::size_t held = outside_.size(), children = 0, linked = 0;
  for (const auto& one : nodes_) {
    require(!one.second.ids.empty() || one.second.children != 0, "each node holds a box or has a child");
    held += one.second.ids.size();
    for (const ProxyId id : one.second.ids) {
      const Place place = placeOf(box(id));
      require(isStored(id) && place.depth >= 0 && codeOf(place) == one.first,
              "a box is in the node of its size and center");
      const Aabb region = regionOf(place);
      require((region.min.array() <= box(id).min.array()).all() && (box(id).max.array() <= region.max.array()).all(),
              "the enlarged node contains the box");
    }
    for (std::uint64_t child = 0; child < 8; ++child) {
      if ((one.second.children >> child & 1) == 0) continue;
      ++children;
      linked += nodes_.count(8 * one.first + child);
    }
  }
  require(held == size(), "each box is in one node or outside");
  require(children == linked && children + 1 == nodes_.size() + (nodes_.empty() ? 1 : 0),
          "each node but the root is the child of a node");
}

std::size_t LooseOctree::structureBytes() const {
  std::size_t bytes = outside_.bytes() + nodes_.bucket_count() * sizeof(void*);
  for (const auto& node : nodes_)
    bytes += sizeof(node) + 2 * sizeof(void*) + node.second.ids.capacity() * sizeof(ProxyId);
  return bytes;
}

void LooseOctree::draw(std::vector<Aabb>& regions) const {
  for (const auto& one : nodes_) {
    if (one.second.ids.empty()) continue;
    Aabb region = regionOf(placeOf(box(one.second.ids.front())));
    const Eigen::Vector3f quarter = 0.25f * (region.max - region.min);
    regions.push_back({region.min + quarter, region.max - quarter});  // the node itself, without its loose border
  }
}

}  // namespace book
}  // namespace hgrid
