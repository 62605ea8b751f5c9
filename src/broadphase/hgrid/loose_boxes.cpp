// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/loose_boxes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "geometry/rounding.h"
#include "hgrid_proximity/geometry/sphere.h"

namespace hgrid {
namespace {

constexpr double kFarthest = 0x1p30;  // largest index of a cell
constexpr float kInfinite = std::numeric_limits<float>::infinity();
// A cell costs about as much as this number of boxes that a search goes through in order.
constexpr double kBoxesPerCell = 4.0;

/// @param box  an Aabb or a kernels::Box
template <class Box>
bool touchesBox(const kernels::Box& query, const Box& box) {
  bool both = true;
  for (int axis = 0; axis < 3; ++axis)
    both = both & (query.min[axis] <= box.max[axis]) & (box.min[axis] <= query.max[axis]);
  return both;
}

void write(std::uint32_t place, kernels::PositionSink* sink) {
  if (sink->next == sink->limit) sink->grow(sink);
  *sink->next++ = place;
}

void makeContain(kernels::Box& outer, const kernels::Box& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    outer.min[axis] = std::min(outer.min[axis], inner.min[axis]);
    outer.max[axis] = std::max(outer.max[axis], inner.max[axis]);
  }
}

}  // namespace

LooseBoxes::LooseBoxes(double finest_edge) : finest_(std::ilogb(finest_edge)) {
  for (std::uint32_t level = 0; level < kLevels; ++level)
    levels_[level].inverse = std::ldexp(1.0 / kCellToSide, -finest_ - static_cast<int>(level));
  clear();
}

void LooseBoxes::clear() {
  for (Level& level : levels_) reset(level);
  std::fill(buckets_.begin(), buckets_.end(), Bucket());
  occupied_ = 0;
  size_ = 0;
  excess_ = 0;
}

void LooseBoxes::reset(Level& level) {
  level.entries.clear();
  level.longest = 0.0;
  level.around = {{kInfinite, kInfinite, kInfinite}, {-kInfinite, -kInfinite, -kInfinite}};
}

// ---- where a box belongs

/// Never decreases if the coordinate increases, in spite of rounding. Nor does the center of a box if its corners
/// increase. A search relies on both.
std::int32_t LooseBoxes::indexOf(double coordinate, const Level& level) {
  const double cells = std::clamp(coordinate * level.inverse, -kFarthest, kFarthest);
  return static_cast<std::int32_t>(static_cast<std::int64_t>(cells + kFarthest) - static_cast<std::int64_t>(kFarthest));
}

/// Returns the finest level whose boxes may be as long as this one, and whose cells are not so small that the rounding
/// of the coordinates exceeds them. The last level also holds all longer boxes.
std::uint32_t LooseBoxes::levelOf(const Aabb& box) const {
  double side = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    side = std::max({side, high - low, 0x1p-22 * std::abs(low), 0x1p-22 * std::abs(high)});
  }
  std::uint64_t bits;
  std::memcpy(&bits, &side, sizeof bits);
  const int exponent = static_cast<int>(bits >> 52) - 1022;  // side < 2^exponent; -1022 if it is 0
  return static_cast<std::uint32_t>(std::clamp(exponent - finest_, 0, static_cast<int>(kLevels) - 1));
}

LooseBoxes::Cell LooseBoxes::cellOf(const Aabb& box, const Level& level) {
  Cell cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double center = 0.5 * (static_cast<double>(box.min[axis]) + static_cast<double>(box.max[axis]));
    cell[static_cast<std::size_t>(axis)] = indexOf(center, level);
  }
  return cell;
}

std::uint32_t LooseBoxes::bucketOf(const Cell& cell, std::uint32_t level) const {
  const std::uint64_t sum = static_cast<std::uint32_t>(cell[0]) * 0x8da6b343ull +
                            static_cast<std::uint32_t>(cell[1]) * 0xd8163841ull +
                            static_cast<std::uint32_t>(cell[2]) * 0xcb1ab31full + level * 0x165667b1ull;
  return static_cast<std::uint32_t>(sum * 0x9e3779b97f4a7c15u >> 32 & (buckets_.size() - 1));
}

