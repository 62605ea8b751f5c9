// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "map_stream.h"

#include "bench/maps/building.h"
#include "bench/workload/random.h"
#include "test/adapters/octomap_oracle.h"

namespace hgrid {
namespace bench {
namespace {

constexpr std::size_t kPrepared = 10;
constexpr int kMarkKey = Voxel::kOriginKey - 200;  // less than all keys of the building: first in Morton order

/// Returns for each leaf of the building the index of the one map that does not contain it. Each map lacks `changed`
/// leaves.
std::vector<std::size_t> lackingMaps(std::size_t leaves, std::size_t changed) {
  const std::size_t groups = leaves / changed;
  std::vector<std::size_t> lacking(leaves);
  for (std::size_t i = 0; i < leaves; ++i) lacking[i] = i % groups;
  Random random(1);
  for (std::size_t i = leaves - 1; i > 0; --i) std::swap(lacking[i], lacking[random.below(i + 1)]);
  return lacking;
}

template <class Number>
std::string bytesOf(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}
std::string stringOf(const std::string& text) { return bytesOf(static_cast<std::uint32_t>(text.size())) + text; }

test::OctomapBytes messageOf(const std::vector<Voxel>& voxels) {
  const std::uint32_t seq = 0;
  const std::uint64_t stamp = 0;
  return {bytesOf(seq) + bytesOf(stamp) + stringOf("map") + std::string(1, '\1') + stringOf("OcTree") +
          bytesOf(MapStream::kEdge) + stringOf(test::binaryNodesOf(voxels))};
}

}  // namespace

MapStream::MapStream(const std::string& topic, std::size_t count) {
  const std::size_t changed = count / 100;
  const std::vector<Voxel> leaves = buildingOf(count + changed);
  const std::vector<std::size_t> lacking = lackingMaps(leaves.size(), changed);
  for (std::size_t number = 0; number < kPrepared; ++number) {
    const auto mark = static_cast<std::uint16_t>(kMarkKey - 2 * static_cast<int>(number % 2));
    std::vector<Voxel> voxels{{mark, mark, mark, 0}};
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      if (lacking[i] != number) voxels.push_back(leaves[i]);
    }
    messages_.push_back(messageOf(voxels));
  }
  publisher_ = node_.advertise<test::OctomapBytes>(topic, 1, true);
  publishNext();
}

void MapStream::publishNext() { publisher_.publish(messages_[published_++ % messages_.size()]); }

double MapStream::middleOfMark() { return (kMarkKey - Voxel::kOriginKey + 0.5) * kEdge; }

}  // namespace bench
}  // namespace hgrid
