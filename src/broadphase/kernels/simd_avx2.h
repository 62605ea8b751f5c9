// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <immintrin.h>

#include "broadphase/kernels/simd_sse2.h"

namespace hgrid {
namespace kernels {
namespace {

/// A table: for each of the 256 subsets of the 8 SIMD lanes, the indices of its lanes in ascending order. Each index
/// has four bits.
struct PackedLanes {
  std::uint32_t of[256];
  constexpr PackedLanes() : of() {
    for (std::uint32_t bits = 0; bits < 256; ++bits) {
      std::uint32_t packed = 0, shift = 0;
      for (std::uint32_t lane = 0; lane < 8; ++lane) {
        if ((bits >> lane & 1u) != 0) packed |= lane << shift, shift += 4;
      }
      of[bits] = packed;
    }
  }
};
constexpr PackedLanes kPackedLanes;

/// The vector operations for AVX2; simd_portable.h explains them.
struct SimdAvx2 : SimdSse2 {
  static constexpr std::uint32_t kWidth = 8;

  struct Box {
    __m256 min[3], max[3];
  };
  using Id = __m256i;

  static Box boxOf(const kernels::Box& box) { return boxOf(box.min, box.max); }
  static Box boxOf(const float* min, const float* max) {
    return {{_mm256_set1_ps(min[0]), _mm256_set1_ps(min[1]), _mm256_set1_ps(min[2])},
            {_mm256_set1_ps(max[0]), _mm256_set1_ps(max[1]), _mm256_set1_ps(max[2])}};
  }
  static Box boxAt(const Level& level, std::uint32_t i) {
    return {{_mm256_broadcast_ss(level.bounds + i), _mm256_broadcast_ss(level.bounds + level.stride + i),
             _mm256_broadcast_ss(level.bounds + 2 * level.stride + i)},
            {_mm256_broadcast_ss(level.bounds + 3 * level.stride + i),
             _mm256_broadcast_ss(level.bounds + 4 * level.stride + i),
             _mm256_broadcast_ss(level.bounds + 5 * level.stride + i)}};
  }
  static Id idAt(const Level& level, std::uint32_t i) { return _mm256_set1_epi32(static_cast<int>(level.id[i])); }

  using Boxes = Box;
  static Boxes boxesAt(const Columns& boxes, std::uint32_t i) {
    const float *const min = boxes.bounds + i, *const max = min + 3 * boxes.stride;
    return {{_mm256_loadu_ps(min), _mm256_loadu_ps(min + boxes.stride), _mm256_loadu_ps(min + 2 * boxes.stride)},
            {_mm256_loadu_ps(max), _mm256_loadu_ps(max + boxes.stride), _mm256_loadu_ps(max + 2 * boxes.stride)}};
  }

  static std::uint32_t overlaps(const Box& box, const Columns& boxes, std::uint32_t j, std::uint32_t count) {
    const __m256 x =
        _mm256_and_ps(_mm256_cmp_ps(_mm256_loadu_ps(boxes.bounds + j), box.max[0], _CMP_LE_OQ),
                      _mm256_cmp_ps(_mm256_loadu_ps(boxes.bounds + 3 * boxes.stride + j), box.min[0], _CMP_GE_OQ));
    const __m256 y =
        _mm256_and_ps(_mm256_cmp_ps(_mm256_loadu_ps(boxes.bounds + boxes.stride + j), box.max[1], _CMP_LE_OQ),
                      _mm256_cmp_ps(_mm256_loadu_ps(boxes.bounds + 4 * boxes.stride + j), box.min[1], _CMP_GE_OQ));
    const __m256 z =
        _mm256_and_ps(_mm256_cmp_ps(_mm256_loadu_ps(boxes.bounds + 2 * boxes.stride + j), box.max[2], _CMP_LE_OQ),
                      _mm256_cmp_ps(_mm256_loadu_ps(boxes.bounds + 5 * boxes.stride + j), box.min[2], _CMP_GE_OQ));
    const auto bits = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_and_ps(_mm256_and_ps(x, y), z)));
    return bits & (0xffu >> (count < kWidth ? kWidth - count : 0u));
  }