// ---- changes

void LooseBoxes::reserve(const Aabb& box) {
  std::vector<Entry>& entries = levels_[levelOf(box)].entries;
  if (entries.size() == entries.capacity()) entries.reserve(std::max<std::size_t>(16, 2 * entries.size()));
  if (size_ < buckets_.size()) return;
  // No bucket gets more boxes than one had before, because the lowest bits of the hash stay what they were.
  std::vector<Bucket> more(std::max<std::size_t>(64, 2 * buckets_.size()));
  buckets_.swap(more);
  visitAll([this](ProxyId, std::uint32_t place) { link(place); });
}

bool LooseBoxes::hasRoom(const Aabb& box) const {
  const std::uint32_t level = levelOf(box);
  if (size_ >= kIndexMask) return false;  // no place is left
  return size_ == 0 || buckets_[bucketOf(cellOf(box, levels_[level]), level)].count < kMostInBucket;
}

/// Puts an entry into the list of its bucket.
void LooseBoxes::link(std::uint32_t place) {
  Entry& entry = entryAt(place);
  Bucket& bucket = buckets_[bucketOf(entry.cell, levelOf(place))];
  ++bucket.count;
  entry.previous = kNone;
  entry.next = bucket.first;
  if (bucket.first != kNone) entryAt(bucket.first).previous = place;
  bucket.first = place;
}

void LooseBoxes::unlink(std::uint32_t place) {
  const Entry& entry = entryAt(place);
  Bucket& bucket = buckets_[bucketOf(entry.cell, levelOf(place))];
  --bucket.count;
  if (entry.next != kNone) entryAt(entry.next).previous = entry.previous;
  (entry.previous != kNone ? entryAt(entry.previous).next : bucket.first) = entry.next;
}

/// Makes the bounds and the longest side of a level at least as large as a box.
void LooseBoxes::extend(Level& level, const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    constexpr double kGrown = 1.0 + 1e-15;  // not less than the side, in spite of rounding
    level.longest = std::max(level.longest, (high - low) * kGrown);
    level.around.min[axis] = std::min(level.around.min[axis], box.min[axis]);
    level.around.max[axis] = std::max(level.around.max[axis], box.max[axis]);
  }
}

std::uint32_t LooseBoxes::add(ProxyId id, const Aabb& box) {
  const std::uint32_t number = levelOf(box);
  Level& level = levels_[number];
  const std::uint32_t place = placeOf(number, level.entries.size());
  level.entries.push_back({box, id, cellOf(box, level), kNone, kNone});
  link(place);
  extend(level, box);
  occupied_ |= 1u << number;
  ++size_;
  return place;
}

bool LooseBoxes::move(std::uint32_t place, const Aabb& box) {
  const std::uint32_t number = levelOf(box);
  if (number != levelOf(place)) return false;
  Level& level = levels_[number];
  Entry& entry = entryAt(place);
  const Cell cell = cellOf(box, level);
  if (cell != entry.cell) {
    if (buckets_[bucketOf(cell, number)].count >= kMostInBucket) return false;
    unlink(place);
    entry.cell = cell;
    link(place);
  }
  entry.box = box;
  extend(level, box);
  return true;
}

bool LooseBoxes::remove(std::uint32_t place) {
  unlink(place);
  Level& level = levels_[levelOf(place)];
  const std::uint32_t last = placeOf(levelOf(place), level.entries.size() - 1);
  if (place != last) {
    const Entry& entry = entryAt(place) = entryAt(last);
    if (entry.next != kNone) entryAt(entry.next).previous = place;
    (entry.previous != kNone ? entryAt(entry.previous).next : buckets_[bucketOf(entry.cell, levelOf(place))].first) =
        place;
  }
  level.entries.pop_back();
  --size_;
  if (level.entries.empty()) {
    reset(level);
    occupied_ &= ~(1u << levelOf(place));
  }
  return place != last;
}

// ---- searches

kernels::Box LooseBoxes::around() const {
  kernels::Box bounds = levels_[0].around;
  for (const Level& level : levels_) makeContain(bounds, level.around);
  return bounds;
}

