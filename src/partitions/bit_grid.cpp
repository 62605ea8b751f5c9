// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/bit_grid.h"

#include <cmath>

#include "partitions/bit_words.h"
#include "partitions/cell_scale.h"

namespace hgrid {
namespace book {
// ---- slices

std::size_t BitGrid::sliceOf(const Axis& axis, double coordinate) {
  if (axis.slices == 1) return 0;
  const double slice = std::floor((coordinate - axis.low) * axis.inverse);  // never less for a larger coordinate
  return static_cast<std::size_t>(std::clamp(slice, 0.0, static_cast<double>(axis.slices - 1)));
}

BitGrid::Span BitGrid::spanOf(int axis, const Aabb& box) const {
  const Axis& here = axes_[static_cast<std::size_t>(axis)];
  return {sliceOf(here, double(box.min[axis])), sliceOf(here, double(box.max[axis]))};
}

void BitGrid::setBits(int axis, const Span& span, ProxyId id, bool value) {
  Axis& here = axes_[static_cast<std::size_t>(axis)];
  for (std::size_t slice = span.first; slice <= span.last; ++slice) {
    std::uint64_t& word = here.bits[slice * words_ + id / 64];
    const std::uint64_t bit = std::uint64_t{1} << (id % 64);
    word = value ? word | bit : word & ~bit;
    value ? ++here.counts[slice] : --here.counts[slice];
  }
}

// ---- changes

void BitGrid::build() {
  const std::vector<ProxyId> ids = storedIds();
  const double edge = cellEdgeFor(storedBoxes(), CellRule::objects);
  words_ = (idEnd() + idEnd() / 2 + 255) / 256 * 4;  // with room for half as many ids again
  for (int k = 0; k < 3; ++k) {
    Axis& axis = axes_[static_cast<std::size_t>(k)];
    const double low = double(world().min[k]), length = double(world().max[k]) - low;
    axis.low = low;
    axis.slices = static_cast<std::size_t>(std::clamp(std::ceil(length / edge), 1.0, double(kMostSlices)));
    axis.inverse = length > 0.0 ? std::min(static_cast<double>(axis.slices) / length, 1e300) : 0.0;
    axis.bits.assign(axis.slices * words_, 0);
    axis.counts.assign(axis.slices, 0);
  }
  for (const ProxyId id : ids) added(id);
}

Partition::Followed BitGrid::added(ProxyId id) {
  if (id / 64 >= words_) return Followed::no;
  for (int axis = 0; axis < 3; ++axis) setBits(axis, spanOf(axis, box(id)), id, true);
  return Followed::yes;
}

Partition::Followed BitGrid::removed(ProxyId id, const Aabb& from) {
  for (int axis = 0; axis < 3; ++axis) setBits(axis, spanOf(axis, from), id, false);
  return Followed::yes;
}

Partition::Followed BitGrid::moved(ProxyId id, const Aabb& from) {
  for (int axis = 0; axis < 3; ++axis) {
    const Span before = spanOf(axis, from), now = spanOf(axis, box(id));
    if (before.first == now.first && before.last == now.last) continue;
    setBits(axis, before, id, false);
    setBits(axis, now, id, true);
  }
  return Followed::yes;
}

// ---- searches

/// Combines the words begin .. begin + count - 1 of a span of slices with OR. `count` is a multiple of four.
void BitGrid::mergeInto(Words& merged, const Axis& axis, const Span& span, std::size_t begin, std::size_t count) const {
  std::fill_n(merged.begin(), count, 0);
  for (std::size_t slice = span.first; slice <= span.last; ++slice) {
    if (axis.counts[slice] == 0) continue;
    const std::uint64_t* words = &axis.bits[slice * words_ + begin];
    for (std::size_t i = 0; i < count; i += 4) four(&merged[i]) |= four(words + i);
  }
}

/// Computes the bits of the boxes that share a cell with `box`, for the words begin .. begin + count - 1:
/// (OR of the slices on x) AND (OR of those on y) AND (OR of those on z).
void BitGrid::intersect(const Aabb& box, std::size_t begin, std::size_t count, Words& cells) const {
  Words merged;
  mergeInto(cells, axes_[0], spanOf(0, box), begin, count);
  for (int axis = 1; axis < 3; ++axis) {
    mergeInto(merged, axes_[static_cast<std::size_t>(axis)], spanOf(axis, box), begin, count);
    for (std::size_t i = 0; i < count; i += 4) four(&cells[i]) &= four(&merged[i]);
  }
}

void BitGrid::findPairs(PairSink& sink) const {
  std::vector<std::uint64_t> movable(words_, 0);  // bit per box: whether it is not fixed
  const std::vector<ProxyId> ids = storedIds();
  for (const ProxyId id : ids) movable[id / 64] |= std::uint64_t{isFixed(id) ? 0u : 1u} << (id % 64);
  Words cells;
  for (const ProxyId id : ids) {
    if (sink.isFull()) return;
    // Boxes with smaller ids have found their pairs with this box already. So the search begins at the word of `id`,
    // rounded down to a multiple of four words.
    for (std::size_t begin = id / 64 / 4 * 4; begin < words_; begin += kWordsAtOnce) {
      const std::size_t count = std::min(kWordsAtOnce, words_ - begin);
      intersect(box(id), begin, count, cells);
      if (isFixed(id)) {  // tryPair() would leave out pairs of fixed boxes, too, but one by one
        for (std::size_t i = 0; i < count; ++i) cells[i] &= movable[begin + i];
      }
      visitBits(cells.data(), count, begin, [&](ProxyId other) {
        if (other > id) sink.tryPair(id, other);
      });
    }
  }
}

void BitGrid::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  Words cells, part;
  for (std::size_t begin = 0; begin < words_; begin += kWordsAtOnce) {
    const std::size_t count = std::min(kWordsAtOnce, words_ - begin);
    if (shape.kind() == QueryShape::Kind::segment) {
      const int k = shape.longAxis();
      const Axis& axis = axes_[static_cast<std::size_t>(k)];
      const Span span = spanOf(k, shape.bounds());
      cells.fill(0);
      for (std::size_t slice = span.first; slice <= span.last; ++slice) {
        const double width = axis.slices > 1 ? 1.0 / axis.inverse : 0.0;
        // The bounds of the slice, grown by a thousandth against rounding.
        const double low = slice == 0 ? -HUGE_VAL : axis.low + width * (static_cast<double>(slice) - 0.001);
        const double high =
            slice + 1 == axis.slices ? HUGE_VAL : axis.low + width * (static_cast<double>(slice) + 1.001);
        const Aabb reach = shape.slice(k, low, high);
        intersect(reach, begin, count, part);
        const std::uint64_t* words = &axis.bits[slice * words_ + begin];
        for (std::size_t i = 0; i < count; i += 4) four(&cells[i]) |= four(&part[i]) & four(words + i);
      }
    } else {
      intersect(shape.bounds(), begin, count, cells);
    }
    visitBits(cells.data(), count, begin, [&](ProxyId id) {
      if (overlap(shape.bounds(), box(id))) found.push_back(id);
    });
  }
}

void BitGrid::checkStructure() const {
  for (int k = 0; k < 3; ++k) {
    const Axis& axis = axes_[static_cast<std::size_t>(k)];
    for (std::size_t slice = 0; slice < axis.slices; ++slice) {
      std::uint32_t set = 0, expected = 0;
      visitBits(axis.bits.data() + slice * words_, words_, 0, [&](ProxyId id) {
        ++set;
        require(isStored(id), "each set bit belongs to a stored box");
        const Span span = spanOf(k, box(id));
        require(span.first <= slice && slice <= span.last, "a box overlaps each slice in which its bit is set");
      });
      for (const ProxyId id : storedIds()) {
        const Span span = spanOf(k, box(id));
        expected += span.first <= slice && slice <= span.last ? 1 : 0;
      }
      require(set == expected && set == axis.counts[slice], "the bit of a box is set in all slices that it overlaps");
    }
  }
}

std::size_t BitGrid::structureBytes() const {
  std::size_t bytes = 0;
  for (const Axis& axis : axes_)
    bytes += axis.bits.capacity() * sizeof(std::uint64_t) + axis.counts.capacity() * sizeof(std::uint32_t);
  return bytes;
}

void BitGrid::draw(std::vector<Aabb>& regions) const {
  for (int k = 0; k < 2; ++k) {
    const Axis& axis = axes_[static_cast<std::size_t>(k)];
    for (std::size_t slice = 0; slice < axis.slices; ++slice) {
      Aabb region = world();
      const double width = axis.inverse > 0.0 ? 1.0 / axis.inverse : 0.0;
      region.min[k] = static_cast<float>(axis.low + width * static_cast<double>(slice));
      region.max[k] = static_cast<float>(axis.low + width * static_cast<double>(slice + 1));
      regions.push_back(region);
    }
  }
}

}  // namespace book
}  // namespace hgrid
