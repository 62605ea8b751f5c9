// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <emmintrin.h>

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

/// The vector operations for SSE2; simd_portable.h explains them. SimdAvx2 and SimdAvx512 replace some of these
/// operations and inherit the others.
struct SimdSse2 {
  static constexpr std::uint32_t kWidth = 4;

  struct Box {
    __m128 min[3], max[3];
  };
  using Id = std::uint32_t;

  static Box boxOf(const kernels::Box& box) { return boxOf(box.min, box.max); }
  static Box boxOf(const float* min, const float* max) {
    return {{_mm_set1_ps(min[0]), _mm_set1_ps(min[1]), _mm_set1_ps(min[2])},
            {_mm_set1_ps(max[0]), _mm_set1_ps(max[1]), _mm_set1_ps(max[2])}};
  }
  static Box boxAt(const Level& level, std::uint32_t i) {
    return boxOf(
        {{level.bounds[i], level.bounds[level.stride + i], level.bounds[2 * level.stride + i]},
         {level.bounds[3 * level.stride + i], level.bounds[4 * level.stride + i], level.bounds[5 * level.stride + i]}});
  }
  static Id idAt(const Level& level, std::uint32_t i) { return level.id[i]; }

  using Boxes = Box;
  static Boxes boxesAt(const Columns& boxes, std::uint32_t i) {
    const float *const min = boxes.bounds + i, *const max = min + 3 * boxes.stride;
    return {{_mm_loadu_ps(min), _mm_loadu_ps(min + boxes.stride), _mm_loadu_ps(min + 2 * boxes.stride)},
            {_mm_loadu_ps(max), _mm_loadu_ps(max + boxes.stride), _mm_loadu_ps(max + 2 * boxes.stride)}};
  }

  static std::uint32_t overlaps(const Box& box, const Columns& boxes, std::uint32_t j, std::uint32_t count) {
    __m128 meet = _mm_cmple_ps(_mm_loadu_ps(boxes.bounds + j), box.max[0]);
    meet = _mm_and_ps(meet, _mm_cmpge_ps(_mm_loadu_ps(boxes.bounds + 3 * boxes.stride + j), box.min[0]));
    meet = _mm_and_ps(meet, _mm_cmple_ps(_mm_loadu_ps(boxes.bounds + boxes.stride + j), box.max[1]));
    meet = _mm_and_ps(meet, _mm_cmpge_ps(_mm_loadu_ps(boxes.bounds + 4 * boxes.stride + j), box.min[1]));
    meet = _mm_and_ps(meet, _mm_cmple_ps(_mm_loadu_ps(boxes.bounds + 2 * boxes.stride + j), box.max[2]));
    meet = _mm_and_ps(meet, _mm_cmpge_ps(_mm_loadu_ps(boxes.bounds + 5 * boxes.stride + j), box.min[2]));
    const std::uint32_t bits = static_cast<std::uint32_t>(_mm_movemask_ps(meet));
    return count < kWidth ? bits & ((1u << count) - 1u) : bits;
  }