/// Writes the places of all boxes of a level that pass a test.
template <class Test>
void LooseBoxes::writeAll(std::uint32_t level, const Test& test, kernels::PositionSink* sink) const {
  const std::vector<Entry>& entries = levels_[level].entries;
  for (std::uint32_t index = 0; index < entries.size(); ++index) {
    if (test(entries[index].box)) write(placeOf(level, index), sink);
  }
}

/// Writes the places of the boxes in some cells of a level that pass a test. Several cells may share a bucket, so the
/// cell of each box is compared, too.
template <class Test>
void LooseBoxes::writeCells(const Cell& low, const Cell& high, std::uint32_t level, const Test& test,
                            kernels::PositionSink* sink) const {
  Cell cell;
  for (cell[2] = low[2]; cell[2] <= high[2]; ++cell[2]) {
    for (cell[1] = low[1]; cell[1] <= high[1]; ++cell[1]) {
      for (cell[0] = low[0]; cell[0] <= high[0]; ++cell[0]) {
        for (std::uint32_t place = buckets_[bucketOf(cell, level)].first; place != kNone;) {
          const Entry& entry = entryAt(place);
          if (test(entry.box) && entry.cell == cell && levelOf(place) == level) write(place, sink);
          place = entry.next;
        }
      }
    }
  }
}

void LooseBoxes::overlapping(const kernels::Box& query, kernels::PositionSink* sink) const {
  const auto touches = [&](const Aabb& box) { return touchesBox(query, box); };
  double work = 0.0;
  for (std::uint32_t levels = occupied_; levels != 0; levels &= levels - 1) {
    const auto number = static_cast<std::uint32_t>(__builtin_ctz(levels));
    const Level& level = levels_[number];
    if (!touchesBox(query, level.around)) continue;  // also if a coordinate is NaN
    // The center of a box that overlaps the query is at most half of the longest side away from it.
    const double reach = 0.5 * level.longest;
    Cell low, high;
    double cells = kBoxesPerCell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = indexOf(static_cast<double>(query.min[axis]) - reach, level);
      high[axis] = indexOf(static_cast<double>(query.max[axis]) + reach, level);
      cells *= 1.0 + high[axis] - low[axis];
    }
    if (cells > static_cast<double>(level.entries.size())) {
      work += static_cast<double>(level.entries.size());
      writeAll(number, touches, sink);
    } else {
      work += cells;
      writeCells(low, high, number, touches, sink);
    }
  }
  const auto units = static_cast<std::uint64_t>(work);
  if (units > kFreeWork) excess_.fetch_add(units - kFreeWork, std::memory_order_relaxed);
}

