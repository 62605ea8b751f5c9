// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "broadphase/kernels/simd_avx2.h"

namespace hgrid {
namespace kernels {
namespace {

/// The vector operations for AVX-512; simd_portable.h explains them.
struct SimdAvx512 : SimdSse2 {
  static constexpr std::uint32_t kWidth = 16;

  struct Box {
    __m512 min[3], max[3];
  };
  using Id = __m512i;

  static Box boxOf(const kernels::Box& box) { return boxOf(box.min, box.max); }
  static Box boxOf(const float* min, const float* max) {
    return {{_mm512_set1_ps(min[0]), _mm512_set1_ps(min[1]), _mm512_set1_ps(min[2])},
            {_mm512_set1_ps(max[0]), _mm512_set1_ps(max[1]), _mm512_set1_ps(max[2])}};
  }
  static Box boxAt(const Level& level, std::uint32_t i) {
    return boxOf(
        {{level.bounds[i], level.bounds[level.stride + i], level.bounds[2 * level.stride + i]},
         {level.bounds[3 * level.stride + i], level.bounds[4 * level.stride + i], level.bounds[5 * level.stride + i]}});
  }
  static Id idAt(const Level& level, std::uint32_t i) { return _mm512_set1_epi32(static_cast<int>(level.id[i])); }

  using Boxes = Box;
  static Boxes boxesAt(const Columns& boxes, std::uint32_t i) {
    const float *const min = boxes.bounds + i, *const max = min + 3 * boxes.stride;
    return {{_mm512_loadu_ps(min), _mm512_loadu_ps(min + boxes.stride), _mm512_loadu_ps(min + 2 * boxes.stride)},
            {_mm512_loadu_ps(max), _mm512_loadu_ps(max + boxes.stride), _mm512_loadu_ps(max + 2 * boxes.stride)}};
  }

  static std::uint32_t overlaps(const Box& box, const Columns& boxes, std::uint32_t j, std::uint32_t count) {
    // Three independent chains of comparisons are faster than one chain: each comparison takes several cycles.
    __mmask16 x = static_cast<__mmask16>(0xffffu >> (count < kWidth ? kWidth - count : 0u));
    x = _mm512_mask_cmp_ps_mask(x, _mm512_loadu_ps(boxes.bounds + j), box.max[0], _CMP_LE_OQ);
    __mmask16 y = _mm512_cmp_ps_mask(_mm512_loadu_ps(boxes.bounds + boxes.stride + j), box.max[1], _CMP_LE_OQ);
    __mmask16 z = _mm512_cmp_ps_mask(_mm512_loadu_ps(boxes.bounds + 2 * boxes.stride + j), box.max[2], _CMP_LE_OQ);
    x = _mm512_mask_cmp_ps_mask(x, _mm512_loadu_ps(boxes.bounds + 3 * boxes.stride + j), box.min[0], _CMP_GE_OQ);
    y = _mm512_mask_cmp_ps_mask(y, _mm512_loadu_ps(boxes.bounds + 4 * boxes.stride + j), box.min[1], _CMP_GE_OQ);
    z = _mm512_mask_cmp_ps_mask(z, _mm512_loadu_ps(boxes.bounds + 5 * boxes.stride + j), box.min[2], _CMP_GE_OQ);
    return static_cast<std::uint32_t>(x & y & z);
  }

  static Pair* storePairs(Pair* to, Id id, const std::uint32_t* ids, std::uint32_t bits) {
    return storeFirst(to, id, packed(ids, bits), __builtin_popcount(bits));
  }
  static Pair* storePairsOfEach(Pair* to, const std::uint32_t* a, const std::uint32_t* b, std::uint32_t bits) {
    return storeFirst(to, packed(a, bits), packed(b, bits), __builtin_popcount(bits));
  }
  static std::uint32_t* storePositions(std::uint32_t* to, std::uint32_t j, std::uint32_t bits) {
    const __m512i lanes = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m512i positions = _mm512_add_epi32(_mm512_set1_epi32(static_cast<int>(j)), lanes);
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), positions));
    return to + __builtin_popcount(bits);
  }

  using Lanes = __m512;
  using SimdSse2::minus;  // the overload for Quad
  using SimdSse2::plus;   // the overload for Two
  using SimdSse2::times;  // the overload for Two
  static Lanes lanesOf(float value) { return _mm512_set1_ps(value); }
  static Lanes lanesAt(const float* from) { return _mm512_loadu_ps(from); }
  static Lanes plus(Lanes a, Lanes b) { return _mm512_add_ps(a, b); }
  static Lanes minus(Lanes a, Lanes b) { return _mm512_sub_ps(a, b); }
  static Lanes times(Lanes a, Lanes b) { return _mm512_mul_ps(a, b); }
  static Lanes timesPlus(Lanes a, Lanes b, Lanes c) { return _mm512_fmadd_ps(a, b, c); }
  static Lanes timesMinus(Lanes a, Lanes b, Lanes c) { return _mm512_fmsub_ps(a, b, c); }
  static Lanes size(Lanes a) { return _mm512_abs_ps(a); }
  using Mask = __mmask16;
  static Mask notGreater(Lanes a, Lanes b) { return _mm512_cmp_ps_mask(a, b, _CMP_NGT_UQ); }
  static Mask both(Mask a, Mask b) { return _kand_mask16(a, b); }
  static std::uint32_t bitsOf(Mask mask, std::uint32_t count) {
    return _cvtmask16_u32(mask) & ((1u << (count < kWidth ? count : kWidth)) - 1u);
  }

  static std::uint32_t atLeast(const std::int32_t* values, std::int32_t bound) {
    return _mm512_cmpge_epi32_mask(_mm512_loadu_si512(values), _mm512_set1_epi32(bound));
  }

 private:
  /// Writes the pairs of lanes 0 .. count - 1 of a and b, with the smaller id first. Returns the end of the pairs.
  static Pair* storeFirst(Pair* to, __m512i a, __m512i b, int count) {
    const __m512i first = _mm512_min_epu32(a, b), second = _mm512_max_epu32(a, b);
    _mm512_storeu_si512(
        to, _mm512_permutex2var_epi32(first, _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23),
                                      second));
    if (__builtin_expect(count > 8, 0)) {
      _mm512_storeu_si512(
          to + 8, _mm512_permutex2var_epi32(
                      first, _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31), second));
    }
    return to + count;
  }
  /// Returns the ids[k] for which bit k of `bits` is 1, moved to the front. Compresses in a register, because
  /// compressing directly to memory is slow on some processors.
  static __m512i packed(const std::uint32_t* ids, std::uint32_t bits) {
    return _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), _mm512_loadu_si512(ids));
  }
};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
