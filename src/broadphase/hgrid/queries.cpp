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

Eigen::Vector3f positionOf(const Aabb& box) { return box.min; }
Eigen::Vector3f positionOf(const Sphere& sphere) { return sphere.center.cast<float>(); }
Eigen::Vector3f positionOf(const Segment& segment) { return segment.from.cast<float>(); }

/// Assigns points in space to buckets. The buckets are the regions of a layer. If the layer has only one region, the
/// buckets are the cells of a coarse grid.
class Buckets {
 public:
  explicit Buckets(const Layer& layer) : layer_(layer), grid_(layer.levels().front().grid) {}

  std::size_t size() const {
    return layer_.isDivided() ? layer_.regions().size() : static_cast<std::size_t>(kAcross * kAcross * kAcross);
  }
  /// Returns the index of the bucket that a point [m] belongs to.
  std::uint32_t at(const Eigen::Vector3f& position) const {
    if (layer_.isDivided()) return layer_.regions().regionOf(position.data());
    std::uint32_t bucket = 0;
    for (const int axis : {2, 1, 0}) {
      const float share =
          (position[axis] * grid_.inverse[axis] - grid_.origin[axis]) * (kAcross / (grid_.last[axis] + 1.0f));
      const float number = std::min(share > 0.0f ? share : 0.0f, kAcross - 1.0f);  // 0 if `share` is NaN
      bucket = bucket * static_cast<std::uint32_t>(kAcross) + static_cast<std::uint32_t>(number);
    }
    return bucket;
  }

 private:
  static constexpr float kAcross = 16.0f;
  const Layer& layer_;
  const kernels::Grid& grid_;
};

/// Returns the indices of the queries, sorted by the buckets of positionOf(query). So queries that need the same boxes
/// follow each other.
template <class Query>
std::vector<std::uint32_t> byPosition(const std::vector<Query>& queries, const Layer& layer) {
  const Buckets buckets(layer);
  std::vector<std::uint32_t> next(buckets.size() + 1, 0), bucket_of(queries.size()), order(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    bucket_of[i] = buckets.at(positionOf(queries[i]));
    ++next[bucket_of[i] + 1];
  }
  for (std::size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  for (std::uint32_t i = 0; i < queries.size(); ++i) order[next[bucket_of[i]]++] = i;
  return order;
}

/// Answers many queries. If the boxes do not fit into the cache, answers the queries in the order of byPosition().
template <class Engine, class Query, class Found>
void answerAll(const Engine& engine, const std::vector<Query>& queries, BatchOf<Found>& batch) {
  constexpr std::size_t kFitsTheCache = std::size_t{1} << 18;  // with fewer boxes, sorting the queries does not pay
  constexpr std::size_t kAhead = 8;                            // how many queries before its turn a query is prefetched
  batch.begin.resize(queries.size());
  batch.count.resize(queries.size());
  batch.found.clear();
  // Not the loose layer: another thread may sort it now.
  const Layer& largest = *std::max_element(engine.layers.begin(), engine.layers.begin() + Engine::kLoose,
                                           [](const Layer& a, const Layer& b) { return a.size() < b.size(); });
  const auto answerOne = [&](std::size_t i) {
    batch.begin[i] = static_cast<std::uint32_t>(batch.found.size());
    answer(engine, queries[i], batch.found);
    batch.count[i] = static_cast<std::uint32_t>(batch.found.size()) - batch.begin[i];
  };
  if (largest.size() < kFitsTheCache) {
    for (std::size_t i = 0; i < queries.size(); ++i) answerOne(i);
  } else {
    const std::vector<std::uint32_t> order = byPosition(queries, largest);
    for (std::size_t k = 0; k < order.size(); ++k) {
      const char* const ahead = reinterpret_cast<const char*>(&queries[order[std::min(k + kAhead, order.size() - 1)]]);
      __builtin_prefetch(ahead);
      __builtin_prefetch(ahead + sizeof(Query) - 1);
      answerOne(order[k]);
    }
  }
}

}  // namespace

void HGrid::Engine::prepareQueries() const {
  const std::lock_guard<std::mutex> lock(tree_mutex);
  if (isPrepared()) return;
  sortLoose();
  for (std::size_t number = 0; number < layers.size(); ++number) {
    if (layers[number].size() == 0 || treeOf(number) != nullptr) continue;
    trees[number].build(layers[number]);
    tree_changes[number].store(changesOf(number), std::memory_order_release);
  }
  prepared_count = 0;  // no query reads it now, because isPrepared() is false
  for (std::size_t number = 0; number < layers.size(); ++number) {
    if (layers[number].size() != 0) prepared[prepared_count++] = static_cast<std::uint8_t>(number);
  }
  prepared_changes.store(changes(), std::memory_order_release);
}

void HGrid::prepareQueries() const { engine_->prepareQueries(); }

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

void HGrid::overlapping(const std::vector<Aabb>& boxes, IdBatch& found) const { answerAll(*engine_, boxes, found); }

void HGrid::overlapping(const std::vector<Sphere>& spheres, IdBatch& found) const {
  answerAll(*engine_, spheres, found);
}

void HGrid::along(const std::vector<Segment>& segments, SegmentBatch& found) const {
  answerAll(*engine_, segments, found);
}

}  // namespace hgrid
