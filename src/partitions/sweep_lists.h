// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "partitions/axis_lists.h"
#include "partitions/id_set.h"
#include "partitions/pair_counts.h"
#include "partitions/partition.h"

namespace hgrid {
namespace book {

/// Sort and sweep with linked lists (Ericson, Real-Time Collision Detection, 2005, section 7.5.1).
///
/// AxisLists has a sorted list per axis of the minimum and maximum corners of all boxes. When a box moves, insertion
/// sort moves these elements to their new places. The overlap of two boxes on an axis changes only where a minimum of
/// one box and a maximum of the other pass each other:
/// - A minimum moves to the left of a maximum, or a maximum to the right of a minimum: the overlap begins.
/// - A minimum moves to the right of a maximum, or a maximum to the left of a minimum: the overlap ends.
///
/// The pair table holds all overlapping pairs. Each move updates it, so the search for all pairs only reads it.
///
/// Differs from the book:
/// - AxisLists orders equal coordinates, its links are indices of an array, and its sentinels have no coordinates.
/// - A new box enters at the right end of each list and moves to its place. So it meets all its pairs, also boxes that
///   enclose it. The book scans one list instead, but its printed loop never advances, and a scan only between the two
///   ends of the box would miss boxes that enclose it.
/// - The removal of a box also removes its pairs from the pair table.
/// - If elements pass too many others, as when boxes jump far, the next search sorts all lists again.
/// - The pair table does not hold pairs of two fixed boxes.
/// - If there are more than mostTrackedPairs(), the pair table is dropped to save memory. Until the lists are built
///   again, each search for pairs sweeps along the list of the first axis.
class SweepLists final : public Partition {
 public:
  SweepLists() : Partition("SweepLists") {}

 private:
  using Link = AxisLists::Link;
  static constexpr Link kHead = AxisLists::kHead, kTail = AxisLists::kTail;

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  bool rebuildsWhenMostMove() const override { return false; }
  bool tracksPairs() const override { return true; }
  /// The lists are always up to date. This only begins to count the steps anew.
  void settle() override { steps_ = 0; }
  void findPairs(PairSink& sink) const override;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  void sortIn(ProxyId id);
  void tryToTrack(ProxyId a, ProxyId b);
  template <class Visit>
  void sweep(Visit&& visit) const;

  AxisLists lists_{boxes()};
  PairCounts pairs_;       // the overlapping pairs; each counter is 1
  std::size_t steps_ = 0;  // elements that were passed since the last search
};

}  // namespace book
}  // namespace hgrid
