// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/hashed_hgrid.h"

#include <cmath>
#include <limits>

#include "partitions/stamps.h"

namespace hgrid {
namespace book {
namespace {

thread_local Stamps time_stamps;  // the buckets that the present search of a level has visited

/// Returns a larger shape. On each axis, its bounds and its slices contain the center of each box that touches the
/// shape and whose sides are at most twice the reach. Only bounds and slices do: a corner is farther from the center
/// than the reach.
/// @param reach  [m]
QueryShape grown(const QueryShape& shape, double reach) {
  if (shape.kind() == QueryShape::Kind::segment) {
    Segment segment = shape.segment();
    segment.radius += reach;
    return QueryShape(segment);
  }
  Aabb box = shape.bounds();
  for (int axis = 0; axis < 3; ++axis) {  // the double of a sum can be smaller than the sum by a rounding error
    box.min[axis] = roundedDown(static_cast<double>(box.min[axis]) - reach);
    box.max[axis] = roundedUp(static_cast<double>(box.max[axis]) + reach);
  }
  return QueryShape(box);
}

}  // namespace

int HashedHGrid::levelFor(const Aabb& box) const {
  const double side = longestSideInDouble(box);
  int level = 0;
  if (side > kSizeToCell * finest_) {  // in place of the loop of the listing
    const double ratio = side / (kSizeToCell * finest_);
    level = ratio < 0x1p40 ? std::ilogb(ratio) : kMostLevels;  // so that the exponent is a small number
  }
  while (level < kMostLevels && side > mostSideOn(level)) ++level;  // at most once
  return std::min(level, kMostLevels);
}

Cell HashedHGrid::cellOf(const Aabb& box, const CellScale& scale) {
  const Eigen::Vector3d center = 0.5 * (box.min.cast<double>() + box.max.cast<double>());
  return {scale.indexOf(center.x()), scale.indexOf(center.y()), scale.indexOf(center.z())};
}

std::uint32_t HashedHGrid::bucketOf(const Cell& cell, int level) const {
  const std::uint64_t hash = CellHash()(cell) + static_cast<std::uint64_t>(level) * 0x165667b1u;
  return static_cast<std::uint32_t>(hash & (object_bucket_.size() - 1));
}

// ---- changes

void HashedHGrid::build() {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  const std::vector<ProxyId> ids = storedIds();
  for (const ProxyId id : ids) {
    const double side = longestSideInDouble(box(id));
    if (side > 0.0) smallest = std::min(smallest, side);
    largest = std::max(largest, side);
  }
  // Points take the level of the smallest box. If all boxes are points, their density gives the cells.
  finest_ = largest > 0.0 ? smallest / kSizeToCell : cellEdgeFor(storedBoxes(), CellRule::density);
  // Reciprocals of edges must be finite, and the largest box needs a level.
  finest_ = std::max({finest_, 0x1p-60, std::ldexp(largest / kSizeToCell, 1 - kMostLevels)});
  std::size_t buckets = 16;
  while (buckets < 2 * ids.size()) buckets *= 2;
  object_bucket_.assign(buckets, kNobody);
  objects_.assign(idEnd(), Object());
  for (std::vector<ProxyId>& boxes : on_level_) boxes.clear();
  oversized_.clear();
  occupied_levels_ = 0;
  for (const ProxyId id : ids) added(id);
}

Partition::Followed HashedHGrid::added(ProxyId id) {
  if (id >= objects_.size()) objects_.resize(id + std::size_t{1});
  Object& object = objects_[id];
  object = Object();
  object.level = levelFor(box(id));
  if (object.level == kMostLevels) {
    oversized_.add(id);
    return 8 * oversized_.size() > size() + 64 ? Followed::no : Followed::yes;  // no: coarser cells are needed
  }
  std::vector<ProxyId>& level = on_level_[static_cast<std::size_t>(object.level)];
  object.place = static_cast<std::uint32_t>(level.size());
  level.push_back(id);
  occupied_levels_ |= 1u << object.level;
  object.bucket = bucketOf(cellOf(box(id), scaleOf(object.level)), object.level);
  ProxyId& head = object_bucket_[object.bucket];
  object.next = head;
  if (head != kNobody) objects_[head].previous = id;
  head = id;
  return size() > 2 * object_bucket_.size() ? Followed::no : Followed::yes;  // no: the buckets are too full
}

Partition::Followed HashedHGrid::removed(ProxyId id, const Aabb&) {
  const Object& object = objects_[id];
  if (object.level == kMostLevels) {
    oversized_.remove(id);
    return Followed::yes;
  }
  std::vector<ProxyId>& level = on_level_[static_cast<std::size_t>(object.level)];
  level[object.place] = level.back();  // the last box takes its place
  objects_[level.back()].place = object.place;
  level.pop_back();
  if (level.empty()) occupied_levels_ &= ~(1u << object.level);
  if (object.next != kNobody) objects_[object.next].previous = object.previous;
  (object.previous != kNobody ? objects_[object.previous].next : object_bucket_[object.bucket]) = object.next;
  return Followed::yes;
}

Partition::Followed HashedHGrid::moved(ProxyId id, const Aabb& from) {
  const Object& object = objects_[id];
  const int level = levelFor(box(id));
  if (level == object.level) {
    if (level == kMostLevels) return Followed::yes;
    if (bucketOf(cellOf(box(id), scaleOf(level)), level) == object.bucket) return Followed::yes;
  }
  return Partition::moved(id, from);
}

// ---- searches

/// Calls visit(id) for each box of a level that the shape touches, and perhaps for other boxes of this level. Visits no
/// box twice.
template <class Visit>
void HashedHGrid::visitLevel(const QueryShape& shape, int level, Visit&& visit) const {
  const std::vector<ProxyId>& boxes = on_level_[static_cast<std::size_t>(level)];
  const CellScale scale = scaleOf(level);
  const QueryShape around = grown(shape, 0.5 * mostSideOn(level));
  const auto visit_bucket = [&](const Cell& cell) {
    const std::uint32_t bucket = bucketOf(cell, level);
    if (!time_stamps.mark(bucket)) return;
    for (ProxyId id = object_bucket_[bucket]; id != kNobody; id = objects_[id].next) {
      if (objects_[id].level == level) visit(id);
    }
  };
  // For a segment, it turns out only on the way that there are too many cells. So they are counted before the first of
  // them is visited.
  const auto limit = static_cast<double>(boxes.size());
  if (!scale.visitRanges(around, CellScale::everywhere(), limit, [](const CellRange&) {})) {
    for (const ProxyId id : boxes) visit(id);
    return;
  }
  time_stamps.begin(object_bucket_.size());
  scale.visitRanges(around, CellScale::everywhere(), limit, [&](const CellRange& range) { range.visit(visit_bucket); });
}

void HashedHGrid::findPairs(PairSink& sink) const {
  // Of an oversized box and any other, the oversized one reports the pair.
  for (const ProxyId id : oversized_) {
    if (sink.isFull()) return;
    for (const ProxyId other : oversized_) {
      if (id < other) sink.tryPair(id, other);
    }
    for (const std::vector<ProxyId>& level : on_level_) {
      for (const ProxyId other : level) sink.tryPair(id, other);
    }
  }
  for (int level = 0; level < kMostLevels && !sink.isFull(); ++level) {
    for (const ProxyId id : on_level_[static_cast<std::size_t>(level)]) {
      const QueryShape shape(box(id));
      for (int above = level; above < kMostLevels; ++above) {
        if ((occupied_levels_ >> above & 1) == 0) continue;
        visitLevel(shape, above, [&](ProxyId other) {
          if (above > level || id < other) sink.tryPair(id, other);
        });
      }
      if (sink.isFull()) return;
    }
  }
}

void HashedHGrid::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  const Aabb& around = shape.bounds();
  const auto visit = [&](ProxyId id) {
    if (overlap(around, box(id))) found.push_back(id);
  };
  for (const ProxyId id : oversized_) visit(id);
  for (int level = 0; level < kMostLevels; ++level) {
    if ((occupied_levels_ >> level & 1) != 0) visitLevel(shape, level, visit);
  }
}

void HashedHGrid::checkStructure() const {
  std::size_t listed = 0, on_levels = oversized_.size();
  for (std::uint32_t bucket = 0; bucket < object_bucket_.size(); ++bucket) {
    ProxyId previous = kNobody;
    for (ProxyId id = object_bucket_[bucket]; id != kNobody; previous = id, id = objects_[id].next, ++listed) {
      require(isStored(id) && objects_[id].bucket == bucket && objects_[id].previous == previous,
              "the list of a bucket is linked in both directions and holds only its boxes");
      require(objects_[id].level == levelFor(box(id)), "a box is on the level of its size");
      require(bucket == bucketOf(cellOf(box(id), scaleOf(objects_[id].level)), objects_[id].level),
              "a box is in the bucket of its center");
    }
  }
  for (int level = 0; level < kMostLevels; ++level) {
    const std::vector<ProxyId>& boxes = on_level_[static_cast<std::size_t>(level)];
    on_levels += boxes.size();
    require(!boxes.empty() == ((occupied_levels_ >> level & 1) != 0), "the mask names the levels that hold boxes");
    for (std::uint32_t place = 0; place < boxes.size(); ++place) {
      const Object& object = objects_[boxes[place]];
      require(object.level == level && object.place == place, "the list of a level holds only its boxes");
    }
  }
  for (const ProxyId id : oversized_) require(levelFor(box(id)) == kMostLevels, "only an oversized box has no level");
  require(on_levels == size() && listed + oversized_.size() == size(), "each box is on one level and in one bucket");
}

std::size_t HashedHGrid::structureBytes() const {
  std::size_t bytes =
      object_bucket_.capacity() * sizeof(ProxyId) + objects_.capacity() * sizeof(Object) + oversized_.bytes();
  for (const std::vector<ProxyId>& boxes : on_level_) bytes += boxes.capacity() * sizeof(ProxyId);
  return bytes;
}

/// Draws the cell of each box.
void HashedHGrid::draw(std::vector<Aabb>& regions) const {
  for (const ProxyId id : storedIds()) {
    if (objects_[id].level == kMostLevels) continue;
    const CellScale scale = scaleOf(objects_[id].level);
    regions.push_back(scale.regionOf(cellOf(box(id), scale)));
  }
}

}  // namespace book
}  // namespace hgrid
