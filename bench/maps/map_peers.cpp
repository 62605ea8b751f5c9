// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <limits>

#include "bench/maps/map_peer.h"

namespace hgrid {
namespace bench {

const char* name(MapQuestion question) {
  static constexpr const char* kNames[] = {"touches", "small", "overlapping", "segment"};
  return kNames[static_cast<int>(question)];
}

const std::vector<MapPeerKind>& mapPeers() {
  static const std::size_t any = std::numeric_limits<std::size_t>::max();
  static const std::vector<MapPeerKind> kinds{
      {"hgrid", any, readStaticGrid, makeStaticGrid},
#ifdef HGRID_BENCH_OCTOMAP
      {"OctoMap", any, readOcTree, nullptr},
#endif
#ifdef HGRID_BENCH_FCL_OCTREE
      {"FCL OcTree", any, readFclOcTree, nullptr},
#endif
#ifdef HGRID_BENCH_FCL
      {"FCL DynamicAABBTree of leaves", 1000000, nullptr, makeFclLeafBoxes},
#endif
  };
  return kinds;
}

}  // namespace bench
}  // namespace hgrid
