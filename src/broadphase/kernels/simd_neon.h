// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <arm_neon.h>

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

/// Tables for operations that NEON has no instruction for.
struct NeonTables {
  /// bit_of_lane[count] has the value 1 << lane in each lane below `count`, and 0 in the other lanes.
  alignas(16) std::uint32_t bit_of_lane[5][4];
  /// For each of the 16 subsets of the 4 lanes: the indices of its lanes in ascending order, then zeros.
  alignas(16) std::uint32_t lanes[16][4];
  /// For each of the 16 subsets: the indices of the bytes of its lanes, in ascending order, then the bytes of lane 0.
  alignas(16) std::uint8_t bytes[16][16];
  /// For each of the 16 subsets: how many lanes it has.
  std::uint8_t count[16];

  constexpr NeonTables() : bit_of_lane(), lanes(), bytes(), count() {
    for (std::uint32_t below = 0; below <= 4; ++below) {
      for (std::uint32_t lane = 0; lane < below; ++lane) bit_of_lane[below][lane] = 1u << lane;
    }
    for (std::uint32_t set = 0; set < 16; ++set) {
      for (std::uint32_t lane = 0; lane < 4; ++lane) {
        if ((set >> lane & 1u) != 0) lanes[set][count[set]++] = lane;
      }
      for (std::uint32_t byte = 0; byte < 16; ++byte) {
        bytes[set][byte] = static_cast<std::uint8_t>(4 * lanes[set][byte / 4] + byte % 4);
      }
    }
  }
};
constexpr NeonTables kNeonTables;

/// The vector operations for NEON, which every 64-bit ARM processor supports. simd_portable.h explains them.
///
/// If one operand is NaN, the instructions FMIN and FMAX return NaN, and FMINNM and FMAXNM return the other operand.
/// But least() and greatest() must return the second operand in this case, so they compare and select.
struct SimdNeon {
  /// With 8 boxes, in two registers, pairsWithin(), overlapping() and along() would execute about a tenth more
  /// instructions, because most ranges of positions are short.
  static constexpr std::uint32_t kWidth = 4;

  struct Box {
    float32x4_t min[3], max[3];
  };
  using Id = uint32x4_t;

  static Box boxOf(const kernels::Box& box) { return boxOf(box.min, box.max); }
  static Box boxOf(const float* min, const float* max) {
    return {{vld1q_dup_f32(min), vld1q_dup_f32(min + 1), vld1q_dup_f32(min + 2)},
            {vld1q_dup_f32(max), vld1q_dup_f32(max + 1), vld1q_dup_f32(max + 2)}};
  }
  static Box boxAt(const Level& level, std::uint32_t i) {
    const float *const min = level.bounds + i, *const max = min + 3 * level.stride;
    return {{vld1q_dup_f32(min), vld1q_dup_f32(min + level.stride), vld1q_dup_f32(min + 2 * level.stride)},
            {vld1q_dup_f32(max), vld1q_dup_f32(max + level.stride), vld1q_dup_f32(max + 2 * level.stride)}};
  }
  static Id idAt(const Level& level, std::uint32_t i) { return vld1q_dup_u32(level.id + i); }

  using Boxes = Box;
  static Boxes boxesAt(const Columns& boxes, std::uint32_t i) {
    const float *const min = boxes.bounds + i, *const max = min + 3 * boxes.stride;
    return {{vld1q_f32(min), vld1q_f32(min + boxes.stride), vld1q_f32(min + 2 * boxes.stride)},
            {vld1q_f32(max), vld1q_f32(max + boxes.stride), vld1q_f32(max + 2 * boxes.stride)}};
  }

