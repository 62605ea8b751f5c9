// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Uses only the hierarchical grid: stores boxes, prints overlapping pairs and answers to queries.
#include <cstdio>
#include <string>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"

namespace {

/// Returns a cube with this center and edge length [m].
hgrid::Aabb cube(double x, double y, double z, double edge) {
  const Eigen::Vector3d center(x, y, z);
  return {(center.array() - edge / 2.0).cast<float>(), (center.array() + edge / 2.0).cast<float>()};
}

void printPairs(const hgrid::HGrid& grid) {
  std::vector<hgrid::ProxyPair> pairs;
  grid.overlappingPairs(pairs);
  for (const hgrid::ProxyPair& pair : pairs) std::printf("  boxes %u and %u overlap\n", pair.first, pair.second);
  if (pairs.empty()) std::printf("  no boxes overlap\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) {
    const std::string word = argv[1];
    if (word != "--help" && word != "-h") return std::fputs("hgrid_alone takes no arguments\n", stderr), 2;
    return std::puts("usage: hgrid_alone [-h]\n\nStores boxes in a grid, prints overlapping pairs and answers to queries."),
           0;
  }
  hgrid::HGrid grid;  // the boxes may be anywhere and of any size
  grid.insert(0, cube(0.0, 0.0, 0.0, 4.0));
  grid.insert(1, cube(2.1, 0.0, 0.0, 0.5));
  grid.insert(2, cube(5.0, 0.0, 0.0, 0.1));
  std::printf("at first\n");
  printPairs(grid);

  grid.update(2, cube(2.4, 0.0, 0.0, 0.1));
  std::printf("after box 2 moved\n");
  printPairs(grid);

  std::printf("a sphere of 0.2 m around (2.5, 0, 0)\n");
  std::vector<hgrid::ProxyId> touched;
  grid.overlapping(hgrid::Sphere{{2.5, 0.0, 0.0}, 0.2}, touched);
  for (const hgrid::ProxyId id : touched) std::printf("  touches box %u\n", id);

  std::printf("a segment from (-5, 0, 0) to (5, 0, 0)\n");
  std::vector<hgrid::SegmentHit> hits;
  grid.along(hgrid::Segment{{-5.0, 0.0, 0.0}, {5.0, 0.0, 0.0}, 0.0}, hits);
  for (const hgrid::SegmentHit& hit : hits) std::printf("  meets box %u after %.2f m\n", hit.id, hit.along);

  std::printf("the box nearest to (9, 0, 0)\n");
  std::vector<hgrid::NearHit> nearest;
  grid.nearest({9.0, 0.0, 0.0}, 1, 100.0, nearest);
  for (const hgrid::NearHit& near : nearest) std::printf("  is box %u, %.2f m away\n", near.id, near.distance);
}
