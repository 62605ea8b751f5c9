// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>

#include "broadphase/book/partition.h"

namespace hgrid {
namespace book {

/// An implicit grid (Ericson, Real-Time Collision Detection, 2005, section 7.1.5), in three dimensions.
///
/// Each axis is divided into slices, and each slice has one bit per box. A cell is only the intersection of three
/// slices. A query merges the slices that it overlaps with OR, one axis at a time, and intersects the three results
/// with AND. The work is done on vectors of 64-bit words.
///
/// Differs from the book:
/// - The loop over the set bits counts trailing zeros. The printed one clears the lowest bit where it should isolate
///   it, and does not end.
/// - The outermost slices reach to infinity, so the world has no border.
/// - For a segment, each slice of its longest axis is intersected with what the segment can reach in this slice.
class BitGrid final : public Partition {
 public:
  BitGrid() : Partition("BitGrid") {}

 private:
  static constexpr std::size_t kMostSlices = 128;  // per axis
  static constexpr std::size_t kWordsAtOnce = 64;  // words of one pass; they stay in the first-level cache
  using Words = std::array<std::uint64_t, kWordsAtOnce>;
  struct Span {
    std::size_t first, last;
  };
  struct Axis {
    double low = 0.0, inverse = 0.0;  // [m], [1/m] coordinate of the first slice; slices per meter
    std::size_t slices = 1;
    std::vector<std::uint64_t> bits;    // words of the first slice, then of the second one, ...
    std::vector<std::uint32_t> counts;  // for each slice: the number of its boxes (the summary form)
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
  std::size_t words_ = 0;  // per slice
};

}  // namespace book
}  // namespace hgrid
