// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "broadphase/hgrid/engine.h"
#include "broadphase/hgrid/found_boxes.h"

namespace hgrid {
namespace {

/// Sorts the elements begin .. end - 1. For few elements it uses insertion sort, because std::sort is slower for them.
/// Most answers have few elements.
template <class Iterator, class Less>
__attribute__((noinline)) void sortFew(Iterator begin, Iterator end, Less less) {
  if (end - begin > 24) return std::sort(begin, end, less);
  for (Iterator i = begin; i != end; ++i) {
    auto value = *i;
    Iterator j = i;
    for (; j != begin && less(value, *(j - 1)); --j) *j = *(j - 1);
    *j = value;
  }
}

/// Sorts ids. Each id must be there only once. If there are few ids, counts for each id how many ids are smaller. This
/// takes more steps than other methods, but it has no branches that could be mispredicted.
__attribute__((noinline)) void sortIds(ProxyId* ids, std::size_t count) {
  constexpr std::size_t kFew = 32;
  if (count > kFew) return std::sort(ids, ids + count);
  std::array<ProxyId, kFew> unsorted;
  std::copy_n(ids, count, unsorted.begin());
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t before = 0;
    for (std::size_t k = 0; k < count; ++k) before += unsorted[k] < unsorted[i] ? 1u : 0u;
    ids[before] = unsorted[i];
  }
}

bool earlier(const SegmentHit& a, const SegmentHit& b) { return a.along != b.along ? a.along < b.along : a.id < b.id; }

/// Appends the ids of the found boxes that pass a test. @param boxes  see visitFound()
template <class Boxes, class Test>
inline void append(const Boxes& boxes, const PositionWriter& places, std::vector<ProxyId>& found, const Test& test) {
  std::size_t count = found.size();
  found.resize(count + places.size());
  for (const std::uint32_t place : places) {  // Store unconditionally and advance by 0 or 1: no misprediction
    found[count] = boxes.idAt(place);
    count += test(boxes.boxAt(place)) ? 1 : 0;
  }
  found.resize(count);
}

// Each addFound() appends those of the found boxes that touch the query. Not inlined, so that a query into empty space
// takes less time.
template <class Boxes>
__attribute__((noinline)) void addFound(const Boxes& boxes, const PositionWriter& places, const kernels::Box&,
                                        std::vector<ProxyId>& found) {
  append(boxes, places, found, [](const Aabb&) { return true; });
}
template <class Boxes>
__attribute__((noinline)) void addFound(const Boxes& boxes, const PositionWriter& places, const Sphere& query,
                                        std::vector<ProxyId>& found) {
  const double near = touchingDistance(query);
  append(boxes, places, found, [&](const Aabb& box) { return squaredDistance(box, query.center) <= near * near; });
}
template <class Boxes>
__attribute__((noinline)) void addFound(const Boxes& boxes, const PositionWriter& places, const Segment& query,
                                        std::vector<SegmentHit>& found) {
  const FirstTouch firstTouch(query);
  for (const std::uint32_t place : places) {
    const auto along = firstTouch(boxes.boxAt(place));
    if (along) found.push_back({boxes.idAt(place), *along});
  }
}

/// Sorts the answer of one query, which starts at index `begin`.
inline void sortFrom(std::size_t begin, std::vector<ProxyId>& found) {
  if (found.size() > begin + 1) sortIds(found.data() + begin, found.size() - begin);
}
inline void sortFrom(std::size_t begin, std::vector<SegmentHit>& found) {
  if (found.size() > begin + 1) sortFew(found.begin() + static_cast<std::ptrdiff_t>(begin), found.end(), earlier);
}

/// Appends the answer of one query to `found`. Several threads may call it at the same time.
template <class Engine, class Query, class Found>
inline void answer(const Engine& engine, const Query& query, std::vector<Found>& found) {
  const std::size_t before = found.size();
  visitFound(engine, query,
             [&](const auto& boxes, const PositionWriter& places) { addFound(boxes, places, query, found); });
  sortFrom(before, found);
}
template <class Engine>
inline void answer(const Engine& engine, const Aabb& query, std::vector<ProxyId>& found) {
  answer(engine, boxOf(query), found);
}

}  // namespace

void HGrid::overlapping(const Aabb& box, std::vector<ProxyId>& found) const {
  found.clear();
  answer(*engine_, box, found);
}

void HGrid::overlapping(const Sphere& sphere, std::vector<ProxyId>& found) const {
  found.clear();
  answer(*engine_, sphere, found);
}

void HGrid::along(const Segment& segment, std::vector<SegmentHit>& found) const {
  found.clear();
  answer(*engine_, segment, found);
}

}  // namespace hgrid
