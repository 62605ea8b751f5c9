// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/book/sweep_lists.h"

#include <cmath>

namespace hgrid {
namespace book {

// ---- the lists

float SweepLists::valueOf(Link element, int axis) const {
  const Aabb& here = box(boxOf(element));
  return isMax(element) ? here.max[axis] : here.min[axis];
}

/// Whether an element comes before another one in a list. The head comes first, the tail last.
bool SweepLists::isBefore(Link a, Link b, int axis) const {
  if (a <= kTail || b <= kTail) return a == kHead || b == kTail;
  const float here = valueOf(a, axis), there = valueOf(b, axis);
  if (here != there) return here < there;
  return isMax(a) != isMax(b) ? isMax(b) : a < b;  // minima first: boxes that touch overlap
}

void SweepLists::unlink(Link element, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  const Element& here = elements_[element];
  elements_[here.previous[k]].next[k] = here.next[k];
  elements_[here.next[k]].previous[k] = here.previous[k];
}

void SweepLists::linkAfter(Link place, Link element, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  const Link next = elements_[place].next[k];
  elements_[element].previous[k] = place;
  elements_[element].next[k] = next;
  elements_[place].next[k] = element;
  elements_[next].previous[k] = element;
}

/// Adds a pair to the table if its boxes overlap on all axes. They have just begun to overlap on one axis.
void SweepLists::tryToTrack(ProxyId a, ProxyId b) {
  if (!tracks_ || a == b || (isFixed(a) && isFixed(b)) || !overlap(box(a), box(b)) || pairs_.of(a, b) != 0) return;
  pairs_.raise(a, b);
  if (pairs_.size() <= most_tracked_) return;
  tracks_ = false;
  pairs_.clear();
}

/// Moves an element to the left until its list is sorted there, and updates the table at each element that it passes.
void SweepLists::moveLeft(Link element, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  Link place = elements_[element].previous[k];
  for (; isBefore(element, place, axis); place = elements_[place].previous[k], ++steps_) {
    if (isMax(place) == isMax(element)) continue;
    if (isMax(place)) {
      tryToTrack(boxOf(element), boxOf(place));  // a minimum passes a maximum
    } else {
      pairs_.lower(boxOf(element), boxOf(place));  // a maximum passes a minimum
    }
  }
  unlink(element, axis);
  linkAfter(place, element, axis);
}

/// As moveLeft(), to the right.
void SweepLists::moveRight(Link element, int axis) {
  const auto k = static_cast<std::size_t>(axis);
  Link place = elements_[element].next[k];
  for (; isBefore(place, element, axis); place = elements_[place].next[k], ++steps_) {
    if (isMax(place) == isMax(element)) continue;
    if (isMax(place)) {
      pairs_.lower(boxOf(element), boxOf(place));  // a minimum passes a maximum
    } else {
      tryToTrack(boxOf(element), boxOf(place));  // a maximum passes a minimum
    }
  }
  unlink(element, axis);
  linkAfter(elements_[place].previous[k], element, axis);
}

/// Moves the elements of a box to their places. On each axis, the box first grows at both ends and then shrinks. So its
/// minimum never passes its own maximum.
void SweepLists::sortIn(ProxyId id) {
  const Link min = elementOf(id, false), max = elementOf(id, true);
  for (int axis = 0; axis < 3; ++axis) {
    moveLeft(min, axis);
    moveRight(max, axis);
    moveRight(min, axis);
    moveLeft(max, axis);
  }
}

// ---- changes

void SweepLists::build() {
  const std::vector<ProxyId> ids = storedIds();
  elements_.assign(2 + 2 * idEnd(), {});
  std::vector<Link> order;
  order.reserve(2 * ids.size());
  for (const ProxyId id : ids) {
    order.push_back(elementOf(id, false));
    order.push_back(elementOf(id, true));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    std::sort(order.begin(), order.end(), [&](Link a, Link b) { return isBefore(a, b, axis); });
    elements_[kHead].next[k] = kTail;
    elements_[kTail].previous[k] = kHead;
    Link last = kHead;
    for (const Link element : order) {
      linkAfter(last, element, axis);
      last = element;
    }
  }
  steps_ = 0;
  pairs_.clear();
  tracks_ = true;
  most_tracked_ = mostTrackedPairs();
  sweep([&](ProxyId a, ProxyId b) {
    tryToTrack(a, b);
    return tracks_;
  });
}

Partition::Followed SweepLists::added(ProxyId id) {
  if (elements_.size() < 2 + 2 * idEnd()) elements_.resize(2 + 2 * idEnd());
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    linkAfter(elements_[kTail].previous[k], elementOf(id, false), axis);
    linkAfter(elementOf(id, false), elementOf(id, true), axis);
  }
  return moved(id, box(id));
}

/// Unlinks a box. The boxes near it are looked up, because the table cannot list the pairs of one box.
Partition::Followed SweepLists::removed(ProxyId id, const Aabb& from) {
  if (tracks_) {
    std::vector<ProxyId> others;
    candidates(QueryShape(from), others);
    for (const ProxyId other : others) pairs_.lower(id, other);
  }
  for (int axis = 0; axis < 3; ++axis) {
    unlink(elementOf(id, false), axis);
    unlink(elementOf(id, true), axis);
  }
  return Followed::yes;
}

Partition::Followed SweepLists::moved(ProxyId id, const Aabb&) {
  sortIn(id);
  return steps_ > 64 * (size() + 16) ? Followed::no : Followed::settle;  // no: sorting anew is faster
}

// ---- searches

/// Calls visit(a, b) for each overlapping pair, unless both boxes are fixed, until `visit` returns false. It goes along
/// the list of the first axis and does not use the table.
template <class Visit>
void SweepLists::sweep(Visit&& visit) const {
  std::vector<ProxyId> movable, fixed;  // the boxes whose minimum was passed and whose maximum was not
  for (Link element = elements_[kHead].next[0]; element != kTail; element = elements_[element].next[0]) {
    const ProxyId id = boxOf(element);
    std::vector<ProxyId>& mine = isFixed(id) ? fixed : movable;
    if (isMax(element)) {
      eraseUnordered(mine, id);
      continue;
    }
    for (const std::vector<ProxyId>* others : {&movable, &fixed}) {
      if (isFixed(id) && others == &fixed) continue;
      for (const ProxyId other : *others) {
        if (overlap(box(id), box(other)) && !visit(id, other)) return;
      }
    }
    mine.push_back(id);
  }
}

void SweepLists::findPairs(PairSink& sink) const {
  if (tracks_) return pairs_.visit([&](ProxyId a, ProxyId b) { sink.add(a, b); });
  sweep([&](ProxyId a, ProxyId b) {
    sink.add(a, b);
    return !sink.isFull();
  });
}

void SweepLists::candidates(const QueryShape& shape, std::vector<ProxyId>& found) const {
  // A search can enter a list only at its ends. So it scans one of three lists from one of two ends, up to the far side
  // of the query. It takes the way that covers the smallest share of the world.
  const Aabb& around = shape.bounds();
  const Eigen::Vector3d size = world().max.cast<double>() - world().min.cast<double>();
  int axis = 0;
  bool from_left = true;
  double shortest = HUGE_VAL;
  for (int k = 0; k < 3; ++k) {
    const double left = double(around.max[k]) - double(world().min[k]),
                 right = double(world().max[k]) - double(around.min[k]);
    const double share = std::min(left, right) / std::max(size[k], 1e-30);
    if (share >= shortest) continue;
    shortest = share, axis = k, from_left = left <= right;
  }
  const auto k = static_cast<std::size_t>(axis);
  Link element = from_left ? elements_[kHead].next[k] : elements_[kTail].previous[k];
  while (element > kTail) {
    const ProxyId id = boxOf(element);
    const float value = valueOf(element, axis);
    if (from_left ? value > around.max[axis] : value < around.min[axis]) return;
    if (isMax(element) != from_left && shape.mayTouch(box(id))) found.push_back(id);
    element = from_left ? elements_[element].next[k] : elements_[element].previous[k];
  }
}

void SweepLists::checkStructure() const {
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    std::size_t count = 0;
    for (Link element = kHead; element != kTail; element = elements_[element].next[k], ++count) {
      const Link next = elements_[element].next[k];
      require(elements_[next].previous[k] == element, "the links of a list lead forth and back");
      require(isBefore(element, next, axis), "a list is sorted");
      require(element == kHead || isStored(boxOf(element)), "each element belongs to a stored box");
    }
    require(count == 2 * size() + 1, "each list has two elements for each box");
  }
  if (!tracks_) return;
  std::size_t count = 0;
  sweep([&](ProxyId a, ProxyId b) {
    require(pairs_.of(a, b) == 1, "each pair is tracked");
    ++count;
    return true;
  });
  require(count == pairs_.size(), "only pairs are tracked");
}

std::size_t SweepLists::structureBytes() const { return elements_.capacity() * sizeof(Element) + pairs_.bytes(); }

/// Draws a line through each element of the lists of x and y.
void SweepLists::draw(std::vector<Aabb>& regions) const {
  for (int axis = 0; axis < 2; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    for (Link element = elements_[kHead].next[k]; element != kTail; element = elements_[element].next[k]) {
      Aabb line = world();
      line.min[axis] = line.max[axis] = valueOf(element, axis);
      regions.push_back(line);
    }
  }
}

}  // namespace book
}  // namespace hgrid