  static Pair* storePairs(Pair* to, Id id, const std::uint32_t* ids, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) {
      const std::uint32_t other = ids[lowestBit(bits)];
      *to++ = id < other ? Pair{id, other} : Pair{other, id};
    }
    return to;
  }
  static Pair* storePairsOfEach(Pair* to, const std::uint32_t* a, const std::uint32_t* b, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) {
      const int k = lowestBit(bits);
      *to++ = a[k] < b[k] ? Pair{a[k], b[k]} : Pair{b[k], a[k]};
    }
    return to;
  }
  static std::uint32_t* storePositions(std::uint32_t* to, std::uint32_t j, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) *to++ = j + static_cast<std::uint32_t>(lowestBit(bits));
    return to;
  }

  static int lowestBit(std::uint32_t bits) { return __builtin_ctz(bits); }

  static std::uint32_t atLeast(const std::int32_t* values, std::int32_t bound) {
    const __m128i below = _mm_set1_epi32(bound - 1);
    __m128i four[4];
    for (int i = 0; i < 4; ++i) {
      four[i] = _mm_cmpgt_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(values) + i), below);
    }
    return static_cast<std::uint32_t>(
        _mm_movemask_epi8(_mm_packs_epi16(_mm_packs_epi32(four[0], four[1]), _mm_packs_epi32(four[2], four[3]))));
  }

  using Lanes = __m128;
  static Lanes lanesOf(float value) { return _mm_set1_ps(value); }
  static Lanes lanesAt(const float* from) { return _mm_loadu_ps(from); }
  static Lanes plus(Lanes a, Lanes b) { return _mm_add_ps(a, b); }
  static Lanes minus(Lanes a, Lanes b) { return _mm_sub_ps(a, b); }
  static Lanes times(Lanes a, Lanes b) { return _mm_mul_ps(a, b); }
  static Lanes timesPlus(Lanes a, Lanes b, Lanes c) { return plus(times(a, b), c); }
  static Lanes timesMinus(Lanes a, Lanes b, Lanes c) { return minus(times(a, b), c); }
  static Lanes size(Lanes a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
  using Mask = __m128;
  static Mask notGreater(Lanes a, Lanes b) { return _mm_cmpngt_ps(a, b); }
  static Mask both(Mask a, Mask b) { return _mm_and_ps(a, b); }
  static std::uint32_t bitsOf(Mask mask, std::uint32_t count) {
    return static_cast<std::uint32_t>(_mm_movemask_ps(mask)) & ((1u << (count < kWidth ? count : kWidth)) - 1u);
  }

  using Two = __m128d;
  static Two twoOf(double first, double second) { return _mm_setr_pd(first, second); }
  static Two plus(Two a, Two b) { return _mm_add_pd(a, b); }
  static Two times(Two a, Two b) { return _mm_mul_pd(a, b); }
  static Two least(Two a, Two b) { return _mm_min_pd(a, b); }
  static Two greatest(Two a, Two b) { return _mm_max_pd(a, b); }
  static void store(Two two, std::int32_t* to) {
    _mm_storel_epi64(reinterpret_cast<__m128i*>(to), _mm_cvttpd_epi32(two));
  }

  static bool isSound(const kernels::Box& box) {
    const __m128 min = minimaOf(box), max = maximaOf(box);
    const __m128 sound = _mm_and_ps(_mm_cmple_ps(min, max), _mm_and_ps(_mm_cmpge_ps(min, _mm_set1_ps(-kMostFloat)),
                                                                       _mm_cmple_ps(max, _mm_set1_ps(kMostFloat))));
    return (_mm_movemask_ps(sound) & 7) == 7;
  }

  using Quad = __m128;  // the same type as Lanes, so one minus() serves both
  static Quad quadOf(const float* from) { return _mm_loadu_ps(from); }
  static void store(Quad quad, float* to) { _mm_storeu_ps(to, quad); }
  static Quad minimaOf(const kernels::Box& box) { return _mm_loadu_ps(box.min); }
  static Quad maximaOf(const kernels::Box& box) {
    const __m128 last = _mm_loadu_ps(box.min + 2);  // min z, max x y z
    return _mm_shuffle_ps(last, last, _MM_SHUFFLE(0, 3, 2, 1));
  }
  static Quad least(Quad a, Quad b) { return _mm_min_ps(a, b); }
  static Quad greatest(Quad a, Quad b) { return _mm_max_ps(a, b); }
  static float greatestOfThree(Quad a) {
    const __m128 y = _mm_shuffle_ps(a, a, _MM_SHUFFLE(1, 1, 1, 1)), z = _mm_shuffle_ps(a, a, _MM_SHUFFLE(2, 2, 2, 2));
    return _mm_cvtss_f32(_mm_max_ss(_mm_max_ss(a, y), z));
  }
  static std::uint32_t longAxes(Quad a, float ratio) {
    const __m128 most = _mm_set1_ps(greatestOfThree(a));
    return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_cmpge_ps(_mm_mul_ps(a, _mm_set1_ps(ratio)), most))) & 7u;
  }
  static void cellsOf(Quad quad, const Grid& grid, std::int32_t* cell) {
    // A load of four floats also reads the next member of Grid. Only three of the results are used.
    __m128 number = _mm_sub_ps(_mm_mul_ps(quad, _mm_loadu_ps(grid.inverse)), _mm_loadu_ps(grid.origin));
    number = _mm_min_ps(_mm_max_ps(number, _mm_setzero_ps()), _mm_loadu_ps(grid.last));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(cell), _mm_cvttps_epi32(number));
  }
};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
