// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "broadphase/book/partition.h"

namespace hgrid {
namespace book {

/// Sort and sweep with an array (Ericson, Real-Time Collision Detection, 2005, section 7.5.2).
///
/// The boxes are sorted by their smallest coordinate on one axis. The search for pairs scans forward from each box
/// until a box begins behind its end. The axis is the one on which the centers have the largest variance. A box is
/// added at the end of the array and removed by moving the last box into the gap; the next search sorts. Insertion sort
/// does this, because the order changes little from frame to frame; a full sort takes over if it changes much.
///
/// Differs from the book:
/// - The variance is computed before the sort, not during the last scan, because searches do not change the array. It
///   is computed relative to the middle of the world, so it does not cancel far from the origin.
/// - Back pointers replace the search for a box that is removed.
/// - The largest end of all earlier boxes, a number per box, tells a query where its scan can begin.
/// - Fixed and other boxes are swept separately, so pairs of two fixed boxes cost nothing.
class SweepArray final : public Partition {
 public:
  SweepArray() : Partition("SweepArray") {}

 private:
  struct Entry {
    float min, max;  // [m] on the sorted axis
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

  int axis_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> place_;  // for each id: its index in entries_
  std::vector<float> end_so_far_;     // for each entry: the largest end of it and of all earlier ones
};

}  // namespace book
}  // namespace hgrid