/// Goes through each level by slices of cells along the longest axis of the line (Ericson 2005, 7.4.2), so that it does
/// not visit all cells within the bounds of the line.
void LooseBoxes::along(const kernels::Line& line, kernels::PositionSink* sink) const {
  std::size_t axis = 0;
  double farthest = line.around;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(line.step[i]) > std::abs(line.step[axis])) axis = i;
    farthest = std::max({farthest, std::abs(line.from[i]), std::abs(line.from[i] + line.step[i])});
  }
  if (!(farthest < 1e30)) {  // also if a number is NaN
    for (std::uint32_t level = 0; level < kLevels; ++level)
      writeAll(
          level, [](const Aabb&) { return true; }, sink);
    return;
  }
  // The bounds of the part of the line whose coordinate on the axis is within low .. high, grown by `reach`.
  using Bounds = std::array<std::array<double, 2>, 3>;
  const auto part = [&](double low, double high, double reach) {
    double first = 0.0, last = 1.0;
    if (std::abs(line.step[axis]) > kLeastStep) {
      first = (low - reach - line.from[axis]) / line.step[axis];
      last = (high + reach - line.from[axis]) / line.step[axis];
      if (first > last) std::swap(first, last);
      first = std::clamp(first, 0.0, 1.0), last = std::clamp(last, 0.0, 1.0);
    }
    Bounds bounds;
    for (std::size_t i = 0; i < 3; ++i) {
      const double a = line.from[i] + first * line.step[i], b = line.from[i] + last * line.step[i];
      bounds[i] = {std::min(a, b) - reach, std::max(a, b) + reach};
    }
    return bounds;
  };
  constexpr double kBeyond = 1e31;  // [m] farther than any part of the line
  const Bounds near = part(-kBeyond, kBeyond, line.around + roundingSlack(farthest));
  kernels::Box bounds;
  for (std::size_t i = 0; i < 3; ++i) bounds.min[i] = roundedDown(near[i][0]), bounds.max[i] = roundedUp(near[i][1]);
  const auto touches = [&](const Aabb& box) { return touchesBox(bounds, box); };
  for (std::uint32_t levels = occupied_; levels != 0; levels &= levels - 1) {
    const auto number = static_cast<std::uint32_t>(__builtin_ctz(levels));
    const Level& level = levels_[number];
    if (!touchesBox(bounds, level.around)) continue;
    const double edge = 1.0 / level.inverse;
    constexpr double kHalf = 0.5 + 1e-9, kIndexRounding = 1e-6;  // far more than what rounding can add up to
    const double reach = line.around + kHalf * level.longest + roundingSlack(farthest);
    const double across = 3.0 + 4.0 * reach * level.inverse;  // cells of a slice on each other axis, at most
    const double slices = 2.0 + (std::abs(line.step[axis]) + 2.0 * reach) * level.inverse;
    if (kBoxesPerCell * slices * across * across > static_cast<double>(level.entries.size())) {
      writeAll(number, touches, sink);
      continue;
    }
    const Bounds whole = part(-kBeyond, kBeyond, reach);
    const std::int32_t end = indexOf(whole[axis][1], level);
    for (std::int32_t slice = indexOf(whole[axis][0], level); slice <= end; ++slice) {
      // The outermost slices hold everything beyond them. Indices of cells are rounded to 2^-22 of an edge.
      const bool outermost = std::abs(slice) >= kFarthest;
      const Bounds here = part(outermost ? -kBeyond : (slice - kIndexRounding) * edge,
                               outermost ? kBeyond : (slice + 1 + kIndexRounding) * edge, reach);
      Cell low, high;
      for (std::size_t i = 0; i < 3; ++i) low[i] = indexOf(here[i][0], level), high[i] = indexOf(here[i][1], level);
      low[axis] = high[axis] = slice;
      writeCells(low, high, number, touches, sink);
    }
  }
}

std::size_t LooseBoxes::bytes() const {
  std::size_t bytes = buckets_.capacity() * sizeof(Bucket);
  for (const Level& level : levels_) bytes += level.entries.capacity() * sizeof(Entry);
  return bytes;
}

void LooseBoxes::checkInvariants() const {
  const auto require = [](bool holds, const char* invariant) {
    if (!holds) throw std::logic_error(std::string("LooseBoxes: this invariant is violated: ") + invariant);
  };
  std::size_t listed = 0, stored = 0;
  for (std::uint32_t number = 0; number < buckets_.size(); ++number) {
    std::uint32_t previous = kNone, count = 0;
    for (std::uint32_t place = buckets_[number].first; place != kNone; place = entryAt(place).next, ++count) {
      const Entry& entry = entryAt(place);
      const Level& level = levels_[levelOf(place)];
      require(entry.previous == previous, "the list of a bucket is linked in both directions");
      require(levelOf(entry.box) == levelOf(place), "a box is on the level of its size");
      require(entry.cell == cellOf(entry.box, level), "a box is in the cell of its center");
      require(bucketOf(entry.cell, levelOf(place)) == number, "a box is in the bucket of its cell");
      const Eigen::Vector3d size = entry.box.max.cast<double>() - entry.box.min.cast<double>();
      require(size.maxCoeff() <= level.longest, "no box is longer than the longest side of its level");
      previous = place;
    }
    require(count == buckets_[number].count && count <= kMostInBucket, "a bucket counts its boxes and is not too full");
    listed += count;
  }
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    stored += levels_[level].entries.size();
    require((occupied_ >> level & 1) == (levels_[level].entries.empty() ? 0u : 1u),
            "the mask names the occupied levels");
  }
  require(listed == size_ && stored == size_, "each box is on one level and in one bucket");
}

}  // namespace hgrid
