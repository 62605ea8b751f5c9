// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "test/support/worlds.h"

namespace hgrid {

inline bool operator==(const SegmentHit& a, const SegmentHit& b) { return a.id == b.id && a.along == b.along; }

namespace test {

/// A scale of every sort: the one that fits, or far too fine, or far too coarse.
inline GridScale scaleFor(const std::vector<Aabb>& boxes, Random& random) {
  GridScale scale = GridScale::fitting(boxes);
  if (random.chance(0.5)) scale.finest_edge = std::ldexp(1.0, random.between(-30, 10));
  return scale;
}

inline HGrid gridOf(const std::vector<Aabb>& boxes, const GridScale& scale, std::uint64_t seed = 0) {
  HGrid grid(scale, seed);
  for (ProxyId id = 0; id < boxes.size(); ++id) grid.insert(id, boxes[id]);
  return grid;
}

/// The grid's pairs, sorted. A pair met twice or the wrong way round stays visible.
inline Pairs pairsOf(const HGrid& grid) {
  std::vector<ProxyPair> found = {{7, 7}};  // what the buffer held before must go
  grid.overlappingPairs(found);
  Pairs pairs;
  for (const ProxyPair& pair : found) pairs.emplace_back(pair.first, pair.second);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <class Query>
std::vector<ProxyId> foundBy(const HGrid& grid, const Query& query) {
  std::vector<ProxyId> found = {7, 7, 7};
  grid.overlapping(query, found);
  return found;
}

inline std::vector<SegmentHit> alongOf(const HGrid& grid, const Segment& segment) {
  std::vector<SegmentHit> found = {{7, 7.0}};
  grid.along(segment, found);
  return found;
}

}  // namespace test
}  // namespace hgrid
