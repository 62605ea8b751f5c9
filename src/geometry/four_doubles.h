// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace hgrid {

/// Vectors of two numbers, with the vector extension of gcc and clang. SSE2 and NEON have registers of this size.
using TwoDoubles = double __attribute__((vector_size(16)));
using TwoIntegers = std::uint64_t __attribute__((vector_size(16)));

/// Four numbers in double precision, for formulas that are computed for four things at once. Each lane gets the same
/// result as a plain formula, on every processor.
struct FourDoubles {
  TwoDoubles low, high;  // lanes 0, 1 and lanes 2, 3

  double operator[](std::size_t lane) const { return lane < 2 ? low[lane] : high[lane - 2]; }
  // Not `(lane < 2 ? low : high)[lane % 2] = value`: with -fsanitize=undefined, GCC 12 sets the wrong lane.
  void set(std::size_t lane, double value) {
    if (lane < 2) {
      low[lane] = value;
    } else {
      high[lane - 2] = value;
    }
  }
};

/// Returns four equal numbers.
inline FourDoubles fourDoubles(double value) { return {TwoDoubles{value, value}, TwoDoubles{value, value}}; }

inline FourDoubles operator+(const FourDoubles& a, const FourDoubles& b) { return {a.low + b.low, a.high + b.high}; }
inline FourDoubles operator-(const FourDoubles& a, const FourDoubles& b) { return {a.low - b.low, a.high - b.high}; }
inline FourDoubles operator*(const FourDoubles& a, const FourDoubles& b) { return {a.low * b.low, a.high * b.high}; }
inline FourDoubles operator*(const FourDoubles& a, double b) { return a * fourDoubles(b); }

}  // namespace hgrid
