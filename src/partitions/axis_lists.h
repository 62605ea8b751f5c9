// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {
namespace book {

/// The lists of SweepLists: one doubly linked list per axis, sorted by coordinate (Ericson, Real-Time Collision
/// Detection, 2005, section 7.5.1).
///
/// Each box has two elements: its minimum corner and its maximum corner. Each element has links for all three lists.
/// Elements are in an array and links are indices, so an id leads to its elements.
///
/// Equal coordinates have an order: minima come before maxima, and among equal minima or maxima the smaller id comes
/// first. So boxes that touch overlap, whatever their history.
/// Each list begins with the element kHead and ends with kTail. These two have no coordinates: isBefore() places kHead
/// before and kTail after all other elements.
class AxisLists {
 public:
  using Link = std::uint32_t;  // index of an element: kHead, kTail, or elementOf(id, is_max)
  static constexpr Link kHead = 0, kTail = 1;

  /// @param boxes  by id; the lists read the coordinates there
  explicit AxisLists(const std::vector<Aabb>& boxes) : boxes_(boxes) {}

  static Link elementOf(ProxyId id, bool is_max) { return 2 + 2 * id + (is_max ? 1 : 0); }
  static ProxyId boxOf(Link element) { return (element - 2) / 2; }
  static bool isMax(Link element) { return (element & 1) != 0; }

  float valueOf(Link element, int axis) const {
    const Aabb& box = boxes_[boxOf(element)];
    return isMax(element) ? box.max[axis] : box.min[axis];
  }
  /// Whether an element comes before another one in a list. The head comes first, the tail last.
  bool isBefore(Link a, Link b, int axis) const {
    if (a <= kTail || b <= kTail) return a == kHead || b == kTail;
    const float here = valueOf(a, axis), there = valueOf(b, axis);
    if (here != there) return here < there;
    return isMax(a) != isMax(b) ? isMax(b) : a < b;
  }
  Link next(Link element, int axis) const { return elements_[element].next[static_cast<std::size_t>(axis)]; }
  Link previous(Link element, int axis) const { return elements_[element].previous[static_cast<std::size_t>(axis)]; }

  /// Makes all lists anew. @param ids  ascending
  void sort(const std::vector<ProxyId>& ids) {
    elements_.assign(ids.empty() ? 2 : elementOf(ids.back() + 1, false), {});
    std::vector<Link> order;
    order.reserve(2 * ids.size());
    for (const ProxyId id : ids) {
      order.push_back(elementOf(id, false));
      order.push_back(elementOf(id, true));
    }
    for (int axis = 0; axis < 3; ++axis) {
      std::sort(order.begin(), order.end(), [&](Link a, Link b) { return isBefore(a, b, axis); });
      join(kHead, kTail, axis);
      for (const Link element : order) linkBefore(kTail, element, axis);
    }
  }
  /// Adds the elements of a box at the right end of each list.
  void append(ProxyId id) {
    if (elements_.size() <= elementOf(id, true)) elements_.resize(elementOf(id + 1, false));
    for (int axis = 0; axis < 3; ++axis) {
      linkBefore(kTail, elementOf(id, false), axis);
      linkBefore(kTail, elementOf(id, true), axis);
    }
  }
  void remove(ProxyId id) {
    for (int axis = 0; axis < 3; ++axis) {
      unlink(elementOf(id, false), axis);
      unlink(elementOf(id, true), axis);
    }
  }
  /// Moves an element to the left until its list is sorted there. Calls passed(other) for each element that it passes.
  template <class Passed>
  void moveLeft(Link element, int axis, Passed&& passed) {
    Link place = previous(element, axis);
    for (; isBefore(element, place, axis); place = previous(place, axis)) passed(place);
    unlink(element, axis);
    linkBefore(next(place, axis), element, axis);
  }
  /// As moveLeft(), to the right.
  template <class Passed>
  void moveRight(Link element, int axis, Passed&& passed) {
    Link place = next(element, axis);
    for (; isBefore(place, element, axis); place = next(place, axis)) passed(place);
    unlink(element, axis);
    linkBefore(place, element, axis);
  }
  /// Returns the memory [bytes] of the elements.
  std::size_t bytes() const { return elements_.capacity() * sizeof(Element); }

 private:
  struct Element {
    std::array<Link, 3> previous, next;
  };
  /// Makes two elements neighbors.
  void join(Link left, Link right, int axis) {
    elements_[left].next[static_cast<std::size_t>(axis)] = right;
    elements_[right].previous[static_cast<std::size_t>(axis)] = left;
  }
  void unlink(Link element, int axis) { join(previous(element, axis), next(element, axis), axis); }
  void linkBefore(Link place, Link element, int axis) {
    join(previous(place, axis), element, axis);
    join(element, place, axis);
  }

  const std::vector<Aabb>& boxes_;
  std::vector<Element> elements_;
};

}  // namespace book
}  // namespace hgrid
