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

/// The boxes of a world, box i under id i, in one bulk update.
inline HGrid gridOf(const std::vector<Aabb>& boxes, const GridScale& scale) {
  HGrid grid(scale);
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < boxes.size(); ++id) ids.push_back(id);
  grid.update(ids, boxes);
  return grid;
}

/// Stored boxes per level.
inline std::vector<std::size_t> levelCounts(const BroadPhaseReader& broad_phase) {
  std::vector<std::size_t> counts;
  for (const BroadPhaseLevel& level : broad_phase.levels()) counts.push_back(level.boxes);
  return counts;
}

inline std::vector<Isa> supportedIsas() {
  std::vector<Isa> isas;
  for (const Isa isa : {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512}) {
    if (isSupported(isa)) isas.push_back(isa);
  }
  return isas;
}

/// The same, but come to in one of several ways, on some instruction set: whatever was before must not show.
inline HGrid gridComeTo(const std::vector<Aabb>& boxes, const GridScale& scale, Random& random) {
  HGrid grid(scale);
  const std::vector<Isa> isas = supportedIsas();
  grid.setIsa(isas[std::size_t(random.below(int(isas.size())))]);
  const int way = random.below(5);
  std::vector<ProxyId> ids, some;
  std::vector<Aabb> before = boxes, moved;
  for (ProxyId id = 0; id < boxes.size(); ++id) {
    ids.push_back(id);
    const bool few = way == 3 || way == 4;
    if (!random.chance(few ? 0.1 : 0.7)) continue;
    before[id] = boxes[std::size_t(random.below(int(boxes.size())))];  // elsewhere, another size
    some.push_back(id);
    moved.push_back(boxes[id]);
  }
  std::vector<ProxyPair> pairs;
  if (way == 0) {  // one by one, in any order
    for (std::size_t i = ids.size(); i > 1; --i) std::swap(ids[i - 1], ids[std::size_t(random.below(int(i)))]);
    for (const ProxyId id : ids) grid.insert(id, boxes[id]);
    return grid;
  }
  grid.update(ids, before);
  if (random.chance(0.5)) grid.overlappingPairs(pairs);  // from now on pairs are kept
  if (way == 1 || way == 3) {
    grid.update(ids, boxes);
  } else if (way == 4) {
    grid.move(some, moved);
  } else {
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (random.chance(0.5)) {
        grid.update(some[i], moved[i]);
      } else {
        grid.remove(some[i]);
        grid.insert(some[i], moved[i]);
      }
    }
  }
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
