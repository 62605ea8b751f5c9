// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The first half of sorting boxes into cells.
// Part of kernels_body.h, which says what Simd is.
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

/// Fetches the box of the i-th id, and in advance a later one.
inline const Box& fetched(const Keying& k, std::size_t i) {
  constexpr std::size_t kAhead = 32;
  const char* ahead = reinterpret_cast<const char*>(k.boxes + k.order[i + kAhead < k.readable ? i + kAhead : i]);
  __builtin_prefetch(ahead);
  __builtin_prefetch(ahead + sizeof(Box) - 1);
  return k.boxes[k.order[i]];
}

/// Counts the box with number i in its cell.
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

/// The boxes are visited in the order that they had last time, which is nearly that of their cells: counts and
/// copies are written almost in sequence, and the one random access, to the boxes by id, is fetched ahead.
void key(Keying* keying) {
  constexpr int kMostLevels = 17;
  Keying& k = *keying;
  Simd::Quad largest[kMostLevels], lower = Simd::quadOf(k.lower), upper = Simd::quadOf(k.upper);
  for (int level = 0; level < k.levels; ++level) largest[level] = Simd::quadOf(k.sizes + 4 * level);
  for (std::size_t i = k.begin; i < k.end; ++i) {
    const Box& box = fetched(k, i);
    if (k.copies != nullptr) k.copies[i] = box;
    const Simd::Quad min = Simd::minimaOf(box), size = Simd::minus(Simd::maximaOf(box), min);
    lower = Simd::least(lower, min);
    upper = Simd::greatest(upper, min);
    int level = 0;
    if (k.levels > 1) {
      const float side = Simd::greatestOfThree(size);
      while (level + 1 < k.levels && side > k.sides[level]) ++level;
    }
    largest[level] = Simd::greatest(largest[level], size);
    countIn(k, i, static_cast<std::uint32_t>(level), min);
  }
  for (int level = 0; level < k.levels; ++level) Simd::store(largest[level], k.sizes + 4 * level);
  Simd::store(lower, k.lower);
  Simd::store(upper, k.upper);
}

inline bool isIn(const Region& region, const float* corner) {
  bool in = true;
  for (int axis = 0; axis < 3; ++axis) {
    in = in & (corner[axis] >= region.low[axis]) & (corner[axis] < region.high[axis]);
  }
  return in;
}

/// In the order of the last sort, a box is nearly always in the region of the box before.
void keyRegions(Keying* keying) {
  Keying& k = *keying;
  const Region* region = k.regions;
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
    float* const sizes = k.sizes + 4 * static_cast<std::size_t>(level);
    float* const corners = k.corners + 8 * static_cast<std::size_t>(level);
    Simd::store(Simd::greatest(Simd::quadOf(sizes), size), sizes);
    Simd::store(Simd::least(Simd::quadOf(corners), min), corners);
    Simd::store(Simd::greatest(Simd::quadOf(corners + 4), min), corners + 4);
    countIn(k, i, level, min);
  }
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
