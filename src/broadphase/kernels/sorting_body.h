// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The first pass of sorting boxes into cells.
// This is a part of kernels_body.h, which explains the type Simd.
#pragma once

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

bool sound(const Box* boxes, std::size_t count) {
  bool sound = true;
  for (std::size_t i = 0; i < count; ++i) sound = sound & Simd::isSound(boxes[i]);
  return sound;
}

/// Returns the box of the i-th id in `order`, and prefetches the box of a later id.
inline const Box& fetched(const Keying& k, std::size_t i) {
  constexpr std::size_t kAhead = 32;
  const char* ahead = reinterpret_cast<const char*>(k.boxes + k.order[i + kAhead < k.readable ? i + kAhead : i]);
  __builtin_prefetch(ahead);
  __builtin_prefetch(ahead + sizeof(Box) - 1);
  return k.boxes[k.order[i]];
}

/// Finds the cell of box i in `order` from its minimum corner, stores the index of the cell and counts the box there.
inline void countIn(Keying& k, std::size_t i, std::uint32_t level, Simd::Quad min) {
  const Grid& grid = k.grids[level];
  std::int32_t cell[4];
  Simd::cellsOf(min, grid, cell);
  const std::uint32_t number =
      k.first_cells[level] +
      static_cast<std::uint32_t>(cell[0] * grid.steps[0] + cell[1] * grid.steps[1] + cell[2] * grid.steps[2]);
  k.cells[i] = number;
  ++k.counts[number];
}

/// What selects the level of a box.
enum class LevelBy {
  nothing,  ///< there is only one level; its longest sides stay in a register
  size,
  shape
};

/// Visits the boxes in the order of the last sort. This is nearly the order of their cells. So counts and copies are
/// written almost sequentially. Only the boxes are read at random places, by id. So they are prefetched.
template <LevelBy kBy>
void keyLevels(Keying& k) {
  constexpr int kMostLevels = kBy == LevelBy::nothing ? 1 : 17;
  const int levels = kBy == LevelBy::nothing ? 1 : k.levels;
  Simd::Quad largest[kMostLevels], lower = Simd::quadOf(k.lower), upper = Simd::quadOf(k.upper);
  for (int level = 0; level < levels; ++level) largest[level] = Simd::quadOf(k.sizes + 4 * level);
  for (std::size_t i = k.begin; i < k.end; ++i) {
    const Box& box = fetched(k, i);
    if (k.copies != nullptr) k.copies[i] = box;
    const Simd::Quad min = Simd::minimaOf(box), size = Simd::minus(Simd::maximaOf(box), min);
    lower = Simd::least(lower, min);
    upper = Simd::greatest(upper, min);
    int level = 0;
    if (kBy == LevelBy::shape) level = k.level_of_shape[Simd::longAxes(size, kLongRatio)];
    if (kBy == LevelBy::size) {
      const float side = Simd::greatestOfThree(size);
      while (level + 1 < levels && side > k.sides[level]) ++level;
    }
    largest[level] = Simd::greatest(largest[level], size);
    countIn(k, i, static_cast<std::uint32_t>(level), min);
  }
  for (int level = 0; level < levels; ++level) Simd::store(largest[level], k.sizes + 4 * level);
  Simd::store(lower, k.lower);
  Simd::store(upper, k.upper);
}

void key(Keying* keying) {
  if (keying->levels == 1) {
    keyLevels<LevelBy::nothing>(*keying);
  } else if (keying->level_of_shape != nullptr) {
    keyLevels<LevelBy::shape>(*keying);
  } else {
    keyLevels<LevelBy::size>(*keying);
  }
}

/// The longest sides of a level's boxes, and the bounds of their minimum corners.
struct LevelCensus {
  LevelCensus(const Keying& k, std::uint32_t number)
      : level(number),
        largest(Simd::quadOf(k.sizes + 4 * std::size_t{number})),
        lower(Simd::quadOf(k.corners + 8 * std::size_t{number})),
        upper(Simd::quadOf(k.corners + 8 * std::size_t{number} + 4)) {}
  void store(Keying& k) const {
    Simd::store(largest, k.sizes + 4 * std::size_t{level});
    Simd::store(lower, k.corners + 8 * std::size_t{level});
    Simd::store(upper, k.corners + 8 * std::size_t{level} + 4);
  }

  std::uint32_t level;
  Simd::Quad largest, lower, upper;
};

/// Returns whether the region contains a minimum corner.
inline bool isIn(const Region& region, const float* corner) {
  bool in = true;
  for (int axis = 0; axis < 3; ++axis) {
    in = in & (corner[axis] >= region.low[axis]) & (corner[axis] < region.high[axis]);
  }
  return in;
}

/// Works like key(), but for several regions. First tries the region of the box before, because successive boxes in
/// the order of the last sort are nearly always in the same region. They are also mostly on the same level. So the
/// statistics of the current level stay in registers until the level changes.
void keyRegions(Keying* keying) {
  Keying& k = *keying;
  const Region* region = k.regions;
  LevelCensus census(k, 0);
  for (std::size_t i = k.begin; i < k.end; ++i) {
    const Box& box = fetched(k, i);
    if (k.copies != nullptr) k.copies[i] = box;
    if (!isIn(*region, box.min)) {
      const Branch* branch = k.branches;
      while (branch->axis >= 0) {
        branch = k.branches + (box.min[branch->axis] < branch->split ? branch->below : branch->above);
      }
      region = k.regions + branch->below;
    }
    const Simd::Quad min = Simd::minimaOf(box), size = Simd::minus(Simd::maximaOf(box), min);
    std::uint32_t level = region->first_level;
    if (region->levels > 1) {
      const float side = Simd::greatestOfThree(size);
      const std::uint32_t last = level + region->levels - 1;
      while (level < last && side > k.sides[level]) ++level;
    }
    if (level != census.level) {
      census.store(k);
      census = LevelCensus(k, level);
    }
    census.largest = Simd::greatest(census.largest, size);
    census.lower = Simd::least(census.lower, min);
    census.upper = Simd::greatest(census.upper, min);
    countIn(k, i, level, min);
  }
  census.store(k);
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