  static Pair* storePairs(Pair* to, Id id, const std::uint32_t* ids, std::uint32_t bits) {
    return storeFirst(to, id, packed(ids, bits), __builtin_popcount(bits));
  }
  static Pair* storePairsOfEach(Pair* to, const std::uint32_t* a, const std::uint32_t* b, std::uint32_t bits) {
    return storeFirst(to, packed(a, bits), packed(b, bits), __builtin_popcount(bits));
  }
  static std::uint32_t* storePositions(std::uint32_t* to, std::uint32_t j, std::uint32_t bits) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to),
                        _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(j)), lanesIn(bits)));
    return to + __builtin_popcount(bits);
  }

  using Lanes = __m256;
  using SimdSse2::minus;  // the overload for Quad
  using SimdSse2::plus;   // the overload for Two
  using SimdSse2::times;  // the overload for Two
  static Lanes lanesOf(float value) { return _mm256_set1_ps(value); }
  static Lanes lanesAt(const float* from) { return _mm256_loadu_ps(from); }
  static Lanes plus(Lanes a, Lanes b) { return _mm256_add_ps(a, b); }
  static Lanes minus(Lanes a, Lanes b) { return _mm256_sub_ps(a, b); }
  static Lanes times(Lanes a, Lanes b) { return _mm256_mul_ps(a, b); }
  static Lanes timesPlus(Lanes a, Lanes b, Lanes c) { return _mm256_fmadd_ps(a, b, c); }
  static Lanes timesMinus(Lanes a, Lanes b, Lanes c) { return _mm256_fmsub_ps(a, b, c); }
  static Lanes size(Lanes a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
  using Mask = __m256;
  static Mask notGreater(Lanes a, Lanes b) { return _mm256_cmp_ps(a, b, _CMP_NGT_UQ); }
  static Mask both(Mask a, Mask b) { return _mm256_and_ps(a, b); }
  static std::uint32_t bitsOf(Mask mask, std::uint32_t count) {
    return static_cast<std::uint32_t>(_mm256_movemask_ps(mask)) & ((1u << (count < kWidth ? count : kWidth)) - 1u);
  }

  static std::uint32_t atLeast(const std::int32_t* values, std::int32_t bound) {
    const __m256i below = _mm256_set1_epi32(bound - 1);
    const auto* from = reinterpret_cast<const __m256i*>(values);
    const __m256i low = _mm256_cmpgt_epi32(_mm256_loadu_si256(from), below);
    const __m256i high = _mm256_cmpgt_epi32(_mm256_loadu_si256(from + 1), below);
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(low))) |
           static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(high))) << 8;
  }

 private:
  /// Writes the pairs of lanes 0 .. count - 1 of a and b, with the smaller id first. Returns the end of the pairs.
  static Pair* storeFirst(Pair* to, __m256i a, __m256i b, int count) {
    const __m256i first = _mm256_min_epu32(a, b), second = _mm256_max_epu32(a, b);
    const __m256i low = _mm256_unpacklo_epi32(first, second), high = _mm256_unpackhi_epi32(first, second);
    auto* wide = reinterpret_cast<__m256i*>(to);
    _mm256_storeu_si256(wide, _mm256_permute2x128_si256(low, high, 0x20));
    if (__builtin_expect(count > 4, 0)) _mm256_storeu_si256(wide + 1, _mm256_permute2x128_si256(low, high, 0x31));
    return to + count;
  }
  /// Returns the indices of the bits that are 1 in `bits`, in ascending order, then zeros.
  static __m256i lanesIn(std::uint32_t bits) {
    const __m256i packed = _mm256_set1_epi32(static_cast<int>(kPackedLanes.of[bits]));
    const __m256i shifted = _mm256_srlv_epi32(packed, _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28));
    return _mm256_and_si256(shifted, _mm256_set1_epi32(7));
  }
  /// Returns the ids[k] for which bit k of `bits` is 1, moved to the front.
  static __m256i packed(const std::uint32_t* ids, std::uint32_t bits) {
    return _mm256_permutevar8x32_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(ids)), lanesIn(bits));
  }
};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
