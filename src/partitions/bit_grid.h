// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>

#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// An implicit grid (Ericson, Real-Time Collision Detection, 2005, section 7.1.5), in the bit form.
///
/// Each axis is divided into slices: the rows and columns of the book, and layers in the third dimension. A slice is at
/// most as wide as a cell of CellRule::objects, unless kMostSlices limits their number. Each slice has one bit per box;
/// the index of the bit is the id of the box. A cell is only the intersection of three slices. A query combines the
/// slices that it overlaps on one axis with OR, and the results of the three axes with AND.
///
/// Differs from the book:
/// - There are at most kMostSlices slices per axis, because each of them takes memory for all ids.
/// - The outermost slices extend to infinity, so the world has no border.
/// - The summary form of the book is one bit per slice. Here it is a count of boxes, so removals can keep it exact.
/// - The loop over the set bits finds a bit by counting trailing zeros. The printed loop uses bits & (bits - 1) to find
///   it, which clears it instead, so the loop never ends.
/// - A segment is cut at the slices of its longest axis. In each slice, only the cells that this part can reach count.
///   The results of the slices are combined with OR.
/// - The words are processed four at a time, in blocks that stay in the cache.
class BitGrid final : public Partition {
 public:
  BitGrid() : Partition("BitGrid") {}

 private:
  static constexpr std::size_t kMostSlices = 128;  // per axis
  static constexpr std::size_t kWordsAtOnce = 64;  // words of one block; they stay in the first-level cache
  using Words = std::array<std::uint64_t, kWordsAtOnce>;
  struct Span {
    std::size_t first, last;  // slices, both included
  };
  struct Axis {
    double low = 0.0;      // [m] where the first slice begins
    double inverse = 0.0;  // [1/m] slices per meter
    std::size_t slices = 1;
    std::vector<std::uint64_t> bits;    // the words of the first slice, then of the second one, ...
    std::vector<std::uint32_t> counts;  // for each slice: the number of its boxes
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  void findPairs(PairSink& sink) const override;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  static std::size_t sliceOf(const Axis& axis, double coordinate);
  Span spanOf(int axis, const Aabb& box) const;
  void setBits(int axis, const Span& span, ProxyId id, bool value);
  void mergeInto(Words& merged, const Axis& axis, const Span& span, std::size_t begin, std::size_t count) const;
  void intersect(const Aabb& box, std::size_t begin, std::size_t count, Words& cells) const;

  std::array<Axis, 3> axes_;
  std::size_t words_ = 0;  // number of words per slice, a multiple of four
};

}  // namespace book
}  // namespace hgrid
