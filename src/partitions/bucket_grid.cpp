// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/bucket_grid.h"

#include "partitions/stamps.h"

namespace hgrid {
namespace book {
namespace {

thread_local Stamps seen_boxes, seen_buckets;  // what the present query has met

}  // namespace

std::uint32_t BucketGrid::bucketOf(const Cell& cell) const {
  return static_cast<std::uint32_t>(CellHash()(cell) & (buckets_.size() - 1));
}

/// Replaces `buckets` with the buckets of a range of cells, each once.
void BucketGrid::bucketsOf(const CellRange& cells, std::vector<std::uint32_t>& buckets) const {
  buckets.clear();
  cells.visit([&](const Cell& cell) { buckets.push_back(bucketOf(cell)); });
  if (buckets.size() == 1) return;
  std::sort(buckets.begin(), buckets.end());
  buckets.erase(std::unique(buckets.begin(), buckets.end()), buckets.end());
}

// ---- changes

void BucketGrid::build() {
  const std::vector<ProxyId> ids = storedIds();
  scale_ = CellScale(cellEdgeFor(storedBoxes(), rule_));
  std::size_t buckets = 16;
  while (buckets < 2 * ids.size()) buckets *= 2;
  buckets_.assign(buckets, {});
  large_.clear();
  for (const ProxyId id : ids) added(id);
}

Partition::Followed BucketGrid::added(ProxyId id) {
  const CellRange cells = scale_.cellsOf(box(id));
  if (isLarge(cells)) {
    large_.add(id);
    return hasManyLargeBoxes() ? Followed::no : Followed::yes;
  }
  bucketsOf(cells, buckets_of_box_);
  for (const std::uint32_t bucket : buckets_of_box_) buckets_[bucket].push_back(id);
  return size() > 2 * buckets_.size() ? Followed::no : Followed::yes;  // no: the buckets are too full
}

Partition::Followed BucketGrid::removed(ProxyId id, const Aabb& from) {
  const CellRange cells = scale_.cellsOf(from);
  if (isLarge(cells)) {
    large_.remove(id);
    return Followed::yes;
  }
  bucketsOf(cells, buckets_of_box_);
  for (const std::uint32_t bucket : buckets_of_box_) eraseUnordered(buckets_[bucket], id);
  return Followed::yes;
}

Partition::Followed BucketGrid::moved(ProxyId id, const Aabb& from) {
  return scale_.cellsOf(from) == scale_.cellsOf(box(id)) ? Followed::yes : Partition::moved(id, from);
}

// ---- searches

void BucketGrid::findPairsInCells(PairSink& sink) const {
  std::vector<ProxyId> here;
  for (std::uint32_t bucket = 0; bucket < buckets_.size() && !sink.isFull(); ++bucket) {
    if (buckets_[bucket].size() < 2) continue;
    here = buckets_[bucket];
    sink.visitPairs(here, [&](ProxyId a, ProxyId b) {
      if (sink.isPair(a, b) && bucketOf(scale_.reportingCell(box(a), box(b))) == bucket) sink.add(a, b);
    });
  }
}

void BucketGrid::candidatesInCells(const QueryShape& shape, std::vector<ProxyId>& found) const {
  seen_boxes.begin(idEnd());
  seen_buckets.begin(buckets_.size());
  const Aabb& around = shape.bounds();
  const auto visit = [&](const std::vector<ProxyId>& bucket) {
    for (const ProxyId id : bucket) {
      if (overlap(around, box(id)) && seen_boxes.mark(id)) found.push_back(id);
    }
  };
  const auto limit = static_cast<double>(buckets_.size());
  const bool all = scale_.visitRanges(shape, CellScale::everywhere(), limit, [&](const CellRange& range) {
    range.visit([&](const Cell& cell) {
      const std::uint32_t bucket = bucketOf(cell);
      if (seen_buckets.mark(bucket)) visit(buckets_[bucket]);
    });
  });
  if (!all) {
    for (const std::vector<ProxyId>& bucket : buckets_) visit(bucket);
  }
}

void BucketGrid::checkStructure() const {
  std::size_t links = 0, expected = 0;
  for (const std::vector<ProxyId>& bucket : buckets_) {
    links += bucket.size();
    for (const ProxyId id : bucket) require(isStored(id), "each box in a bucket is stored");
  }
  std::vector<std::uint32_t> buckets;
  for (const ProxyId id : storedIds()) {
    const CellRange cells = scale_.cellsOf(box(id));
    require(large_.contains(id) == isLarge(cells), "a box is large if it covers too many cells");
    if (isLarge(cells)) continue;
    bucketsOf(cells, buckets);
    expected += buckets.size();
    for (const std::uint32_t bucket : buckets) {
      const std::vector<ProxyId>& list = buckets_[bucket];
      require(std::count(list.begin(), list.end(), id) == 1, "a box is once in the bucket of each of its cells");
    }
  }
  require(links == expected, "a box is in no other bucket");
}

std::size_t BucketGrid::structureBytes() const {
  std::size_t bytes = buckets_.capacity() * sizeof(std::vector<ProxyId>) + large_.bytes();
  for (const std::vector<ProxyId>& bucket : buckets_) bytes += bucket.capacity() * sizeof(ProxyId);
  return bytes;
}

/// Draws the cells of each box. The drawing does not show which of these cells share a bucket.
void BucketGrid::draw(std::vector<Aabb>& regions) const {
  for (const ProxyId id : storedIds()) {
    if (large_.contains(id)) continue;
    scale_.cellsOf(box(id)).visit([&](const Cell& cell) { regions.push_back(scale_.regionOf(cell)); });
  }
}

}  // namespace book
}  // namespace hgrid
