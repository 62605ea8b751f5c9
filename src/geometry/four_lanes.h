// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>
#include <cstdint>

#ifdef __SSE2__
#include <emmintrin.h>
#endif
#ifdef __aarch64__
#include <arm_neon.h>
#endif

namespace hgrid {

/// A vector of four numbers. It uses the vector extension of gcc and clang. These compilers use SSE2 or NEON if
/// available; if not, they generate plain code with the same results.
using Four = float __attribute__((vector_size(16)));
using FourCounts = std::uint32_t __attribute__((vector_size(16)));

/// Returns a vector of four equal values.
inline Four allFour(float value) { return Four{value, value, value, value}; }

// least() and greatest() return for each lane the smaller or greater value, or the value of `b` if one of the two is
// NaN. They use intrinsics, because compilers turn a < b ? a : b into branches or five instructions.
#ifdef __SSE2__
inline Four least(Four a, Four b) { return _mm_min_ps(a, b); }
inline Four greatest(Four a, Four b) { return _mm_max_ps(a, b); }
#else
inline Four least(Four a, Four b) { return a < b ? a : b; }
inline Four greatest(Four a, Four b) { return a > b ? a : b; }
#endif

/// Returns a mask: bit i is set if lane i is true. `lanes` must be the result of a comparison: each lane is 0 or all
/// ones.
inline unsigned bitsOf(const FourCounts& lanes) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(lanes)));
#else
  return (lanes[0] & 1u) | (lanes[1] & 2u) | (lanes[2] & 4u) | (lanes[3] & 8u);
#endif
}

/// Returns the square root of each value.
inline Four squareRoot(Four values) {
#if defined(__SSE2__)
  return _mm_sqrt_ps(values);
#elif defined(__aarch64__)
  return vsqrtq_f32(values);
#else
  return Four{std::sqrt(values[0]), std::sqrt(values[1]), std::sqrt(values[2]), std::sqrt(values[3])};
#endif
}

/// Limits each value to 0 .. 4 and then rounds it toward zero.
inline FourCounts countsOf(Four values) {
#ifdef __aarch64__  // NaN stays NaN until the conversion, which turns it into 0
  return reinterpret_cast<FourCounts>(vcvtq_u32_f32(vminq_f32(vmaxq_f32(values, allFour(0.0f)), allFour(4.0f))));
#else
  using FourInts = std::int32_t __attribute__((vector_size(16)));  // one instruction converts floats to this type
  const Four within = least(greatest(values, allFour(0.0f)), allFour(4.0f));
  return reinterpret_cast<FourCounts>(__builtin_convertvector(within, FourInts));
#endif
}

}  // namespace hgrid
