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
/// Each box has two elements, its smallest and its largest corner. Each element is in three sorted lists, one per axis.
/// A box that moves takes its elements along by insertion sort, and the overlapping pairs change only where elements
/// pass each other: if a minimum passes a maximum to the left, the boxes may begin to overlap; if it passes to the
/// right, they end. The pairs are tracked in a table, so the search for pairs only reads it.
///
/// Differs from the book:
/// - Equal coordinates have an order: minima come before maxima. So boxes that touch overlap, whatever their history.
/// - A new box enters at the right end of each list and moves to its place. This finds all its pairs, also with boxes
///   that enclose it. (The printed scan never advances, and looks only between the ends of the box.)
/// - A removed box takes its pairs along.
/// - If the order changes too much, as when boxes jump far, the next search sorts all lists again.
/// - Pairs of two fixed boxes are not tracked. If there are more pairs than the pair bound allows, tracking stops, and
/// a
///   sweep along one list finds the pairs, until the lists are built again.
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
  bool dependsOnFixed() const override { return true; }
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
  void begins(ProxyId a, ProxyId b);
  template <class Visit>
  void sweep(Visit&& visit) const;

  std::vector<Element> elements_;
  PairCounts pairs_;       // the counter of each overlapping pair is 1
  bool tracks_ = true;     // whether `pairs_` holds all pairs
  std::size_t most_ = 0;   // largest number of tracked pairs
  std::size_t steps_ = 0;  // elements that were passed since the last search
};

}  // namespace book
}  // namespace hgrid
