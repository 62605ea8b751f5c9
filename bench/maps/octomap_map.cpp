// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>
#include <stdexcept>

#include "bench/maps/map_peer.h"
#include "bench/maps/octomap_tree.h"
#include "bench/queries/exact.h"
#include "test/support/silence.h"

namespace hgrid {
namespace bench {
namespace {

octomap::point3d toOctomap(const Eigen::Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

template <class Leaf>
Voxel voxelOf(const Leaf& leaf) {
  const octomap::OcTreeKey key = leaf.getIndexKey();
  return {key[0], key[1], key[2], static_cast<std::uint8_t>(Voxel::kLevels - leaf.getDepth())};
}

/// OctoMap's tree, used as most users of OctoMap do. For a sphere, this class visits the leaves in the box around the
/// sphere and tests them exactly. For a segment, it casts a ray that passes through unknown space.
class OctomapMap final : public MapPeer {
 public:
  explicit OctomapMap(std::shared_ptr<const octomap::OcTree> tree) : tree_(std::move(tree)) {}

  bool answers(MapQuestion) const override { return true; }

  bool touches(const Sphere& sphere) override {
    bool touches = false;
    visit(sphere, [&](const Voxel&) {
      touches = true;
      return false;
    });
    return touches;
  }
  void overlapping(const Sphere& sphere, std::vector<Voxel>& found) override {
    found.clear();
    visit(sphere, [&](const Voxel& voxel) {
      found.push_back(voxel);
      return true;
    });
  }

  /// castRay() ends at the last cell whose center is within its range. Therefore the range is the length of the segment
  /// plus half the diagonal of a cell. A cell that the segment does not meet is dropped afterwards.
  std::optional<Voxel> firstAlong(const Segment& segment) override {
    const Eigen::Vector3d way = segment.to - segment.from;
    octomap::point3d end;
    if (!tree_->castRay(toOctomap(segment.from), toOctomap(way), end, true,
                        way.norm() + std::sqrt(0.75) * tree_->getResolution()))
      return std::nullopt;
    const octomap::OcTreeKey key = tree_->coordToKey(end);
    const Voxel cell{key[0], key[1], key[2], 0};
    const SlabTest test(inKeys(segment, tree_->getResolution()));
    if (!test.meets(inKeys(cell), kRounded)) return std::nullopt;
    return cell;
  }

  std::vector<Voxel> leaves() override { return leavesOf(*tree_); }
  std::size_t bytes() const override { return tree_->memoryUsage(); }

 private:
  static constexpr double kRounded = 1e-4;  // [keys] tolerance, because the direction of the ray is rounded to float

  /// Calls `look` with each occupied leaf that the sphere touches. Stops when `look` returns false.
  template <class Look>
  void visit(const Sphere& sphere, const Look& look) const {
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(sphere.radius);
    const Sphere ball = inKeys(sphere, tree_->getResolution());
    const double squared = ball.radius * ball.radius;
    const auto end = tree_->end_leafs_bbx();
    for (auto leaf = tree_->begin_leafs_bbx(toOctomap(sphere.center - half), toOctomap(sphere.center + half));
         leaf != end; ++leaf) {
      if (!tree_->isNodeOccupied(*leaf)) continue;
      const Voxel voxel = voxelOf(leaf);
      if (squaredGap(inKeys(voxel), ball.center) <= squared && !look(voxel)) return;
    }
  }

  std::shared_ptr<const octomap::OcTree> tree_;
};

}  // namespace

std::shared_ptr<const octomap::OcTree> ocTreeOf(const std::string& file) {
  const test::Silence silence;
  const auto tree = std::make_shared<octomap::OcTree>(0.1);  // readBinary() sets the right resolution
  if (!tree->readBinary(file)) throw std::runtime_error("OctoMap cannot read " + file);
  return tree;
}

std::vector<Voxel> leavesOf(const octomap::OcTree& tree) {
  std::vector<Voxel> leaves;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (tree.isNodeOccupied(*leaf)) leaves.push_back(voxelOf(leaf));
  }
  return leaves;
}

std::unique_ptr<MapPeer> readOcTree(const Map& map) { return std::make_unique<OctomapMap>(ocTreeOf(map.file)); }

}  // namespace bench
}  // namespace hgrid
