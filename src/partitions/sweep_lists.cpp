// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "partitions/sweep_lists.h"

#include <cmath>

#include "geometry/rounding.h"

namespace hgrid {
namespace book {

// ---- the pairs

/// Adds a pair to the pair table if its boxes overlap on all axes, are not both fixed, and are not in the table yet.
void SweepLists::tryToTrack(ProxyId a, ProxyId b) {
  if (a == b || (isFixed(a) && isFixed(b)) || !overlap(box(a), box(b)) || pairs_.of(a, b) != 0) return;
  pairs_.raise(a, b);
}

/// Moves the elements of a box to their places, and updates the pair table where they pass elements of other boxes. On
/// each axis, the box first grows at both ends and then shrinks. So its minimum never passes its own maximum.
void SweepLists::sortIn(ProxyId id) {
  const auto begins_at = [&](bool at_max) {
    return [this, id, at_max](Link passed) {
      ++steps_;
      if (AxisLists::isMax(passed) == at_max) tryToTrack(id, AxisLists::boxOf(passed));
    };
  };
  const auto ends_at = [&](bool at_max) {
    return [this, id, at_max](Link passed) {
      ++steps_;
      if (AxisLists::isMax(passed) == at_max) pairs_.lower(id, AxisLists::boxOf(passed));
    };
  };
  const Link min = AxisLists::elementOf(id, false), max = AxisLists::elementOf(id, true);
  for (int axis = 0; axis < 3; ++axis) {
    lists_.moveLeft(min, axis, begins_at(true));
    lists_.moveRight(max, axis, begins_at(false));
    lists_.moveRight(min, axis, ends_at(true));
    lists_.moveLeft(max, axis, ends_at(false));
  }
}

// ---- changes

void SweepLists::build() {
  lists_.sort(storedIds());
  steps_ = 0;
  pairs_.clear(mostTrackedPairs());
  sweep([&](ProxyId a, ProxyId b) {
    tryToTrack(a, b);
    return pairs_.isComplete();
  });
}

Partition::Followed SweepLists::added(ProxyId id) {
  lists_.append(id);
  return moved(id, box(id));
}

/// Unlinks a box, which takes O(1), and removes its pairs from the pair table. That table cannot list the pairs of one
/// box, and an extra list per box would make each move slower. So a query finds the possible partners, in O(n). To
/// insert a box takes as long, because its elements enter at the ends of the lists.
Partition::Followed SweepLists::removed(ProxyId id, const Aabb& from) {
  std::vector<ProxyId> others;
  if (pairs_.size() > 0) candidates(QueryShape(from), others);
  for (const ProxyId other : others) pairs_.lower(id, other);
  lists_.remove(id);
  return Followed::yes;
}

Partition::Followed SweepLists::moved(ProxyId id, const Aabb&) {
  sortIn(id);
  return steps_ > 64 * (size() + 16) ? Followed::no : Followed::settle;  // an estimate of when building is faster
}

// ---- searches

/// Calls visit(a, b) for each overlapping pair, unless both boxes are fixed, until `visit` returns false. It goes along
/// the list of the first axis and does not use the pair table.
template <class Visit>
void SweepLists::sweep(Visit&& visit) const {
  std::vector<ProxyId> movable, fixed;  // the boxes whose minimum was passed and whose maximum was not
  for (Link element = lists_.next(kHead, 0); element != kTail; element = lists_.next(element, 0)) {
    const ProxyId id = AxisLists::boxOf(element);
    std::vector<ProxyId>& mine = isFixed(id) ? fixed : movable;
    if (AxisLists::isMax(element)) {
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
  if (pairs_.isComplete()) return pairs_.visit([&](ProxyId a, ProxyId b) { sink.add(a, b); });
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
    const double share = std::min(left, right) / std::max(size[k], kLeastLength);
    if (share >= shortest) continue;
    shortest = share, axis = k, from_left = left <= right;
  }
  const auto step = [&](Link element) {
    return from_left ? lists_.next(element, axis) : lists_.previous(element, axis);
  };
  for (Link element = step(from_left ? kHead : kTail); element > kTail; element = step(element)) {
    const ProxyId id = AxisLists::boxOf(element);
    const float value = lists_.valueOf(element, axis);
    if (from_left ? value > around.max[axis] : value < around.min[axis]) return;
    if (AxisLists::isMax(element) != from_left && shape.mayTouch(box(id))) found.push_back(id);
  }
}

void SweepLists::checkStructure() const {
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t count = 0;
    for (Link element = kHead; element != kTail; element = lists_.next(element, axis), ++count) {
      const Link next = lists_.next(element, axis);
      require(lists_.previous(next, axis) == element, "the links of a list lead forth and back");
      require(lists_.isBefore(element, next, axis), "a list is sorted");
      require(element == kHead || isStored(AxisLists::boxOf(element)), "each element belongs to a stored box");
    }
    require(count == 2 * size() + 1, "each list has two elements for each box");
  }
  if (!pairs_.isComplete()) return;
  std::size_t count = 0;
  sweep([&](ProxyId a, ProxyId b) {
    require(pairs_.of(a, b) == 1, "each pair is tracked");
    ++count;
    return true;
  });
  require(count == pairs_.size(), "only pairs are tracked");
}

std::size_t SweepLists::structureBytes() const { return lists_.bytes() + pairs_.bytes(); }

/// Draws a line through each element of the lists of x and y.
void SweepLists::draw(std::vector<Aabb>& regions) const {
  for (int axis = 0; axis < 2; ++axis) {
    for (Link element = lists_.next(kHead, axis); element != kTail; element = lists_.next(element, axis)) {
      Aabb line = world();
      line.min[axis] = line.max[axis] = lists_.valueOf(element, axis);
      regions.push_back(line);
    }
  }
}

}  // namespace book
}  // namespace hgrid
