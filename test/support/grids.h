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

/// Returns a random grid scale. It fits the boxes, or it may be far too fine or far too coarse for them.
inline GridScale scaleFor(const std::vector<Aabb>& boxes, Random& random) {
  GridScale scale = GridScale::fitting(boxes);
  if (random.chance(0.5)) scale.finest_edge = std::ldexp(1.0, random.between(-30, 10));
  return scale;
}

/// Returns a grid that stores boxes[i] under id i. Stores all boxes with one call of update().
inline HGrid gridOf(const std::vector<Aabb>& boxes, const GridScale& scale) {
  HGrid grid(scale);
  std::vector<ProxyId> ids;
  for (ProxyId id = 0; id < boxes.size(); ++id) ids.push_back(id);
  grid.update(ids, boxes);
  return grid;
}

/// Returns the number of stored boxes per level.
inline std::vector<std::size_t> levelCounts(const BroadPhaseReader& broad_phase) {
  std::vector<std::size_t> counts;
  for (const BroadPhaseLevel& level : broad_phase.levels()) counts.push_back(level.boxes);
  return counts;
}

inline std::vector<Isa> supportedIsas() {
  std::vector<Isa> isas;
  for (const Isa isa : {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
    if (isSupported(isa)) isas.push_back(isa);
  }
  return isas;
}

/// Stores boxes[i] under id i. Chooses one of several sequences of calls at random. The pairs and answers of
/// `broad_phase` must not depend on the sequence.
inline void bringTo(BroadPhase& broad_phase, const std::vector<Aabb>& boxes, Random& random) {
  const int sequence = random.below(5);
  std::vector<ProxyId> ids, some;
  std::vector<Aabb> before = boxes, moved;
  for (ProxyId id = 0; id < boxes.size(); ++id) {
    ids.push_back(id);
    const bool few = sequence == 3 || sequence == 4;
    if (!random.chance(few ? 0.1 : 0.7)) continue;
    before[id] = boxes[std::size_t(random.below(int(boxes.size())))];  // the box before its move
    some.push_back(id);
    moved.push_back(boxes[id]);
  }
  std::vector<ProxyPair> pairs;
  if (sequence == 0) {  // inserts the boxes one by one, in random order
    for (std::size_t i = ids.size(); i > 1; --i) std::swap(ids[i - 1], ids[std::size_t(random.below(int(i)))]);
    for (const ProxyId id : ids) broad_phase.insert(id, boxes[id]);
    return;
  }
  broad_phase.update(ids, before);
  if (random.chance(0.5)) broad_phase.overlappingPairs(pairs);  // HGrid then keeps pairs of resting boxes
  if (sequence == 1 || sequence == 3) {
    broad_phase.update(ids, boxes);
  } else if (sequence == 4) {
    broad_phase.move(some, moved);
  } else {
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (random.chance(0.5)) {
        broad_phase.update(some[i], moved[i]);
      } else {
        broad_phase.remove(some[i]);
        broad_phase.insert(some[i], moved[i]);
      }
    }
  }
}

/// Returns a grid that stores these boxes and uses a random instruction set. It is filled by bringTo().
inline HGrid gridBroughtTo(const std::vector<Aabb>& boxes, const GridScale& scale, Random& random) {
  HGrid grid(scale);
  const std::vector<Isa> isas = supportedIsas();
  grid.setIsa(isas[std::size_t(random.below(int(isas.size())))]);
  bringTo(grid, boxes, random);
  return grid;
}

/// Returns all overlapping pairs, sorted. Does not remove duplicates or sort the two ids of a pair, because a test must
/// detect such errors.
inline Pairs pairsOf(const BroadPhaseReader& broad_phase) {
  std::vector<ProxyPair> found = {{7, 7}};  // the search must remove this old content of the buffer
  broad_phase.overlappingPairs(found);
  Pairs pairs;
  for (const ProxyPair& pair : found) pairs.emplace_back(pair.first, pair.second);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <class Query>
std::vector<ProxyId> foundBy(const BroadPhaseReader& broad_phase, const Query& query) {
  std::vector<ProxyId> found = {7, 7, 7};
  broad_phase.overlapping(query, found);
  return found;
}

inline std::vector<SegmentHit> alongOf(const BroadPhaseReader& broad_phase, const Segment& segment) {
  std::vector<SegmentHit> found = {{7, 7.0}};
  broad_phase.along(segment, found);
  return found;
}

/// Returns the ids of the boxes along a segment in ascending order. The order of two hits at almost the same place is a
/// matter of rounding, so it may differ between two broad phases.
inline std::vector<ProxyId> idsAlong(const BroadPhaseReader& broad_phase, const Segment& segment) {
  std::vector<ProxyId> ids;
  for (const SegmentHit& hit : alongOf(broad_phase, segment)) ids.push_back(hit.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace test
}  // namespace hgrid
