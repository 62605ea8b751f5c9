// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <filesystem>

#include "bench/maps/map_peer.h"
#include "hgrid_proximity/maps/static_grid.h"

namespace hgrid {
namespace bench {
namespace {

class StaticGridMap final : public MapPeer {
 public:
  StaticGridMap(double resolution, const std::vector<Voxel>& leaves) : grid_(resolution, leaves) {}

  bool answers(MapQuestion) const override { return true; }

  bool touches(const Sphere& sphere) override { return grid_.touches(sphere); }
  void overlapping(const Sphere& sphere, std::vector<Voxel>& found) override {
    grid_.overlapping(sphere, grid_.size(), found);
  }
  std::optional<Voxel> firstAlong(const Segment& segment) override {
    const std::optional<VoxelTouch> first = grid_.firstAlong(segment);
    if (!first) return std::nullopt;
    return first->voxel;
  }

  std::vector<Voxel> leaves() override { return grid_.voxels(); }
  std::size_t bytes() const override { return grid_.bytes(); }

 private:
  StaticGrid grid_;
};

}  // namespace

Octomap readMap(const std::string& file) {
  const std::string path = std::filesystem::canonical(file).string();
  ResourcePolicy policy;
  policy.file_roots = {std::filesystem::path(path).parent_path().string()};
  policy.max_bytes = OctomapOptions().max_bytes;
  return readOctomapFile(openResource("file://" + path, policy));
}

std::unique_ptr<MapPeer> readStaticGrid(const Map& map) {
  const Octomap read = readMap(map.file);
  return std::make_unique<StaticGridMap>(read.resolution, read.occupied);
}

std::unique_ptr<MapPeer> makeStaticGrid(const Map& map) {
  return std::make_unique<StaticGridMap>(map.resolution, map.leaves);
}

}  // namespace bench
}  // namespace hgrid
