// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include "bench/maps/map_peer.h"
#include "bench/maps/octomap_tree.h"

namespace hgrid {
namespace bench {
namespace {

/// OctoMap's tree as a geometry of FCL. FCL stops at the first contact and does not compute its position.
class FclOcTreeMap final : public MapPeer {
 public:
  explicit FclOcTreeMap(const std::shared_ptr<const octomap::OcTree>& tree) : tree_(tree), geometry_(tree) {}

  bool answers(MapQuestion question) const override {
    return question == MapQuestion::touches || question == MapQuestion::small;
  }

  bool touches(const Sphere& sphere) override {
    const fcl::Sphere<double> ball(sphere.radius);
    fcl::CollisionResult<double> result;
    return fcl::collide<double>(&geometry_, Eigen::Isometry3d::Identity(), &ball,
                                Eigen::Isometry3d(Eigen::Translation3d(sphere.center)), fcl::CollisionRequest<double>(),
                                result) > 0;
  }

  std::vector<Voxel> leaves() override { return leavesOf(*tree_); }

 private:
  std::shared_ptr<const octomap::OcTree> tree_;
  fcl::OcTree<double> geometry_;
};

}  // namespace

std::unique_ptr<MapPeer> readFclOcTree(const Map& map) { return std::make_unique<FclOcTreeMap>(ocTreeOf(map.file)); }

}  // namespace bench
}  // namespace hgrid
