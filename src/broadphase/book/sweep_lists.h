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
/// Each box has two elements: its minimum corner and its maximum corner. Each element has links for three lists, one
/// per axis. A list contains all elements, sorted by their coordinate on its axis. When a box moves, insertion sort
/// moves its elements to their new places. The overlap of two boxes on an axis changes only where a minimum of one box
/// and a maximum of the other pass each other:
/// - A minimum moves to the left of a maximum, or a maximum to the right of a minimum: the overlap begins.
/// - A minimum moves to the right of a maximum, or a maximum to the left of a minimum: the overlap ends.
///
/// A table holds all overlapping pairs. Each move updates it, so the search for all pairs only reads it.
///
/// Differs from the book:
/// - Equal coordinates have an order: minima come before maxima. So boxes that touch overlap, whatever their history.
/// - Elements are in an array and links are indices, so an id leads to its elements. The sentinels have no coordinates;
///   isBefore() knows them.
/// - A new box enters at the right end of each list and moves to its place. So it meets all its pairs, also boxes that
///   enclose it. The printed scan never advances, and a look only between the two ends would miss such boxes.
/// - The removal of a box also removes its pairs from the table.
/// - If elements pass too many others, as when boxes jump far, the next search sorts all lists again.
/// - The table does not hold pairs of two fixed boxes.
/// - If there are far more pairs than the pair bound allows, the table is dropped to save memory. Until the lists are
///   built again, each search for pairs sweeps along the list of the first axis.
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
  PairCounts pairs_;              // the overlapping pairs; each counter is 1
  bool tracks_ = true;            // whether `pairs_` holds all pairs; false: the table was dropped
  std::size_t most_tracked_ = 0;  // if there are more pairs than this, the table is dropped
  std::size_t steps_ = 0;         // elements that were passed since the last search
};

}  // namespace book
}  // namespace hgrid
