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

/// The boxes are visited in the order that they had last time, which is nearly that of their cells: counts and
/// copies are written almost in sequence, and the one random access, to the boxes by id, is fetched ahead.
void key(Keying* keying) {
  constexpr std::size_t kAhead = 32;
  constexpr int kMostLevels = 17;
  Keying& k = *keying;
  Simd::Quad largest[kMostLevels], lower = Simd::quadOf(k.lower), upper = Simd::quadOf(k.upper);
  for (int level = 0; level < k.levels; ++level) largest[level] = Simd::quadOf(k.sizes + 4 * level);
  for (std::size_t i = k.begin; i < k.end; ++i) {
    const char* ahead = reinterpret_cast<const char*>(k.boxes + k.order[i + kAhead < k.readable ? i + kAhead : i]);
    __builtin_prefetch(ahead);
    __builtin_prefetch(ahead + sizeof(Box) - 1);
    const Box& box = k.boxes[k.order[i]];
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
    const Grid& grid = k.grids[level];
    std::int32_t cell[4];
    Simd::cellsOf(min, grid, cell);
    const std::uint32_t number =
        k.first_cells[level] + static_cast<std::uint32_t>(cell[2] * grid.slab + cell[1] * grid.row + cell[0]);
    k.cells[i] = number;
    ++k.counts[number];
  }
  for (int level = 0; level < k.levels; ++level) Simd::store(largest[level], k.sizes + 4 * level);
  Simd::store(lower, k.lower);
  Simd::store(upper, k.upper);
}

}  // namespace
}  // namespace kernels
}  // namespace hgrid
