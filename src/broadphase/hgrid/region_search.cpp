// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/region_search.h"

#include <algorithm>

#include "broadphase/hgrid/found_boxes.h"
#include "broadphase/hgrid/search_tasks.h"

namespace hgrid {
namespace {

/// Returns which share of the volume of a box is within another box. They overlap.
double shareWithin(const kernels::Box& other, const kernels::Box& box) {
  double share = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const float length = box.max[axis] - box.min[axis];
    const float within = std::min(box.max[axis], other.max[axis]) - std::max(box.min[axis], other.min[axis]);
    if (within < length) share *= static_cast<double>(within) / static_cast<double>(length);
  }
  return share;
}

}  // namespace

void RegionSearch::within(const Layer& layer, std::uint32_t number) {
  const std::vector<kernels::Level>& levels = layer.levels();
  const kernels::Region& region = layer.regions().region(number);
  const std::uint32_t first = region.first_level, last = first + region.levels;
  for (std::uint32_t i = first; i < last; ++i) {
    kernels_.pairsWithin(&levels[i], levels[i].begin, levels[i].end, sink_);
    for (std::uint32_t coarser = i + 1; coarser < last; ++coarser) meet(levels[i], levels[coarser]);
  }
  meetAll(layer, region, layer, last);
}

void RegionSearch::across(const Layer& layer, std::uint32_t number, const Layer& other) {
  meetAll(layer, layer.regions().region(number), other, 0);
}

/// Finds the pairs of which one box is in `region`, and the other box is in the layer `other`.
/// @param least  smallest index of the levels of `other` that are searched
void RegionSearch::meetAll(const Layer& layer, const kernels::Region& region, const Layer& other, std::uint32_t least) {
  const kernels::LevelSet others = other.levelSet();
  for (std::uint32_t i = 0; i < region.levels; ++i) {
    const kernels::Level& level = layer.levels()[region.first_level + i];
    PositionWriter near(gathered_.levels);
    kernels_.reaching(&others, &level.around, near.sink());
    for (const std::uint32_t number : near) {
      if (number >= least) meet(level, other.levels()[number]);
    }
  }
}

/// Finds the pairs of two levels. Only boxes that overlap the bounds of the other level ask. They are counted, and
/// firstAsks() decides which of them ask. Those of the larger level are not counted if they are likely too many.
void RegionSearch::meet(const kernels::Level& a, const kernels::Level& b) {
  constexpr std::size_t kFew = 8;    // number of boxes; it is cheaper to test so few boxes without a selection
  constexpr std::size_t kMany = 16;  // least number of boxes of the smaller level for which the others are counted
  constexpr std::size_t kTimes = 8;  // the larger level has at most so many times as many boxes if they are counted
  if (sink_->full || !overlap(a.around, b.around)) return;
  const bool a_is_smaller = a.end - a.begin <= b.end - b.begin;
  const kernels::Level &smaller = a_is_smaller ? a : b, &larger = a_is_smaller ? b : a;
  const std::size_t all = smaller.end - smaller.begin, all_others = larger.end - larger.begin;
  if (all <= kFew && firstAsks(smaller, all, larger, all_others))
    return kernels_.pairsAcross(&smaller, smaller.begin, smaller.end, &larger, sink_);
  PositionWriter near(gathered_.positions);
  select(smaller, larger, near);
  if (near.size() == 0) return;
  // Counting the boxes of the larger level takes time. It is worth it only if twice as many as are likely, judged by
  // the volume of the bounds, would ask in less time.
  const double likely = 2.0 * shareWithin(smaller.around, larger.around) * static_cast<double>(all_others);
  const bool is_worth_counting = near.size() >= kMany && all_others <= kTimes * near.size() &&
                                 !firstAsks(smaller, near.size(), larger, static_cast<std::size_t>(likely));
  if (!is_worth_counting && firstAsks(smaller, near.size(), larger, all_others)) return askSome(smaller, near, larger);
  PositionWriter others(gathered_.other_positions);
  select(larger, smaller, others);
  if (firstAsks(smaller, near.size(), larger, others.size())) {
    askSome(smaller, near, larger);
  } else {
    askSome(larger, others, smaller);
  }
}

/// Finds the boxes of `asking` that overlap the bounds of `asked`.
void RegionSearch::select(const kernels::Level& asking, const kernels::Level& asked, PositionWriter& near) const {
  const kernels::LevelSet all = {&asking, 1, nullptr, 0, 0};
  kernels_.overlapping(&all, &asked.around, near.sink());
}

/// Finds the pairs of some boxes of `asking` with the boxes of `asked`. @param positions  of these boxes
void RegionSearch::askSome(const kernels::Level& asking, const PositionWriter& positions, const kernels::Level& asked) {
  const std::size_t count = positions.size();
  if (count == 0) return;
  if (count == asking.end - asking.begin) {
    return kernels_.pairsAcross(&asking, asking.begin, asking.end, &asked, sink_);
  }
  kernels::Level some = asking;
  some.stride = count + kReadBeyond;
  some.begin = 0;
  some.end = static_cast<std::uint32_t>(count);
  if (gathered_.bounds.size() < 6 * some.stride) gathered_.bounds.resize(12 * some.stride);
  if (gathered_.ids.size() < some.stride) gathered_.ids.resize(2 * some.stride);
  float* bounds = gathered_.bounds.data();
  std::uint32_t* id = gathered_.ids.data();
  for (const std::uint32_t position : positions) {
    const float* const from = asking.bounds + position;
    for (std::size_t side = 0; side < 6; ++side) bounds[side * some.stride] = from[side * asking.stride];
    *id++ = asking.id[position];
    ++bounds;
  }
  some.bounds = gathered_.bounds.data();
  some.id = gathered_.ids.data();
  kernels_.pairsAcross(&some, some.begin, some.end, &asked, sink_);
}

}  // namespace hgrid
