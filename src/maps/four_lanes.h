// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>

#ifdef __SSE2__
#include <emmintrin.h>
#endif
#ifdef __aarch64__
#include <arm_neon.h>
#endif

namespace hgrid {

/// A number for each of the four slices of a brick. Vectors of gcc and clang: SSE2 or NEON where there is, else plain
/// code with the same results.
using Four = float __attribute__((vector_size(16)));
using FourCounts = std::uint32_t __attribute__((vector_size(16)));

inline Four allFour(float value) { return Four{value, value, value, value}; }

// `b` if one of them is not a number. Written a < b ? a : b, compilers make branches or five instructions of it.
#ifdef __SSE2__
inline Four least(Four a, Four b) { return _mm_min_ps(a, b); }
inline Four greatest(Four a, Four b) { return _mm_max_ps(a, b); }
#else
inline Four least(Four a, Four b) { return a < b ? a : b; }
inline Four greatest(Four a, Four b) { return a > b ? a : b; }
#endif

/// Rounded towards zero, first brought within 0 .. 4.
inline FourCounts countsOf(Four values) {
#ifdef __aarch64__  // NaN stays NaN up to the last step, which makes 0 of it
  return reinterpret_cast<FourCounts>(vcvtq_u32_f32(vminq_f32(vmaxq_f32(values, allFour(0.0f)), allFour(4.0f))));
#else
  using FourInts = std::int32_t __attribute__((vector_size(16)));  // floats become these in one instruction
  const Four within = least(greatest(values, allFour(0.0f)), allFour(4.0f));
  return reinterpret_cast<FourCounts>(__builtin_convertvector(within, FourInts));
#endif
}

}  // namespace hgrid
