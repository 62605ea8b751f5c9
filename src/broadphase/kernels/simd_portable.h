// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "broadphase/kernels/kernels.h"

namespace hgrid {
namespace kernels {
namespace {

/// The vector operations of the kernels, in plain C++. Each other simd_ file has the same operations for one
/// instruction set. The comments in this file explain the operations for all instruction sets.
struct SimdPortable {
  static constexpr std::uint32_t kWidth = 8;  ///< number of boxes that overlaps() tests at once

  using Box = kernels::Box;
  using Id = std::uint32_t;

  static Box boxOf(const kernels::Box& box) { return box; }
  static Box boxOf(const float* min, const float* max) { return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}}; }
  static Box boxAt(const Level& level, std::uint32_t i) {
    return {
        {level.bounds[i], level.bounds[level.stride + i], level.bounds[2 * level.stride + i]},
        {level.bounds[3 * level.stride + i], level.bounds[4 * level.stride + i], level.bounds[5 * level.stride + i]}};
  }
  static Id idAt(const Level& level, std::uint32_t i) { return level.id[i]; }

  /// kWidth boxes, one in each lane.
  struct Boxes {
    float min[3][kWidth], max[3][kWidth];
  };
  /// Returns kWidth boxes, from position i on.
  static Boxes boxesAt(const Columns& boxes, std::uint32_t i) {
    Boxes lanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::uint32_t k = 0; k < kWidth; ++k) {
        lanes.min[axis][k] = boxes.bounds[axis * boxes.stride + i + k];
        lanes.max[axis][k] = boxes.bounds[(axis + 3) * boxes.stride + i + k];
      }
    }
    return lanes;
  }

  /// Tests `box` against the boxes at the positions from j on. Bit k of the result is 1 if `box` overlaps the box at
  /// position j + k. Bit k is 0 for k >= count and for k >= kWidth.
  static std::uint32_t overlaps(const Box& box, const Columns& boxes, std::uint32_t j, std::uint32_t count) {
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < kWidth; ++k) {
      bool meet = k < count;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        meet = meet & (boxes.bounds[axis * boxes.stride + j + k] <= box.max[axis]) &
               (boxes.bounds[(axis + 3) * boxes.stride + j + k] >= box.min[axis]);
      }
      bits |= static_cast<std::uint32_t>(meet) << k;
    }
    return bits;
  }

  /// Tests the box of each lane against another box. Bit k of the result is 1 if the box in lane k overlaps the box at
  /// position j + k. Bit k is 0 for k >= count and for k >= kWidth.
  static std::uint32_t overlaps(const Boxes& lanes, const Columns& boxes, std::uint32_t j, std::uint32_t count) {
    std::uint32_t bits = 0;
    for (std::uint32_t k = 0; k < kWidth; ++k) {
      bool meet = k < count;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        meet = meet & (boxes.bounds[axis * boxes.stride + j + k] <= lanes.max[axis][k]) &
               (boxes.bounds[(axis + 3) * boxes.stride + j + k] >= lanes.min[axis][k]);
      }
      bits |= static_cast<std::uint32_t>(meet) << k;
    }
    return bits;
  }

  /// Writes the pair of `id` and ids[k] for each bit k that is set, with the smaller id first. Returns the end of the
  /// pairs. May overwrite up to 16 pairs from `to` on.
  static Pair* storePairs(Pair* to, Id id, const std::uint32_t* ids, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) {
      const std::uint32_t other = ids[lowestBit(bits)];
      *to++ = id < other ? Pair{id, other} : Pair{other, id};
    }
    return to;
  }
  /// Writes the pair of a[k] and b[k] for each bit k that is set, like storePairs().
  static Pair* storePairsOfEach(Pair* to, const std::uint32_t* a, const std::uint32_t* b, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) {
      const int k = lowestBit(bits);
      *to++ = a[k] < b[k] ? Pair{a[k], b[k]} : Pair{b[k], a[k]};
    }
    return to;
  }
  /// Writes the position j + k for each bit k that is set. Returns the end of the positions. May overwrite up to 16
  /// values from `to` on.
  static std::uint32_t* storePositions(std::uint32_t* to, std::uint32_t j, std::uint32_t bits) {
    for (; bits != 0; bits &= bits - 1) *to++ = j + static_cast<std::uint32_t>(lowestBit(bits));
    return to;
  }

  /// Returns the index of the lowest bit that is set; `bits` must not be 0.
  static int lowestBit(std::uint32_t bits) { return __builtin_ctz(bits); }

  /// Compares 16 values with a bound. Bit k of the result is 1 if values[k] >= bound.
  static std::uint32_t atLeast(const std::int32_t* values, std::int32_t bound) {
    std::uint32_t bits = 0;
    for (int k = 0; k < 16; ++k) bits |= static_cast<std::uint32_t>(values[k] >= bound) << k;
    return bits;
  }

  /// A vector of kWidth floats. Each float is in one lane.
  struct Lanes {
    float v[kWidth];
  };
  template <class Operation>
  static Lanes each(const Lanes& a, const Lanes& b, Operation operation) {
    Lanes lanes;
    for (std::uint32_t k = 0; k < kWidth; ++k) lanes.v[k] = operation(a.v[k], b.v[k]);
    return lanes;
  }
  static Lanes lanesOf(float value) {
    Lanes lanes;
    for (float& lane : lanes.v) lane = value;
    return lanes;
  }
  static Lanes lanesAt(const float* from) {
    Lanes lanes;
    for (std::uint32_t k = 0; k < kWidth; ++k) lanes.v[k] = from[k];
    return lanes;
  }
  static Lanes plus(const Lanes& a, const Lanes& b) {
    return each(a, b, [](float x, float y) { return x + y; });
  }
  static Lanes minus(const Lanes& a, const Lanes& b) {
    return each(a, b, [](float x, float y) { return x - y; });
  }
  static Lanes times(const Lanes& a, const Lanes& b) {
    return each(a, b, [](float x, float y) { return x * y; });
  }
  /// Returns a * b + c. The instruction set decides whether the result is rounded once or twice.
  static Lanes timesPlus(const Lanes& a, const Lanes& b, const Lanes& c) { return plus(times(a, b), c); }
  /// Returns a * b - c. The instruction set decides whether the result is rounded once or twice.
  static Lanes timesMinus(const Lanes& a, const Lanes& b, const Lanes& c) { return minus(times(a, b), c); }
  /// Returns the absolute value of each lane.
  static Lanes size(const Lanes& a) {
    return each(a, a, [](float x, float) { return x < 0.0f ? -x : x; });
  }
  /// A truth value for each lane.
  using Mask = std::uint32_t;
  /// Returns !(a > b) for each lane. It is true where a or b is NaN.
  static Mask notGreater(const Lanes& a, const Lanes& b) {
    Mask mask = 0;
    for (std::uint32_t k = 0; k < kWidth; ++k) mask |= static_cast<std::uint32_t>(!(a.v[k] > b.v[k])) << k;
    return mask;
  }
  static Mask both(Mask a, Mask b) { return a & b; }
  /// Converts a mask to bits. Bit k is the value of lane k. Bit k is 0 for k >= count and for k >= kWidth.
  static std::uint32_t bitsOf(Mask mask, std::uint32_t count) {
    return mask & ((1u << (count < kWidth ? count : kWidth)) - 1u);
  }

  /// A vector of two doubles.
  struct Two {
    double v[2];
  };
  static Two twoOf(double first, double second) { return {{first, second}}; }
  static Two plus(const Two& a, const Two& b) { return {{a.v[0] + b.v[0], a.v[1] + b.v[1]}}; }
  static Two times(const Two& a, const Two& b) { return {{a.v[0] * b.v[0], a.v[1] * b.v[1]}}; }
  /// Returns the smaller value of a and b, or b if one of them is NaN.
  static Two least(const Two& a, const Two& b) {
    return {{a.v[0] < b.v[0] ? a.v[0] : b.v[0], a.v[1] < b.v[1] ? a.v[1] : b.v[1]}};
  }
  /// Returns the larger value of a and b, or b if one of them is NaN.
  static Two greatest(const Two& a, const Two& b) {
    return {{a.v[0] > b.v[0] ? a.v[0] : b.v[0], a.v[1] > b.v[1] ? a.v[1] : b.v[1]}};
  }
  /// Stores both numbers, rounded toward zero.
  static void store(const Two& two, std::int32_t* to) {
    to[0] = static_cast<std::int32_t>(two.v[0]);
    to[1] = static_cast<std::int32_t>(two.v[1]);
  }

  /// Returns whether the box is finite and min <= max holds on each axis.
  static bool isSound(const kernels::Box& box) {
    bool sound = true;
    for (int i = 0; i < 3; ++i) {
      sound = sound & (box.min[i] <= box.max[i]) & (box.min[i] >= -kMostFloat) & (box.max[i] <= kMostFloat);
    }
    return sound;
  }

  /// A vector of three coordinates. Its fourth value is unspecified.
  struct Quad {
    float v[4];
  };
  static Quad quadOf(const float* from) { return {{from[0], from[1], from[2], from[3]}}; }
  static void store(const Quad& quad, float* to) {
    for (int i = 0; i < 4; ++i) to[i] = quad.v[i];
  }
  static Quad minimaOf(const kernels::Box& box) { return {{box.min[0], box.min[1], box.min[2], 0.0f}}; }
  static Quad maximaOf(const kernels::Box& box) { return {{box.max[0], box.max[1], box.max[2], 0.0f}}; }
  static Quad minus(const Quad& a, const Quad& b) {
    return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], 0.0f}};
  }
  static Quad least(const Quad& a, const Quad& b) {
    Quad quad;
    for (int i = 0; i < 4; ++i) quad.v[i] = a.v[i] < b.v[i] ? a.v[i] : b.v[i];
    return quad;
  }
  static Quad greatest(const Quad& a, const Quad& b) {
    Quad quad;
    for (int i = 0; i < 4; ++i) quad.v[i] = a.v[i] > b.v[i] ? a.v[i] : b.v[i];
    return quad;
  }
  /// Returns the largest of the three coordinates.
  static float greatestOfThree(const Quad& a) {
    const float xy = a.v[0] > a.v[1] ? a.v[0] : a.v[1];
    return xy > a.v[2] ? xy : a.v[2];
  }
  /// Returns a number whose bit i is set if coordinate i is at least 1 / ratio of the largest of the three coordinates.
  static std::uint32_t longAxes(const Quad& a, float ratio) {
    const float most = greatestOfThree(a);
    std::uint32_t bits = 0;
    for (int i = 0; i < 3; ++i) bits |= (a.v[i] * ratio >= most ? 1u : 0u) << i;
    return bits;
  }
  /// Computes for each coordinate the index of the cell along its axis. `cell` needs room for four values.
  static void cellsOf(const Quad& quad, const Grid& grid, std::int32_t* cell) {
    for (int i = 0; i < 3; ++i) {
      float number = quad.v[i] * grid.inverse[i] - grid.origin[i];
      number = number > 0.0f ? number : 0.0f;
      number = number < grid.last[i] ? number : grid.last[i];
      cell[i] = static_cast<std::int32_t>(number);
    }
  }
};

}  // namespace
}  // namespace kernels
}  // namespace hgrid