  static std::uint32_t overlaps(const Box& box, const Columns& boxes, std::uint32_t j, std::uint32_t count) {
    const float *const min = boxes.bounds + j, *const max = min + 3 * boxes.stride;
    const std::size_t y_row = boxes.stride, z_row = 2 * boxes.stride;
    const uint32x4_t x = vandq_u32(vcleq_f32(vld1q_f32(min), box.max[0]), vcgeq_f32(vld1q_f32(max), box.min[0]));
    const uint32x4_t y =
        vandq_u32(vcleq_f32(vld1q_f32(min + y_row), box.max[1]), vcgeq_f32(vld1q_f32(max + y_row), box.min[1]));
    const uint32x4_t z =
        vandq_u32(vcleq_f32(vld1q_f32(min + z_row), box.max[2]), vcgeq_f32(vld1q_f32(max + z_row), box.min[2]));
    return vaddvq_u32(vandq_u32(vandq_u32(vandq_u32(x, y), z), bitsBelow(count)));
  }

  static Pair* storePairs(Pair* to, Id id, const std::uint32_t* ids, std::uint32_t bits) {
    return storeFirst(to, id, packed(ids, bits), kNeonTables.count[bits]);
  }
  static Pair* storePairsOfEach(Pair* to, const std::uint32_t* a, const std::uint32_t* b, std::uint32_t bits) {
    return storeFirst(to, packed(a, bits), packed(b, bits), kNeonTables.count[bits]);
  }
  static std::uint32_t* storePositions(std::uint32_t* to, std::uint32_t j, std::uint32_t bits) {
    vst1q_u32(to, vaddq_u32(vdupq_n_u32(j), vld1q_u32(kNeonTables.lanes[bits])));
    return to + kNeonTables.count[bits];
  }

  static int lowestBit(std::uint32_t bits) { return __builtin_ctz(bits); }

  static std::uint32_t atLeast(const std::int32_t* values, std::int32_t bound) {
    const int32x4_t bounds = vdupq_n_s32(bound);
    const uint16x8_t low = vuzp1q_u16(vreinterpretq_u16_u32(vcgeq_s32(vld1q_s32(values), bounds)),
                                      vreinterpretq_u16_u32(vcgeq_s32(vld1q_s32(values + 4), bounds)));
    const uint16x8_t high = vuzp1q_u16(vreinterpretq_u16_u32(vcgeq_s32(vld1q_s32(values + 8), bounds)),
                                       vreinterpretq_u16_u32(vcgeq_s32(vld1q_s32(values + 12), bounds)));
    constexpr uint16x8_t kBits = {0x1, 0x2, 0x4, 0x8, 0x10, 0x20, 0x40, 0x80};
    return vaddvq_u16(vsliq_n_u16(vandq_u16(low, kBits), vandq_u16(high, kBits), 8));
  }

  using Lanes = float32x4_t;
  static Lanes lanesOf(float value) { return vdupq_n_f32(value); }
  static Lanes lanesAt(const float* from) { return vld1q_f32(from); }
  static Lanes plus(Lanes a, Lanes b) { return vaddq_f32(a, b); }
  static Lanes minus(Lanes a, Lanes b) { return vsubq_f32(a, b); }
  static Lanes times(Lanes a, Lanes b) { return vmulq_f32(a, b); }
  static Lanes timesPlus(Lanes a, Lanes b, Lanes c) { return vfmaq_f32(c, a, b); }
  static Lanes timesMinus(Lanes a, Lanes b, Lanes c) { return vnegq_f32(vfmsq_f32(c, a, b)); }
  static Lanes size(Lanes a) { return vabsq_f32(a); }
  using Mask = uint32x4_t;  // inverted, because NEON has no comparison "not greater": bits with value 1 mean false
  static Mask notGreater(Lanes a, Lanes b) { return vcgtq_f32(a, b); }
  static Mask both(Mask a, Mask b) { return vorrq_u32(a, b); }
  static std::uint32_t bitsOf(Mask mask, std::uint32_t count) { return vaddvq_u32(vbicq_u32(bitsBelow(count), mask)); }

