// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>

#include "broadphase/book/id_set.h"
#include "broadphase/book/pair_counts.h"
#include "broadphase/book/partition.h"

namespace hgrid {
namespace book {

/// Sort and sweep with linked lists (Ericson, Real-Time Collision Detection, 2005, section 7.5.1).
///
/// Each box has two elements: its smallest corner (a minimum) and its largest corner (a maximum). There is a list per
/// axis. It contains all elements, sorted by their coordinate on this axis. When a box moves, insertion sort moves its
/// elements to their new places. Pairs begin or end only where a minimum and a maximum pass each other:
/// - If the minimum moves to the left of the maximum, the two boxes may begin to overlap.
/// - If the minimum moves to the right of the maximum, the two boxes stop overlapping.
///
/// A table holds all overlapping pairs. Each change of the lists updates it, so findPairs() only reads the table.
///
/// Differs from the book:
/// - Equal coordinates have an order: minima come before maxima. So boxes that touch overlap, whatever their history.
/// - A new box enters at the right end of each list and moves to its place. This finds all its pairs, also with boxes
///   that enclose it. (The printed scan never advances, and looks only between the ends of the box.)
/// - The removal of a box also removes its pairs from the table.
/// - If the order changes too much, as when boxes jump far, the next search sorts all lists again.
/// - The table does not hold pairs of two fixed boxes. If there are far more pairs than the pair bound allows, the
///   table is dropped. Until the lists are built again, a sweep along one list then finds the pairs.
class SweepLists final : public Partition {
 public:
  SweepLists() : Partition("SweepLists") {}

 private:
  using Link = std::uint32_t;  // index of an element: kHead, kTail, or elementOf(id, is_max)
  static constexpr Link kHead = 0, kTail = 1;
  struct Element {
    std::array<Link, 3> previous, next;
  };

  void build() override;
  Followed added(ProxyId id) override;
  Followed removed(ProxyId id, const Aabb& from) override;
  Followed moved(ProxyId id, const Aabb& from) override;
  bool rebuildsWhenMostMove() const override { return false; }
  bool tracksPairs() const override { return true; }
  void settle() override { steps_ = 0; }
  void findPairs(PairSink& sink) const override;
  void candidates(const QueryShape& shape, std::vector<ProxyId>& found) const override;
  void checkStructure() const override;
  std::size_t structureBytes() const override;
  void draw(std::vector<Aabb>& regions) const override;

  static Link elementOf(ProxyId id, bool is_max) { return 2 + 2 * id + (is_max ? 1 : 0); }
  static ProxyId boxOf(Link element) { return (element - 2) / 2; }
  static bool isMax(Link element) { return (element & 1) != 0; }
  float valueOf(Link element, int axis) const;
  bool isBefore(Link a, Link b, int axis) const;
  void unlink(Link element, int axis);
  void linkAfter(Link place, Link element, int axis);
  void moveLeft(Link element, int axis);
  void moveRight(Link element, int axis);
  void sortIn(ProxyId id);
  void tryToTrack(ProxyId a, ProxyId b);
  template <class Visit>
  void sweep(Visit&& visit) const;

  std::vector<Element> elements_;
  PairCounts pairs_;              // the counter of each overlapping pair is 1
  bool tracks_ = true;            // whether `pairs_` holds all pairs
  std::size_t most_tracked_ = 0;  // largest number of tracked pairs
  std::size_t steps_ = 0;         // elements that were passed since the last search
};

}  // namespace book
}  // namespace hgrid
