// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/maps/map_peer.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {
namespace {

/// FCL's dynamic AABB tree with one box per leaf. Coordinates are in units of voxel keys, see inKeys().
class FclLeavesMap final : public MapPeer {
 public:
  explicit FclLeavesMap(const Map& map) : map_(&map), tree_(makeFclQueries()) {
    std::vector<Aabb> boxes;
    for (const Voxel& leaf : map.leaves) boxes.push_back(inKeys(leaf));
    tree_->load(boxes);
  }

  bool answers(MapQuestion question) const override { return question == MapQuestion::overlapping; }

  void overlapping(const Sphere& sphere, std::vector<Voxel>& found) override {
    tree_->sphere(inKeys(sphere, map_->resolution), ids_);
    found.clear();
    for (const ProxyId id : ids_) found.push_back(map_->leaves[id]);
  }

  std::vector<Voxel> leaves() override {
    std::vector<Voxel> all;
    overlapping({Eigen::Vector3d::Zero(), (2 << Voxel::kLevels) * map_->resolution}, all);
    return all;
  }

 private:
  const Map* map_;
  std::unique_ptr<QueryPeer> tree_;
  std::vector<ProxyId> ids_;
};

}  // namespace

std::unique_ptr<MapPeer> makeFclLeafBoxes(const Map& map) { return std::make_unique<FclLeavesMap>(map); }

}  // namespace bench
}  // namespace hgrid