  using Two = float64x2_t;
  static Two twoOf(double first, double second) { return Two{first, second}; }
  static Two plus(Two a, Two b) { return vaddq_f64(a, b); }
  static Two times(Two a, Two b) { return vmulq_f64(a, b); }
  static Two least(Two a, Two b) { return vbslq_f64(vcltq_f64(a, b), a, b); }
  static Two greatest(Two a, Two b) { return vbslq_f64(vcgtq_f64(a, b), a, b); }
  static void store(Two two, std::int32_t* to) { vst1_s32(to, vqmovn_s64(vcvtq_s64_f64(two))); }

  static bool isSound(const kernels::Box& box) {
    const float32x4_t first = vld1q_f32(box.min), last = vld1q_f32(box.min + 2);  // min x y z, max x; min z, max x y z
    const float32x4_t most = vdupq_n_f32(kMostFloat);
    const uint32x4_t finite = vandq_u32(vcaleq_f32(first, most), vcaleq_f32(last, most));
    const float32x4_t least_last = vextq_f32(vnegq_f32(most), first, 3);  // -most, min x y z
    return vminvq_u32(vandq_u32(finite, vcleq_f32(least_last, last))) != 0;
  }

  using Quad = float32x4_t;  // the same type as Lanes, so one minus() serves both
  static Quad quadOf(const float* from) { return vld1q_f32(from); }
  static void store(Quad quad, float* to) { vst1q_f32(to, quad); }
  static Quad minimaOf(const kernels::Box& box) { return vld1q_f32(box.min); }
  static Quad maximaOf(const kernels::Box& box) {
    const float32x4_t last = vld1q_f32(box.min + 2);  // min z, max x y z
    return vextq_f32(last, last, 1);
  }
  static Quad least(Quad a, Quad b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
  static Quad greatest(Quad a, Quad b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
  static float greatestOfThree(Quad a) {
    const Quad y = vdupq_laneq_f32(a, 1), z = vdupq_laneq_f32(a, 2);
    return vgetq_lane_f32(greatest(greatest(a, y), z), 0);  // with plain floats, compilers would generate branches
  }
  static std::uint32_t longAxes(Quad a, float ratio) {
    const uint32x4_t bits = {1u, 2u, 4u, 0u};
    return vaddvq_u32(vandq_u32(vcgeq_f32(vmulq_n_f32(a, ratio), vdupq_n_f32(greatestOfThree(a))), bits));
  }
  static void cellsOf(Quad quad, const Grid& grid, std::int32_t* cell) {
    // A load of four floats also reads the next member of Grid. Only three of the results are used. The last step turns
    // NaN into 0.
    float32x4_t number = vsubq_f32(vmulq_f32(quad, vld1q_f32(grid.inverse)), vld1q_f32(grid.origin));
    number = vminq_f32(vmaxq_f32(number, vdupq_n_f32(0.0f)), vld1q_f32(grid.last));
    vst1q_s32(cell, vcvtq_s32_f32(number));
  }

 private:
  /// Writes the pairs of lanes 0 .. count - 1 of a and b, with the smaller id first. Returns the end of the pairs.
  static Pair* storeFirst(Pair* to, uint32x4_t a, uint32x4_t b, int count) {
    const uint32x4_t first = vminq_u32(a, b), second = vmaxq_u32(a, b);
    vst1q_u32(&to->first, vzip1q_u32(first, second));
    vst1q_u32(&to[2].first, vzip2q_u32(first, second));
    return to + count;
  }
  /// Returns the ids[k] for which bit k of `bits` is 1, moved to the front.
  static uint32x4_t packed(const std::uint32_t* ids, std::uint32_t bits) {
    const uint8x16_t bytes = vreinterpretq_u8_u32(vld1q_u32(ids));
    return vreinterpretq_u32_u8(vqtbl1q_u8(bytes, vld1q_u8(kNeonTables.bytes[bits])));
  }
  /// Returns the value 1 << lane in each lane below `count`, and 0 in the other lanes.
  static uint32x4_t bitsBelow(std::uint32_t count) {
    return vld1q_u32(kNeonTables.bit_of_lane[count < kWidth ? count : kWidth]);
  }
};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
