// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// Sort and sweep with an array (Ericson, Real-Time Collision Detection, 2005, section 7.5.2).
///
/// The boxes are sorted by their minimum on one axis: the axis on which their centers have the largest variance. The
/// search for all pairs scans forward from each box, up to the first box that begins behind its end. A new box is added
/// at the end of the array. If a box is removed, the last box fills the gap. The next search sorts the array again.
///
/// Differs from the book:
/// - The variance is computed before the array is sorted, not during the last search for pairs. Searches do not change
///   the array, because several threads may search at the same time.
/// - The variance is computed relative to the middle of the world. Otherwise the sums of squares would cancel far from
///   the origin.
/// - The array is sorted by insertion, because the order changes little from frame to frame. If it changes much,
///   std::sort takes over.
/// - The entries hold copies of the ends on the axis, not pointers to boxes. So a scan reads one array.
/// - A back pointer per box replaces the binary search for a box that is removed.
/// - For each entry, the largest end of all entries up to it is stored. It tells a query where its scan has to begin.
/// - Boxes that are fixed and boxes that are not are swept as two sequences. So pairs of two fixed boxes cost nothing.
class SweepArray final : public Partition {
 public:
  SweepArray() : Partition("SweepArray") {}

 private:
  struct Entry {
    float min, max;  // [m] ends of the box on the sorted axis; settle() fills them in
    ProxyId id;
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId, const Aabb&) override { return Followed::settle; }
  bool rebuildsWhenMostMove() const override { return false; }
  void settle() override;
  void findPairs(PairSink& sink) const override;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  int axisOfLargestVariance() const;
  void sort();

  int axis_ = 0;  // the sorted axis
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> place_;  // for each id: its index in entries_
  std::vector<float> end_so_far_;     // for each entry: the largest end of it and of all earlier ones
};

}  // namespace book
}  // namespace hgrid
