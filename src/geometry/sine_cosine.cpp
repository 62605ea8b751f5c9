// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "geometry/sine_cosine.h"

#include <initializer_list>

namespace hgrid {
namespace {

TwoDoubles two(double value) { return TwoDoubles{value, value}; }

/// Returns lanes of `a` where `choice` has only ones, and lanes of `b` where it has only zeros.
TwoDoubles chosen(const TwoIntegers& choice, const TwoDoubles& a, const TwoDoubles& b) {
  return reinterpret_cast<TwoDoubles>((choice & reinterpret_cast<TwoIntegers>(a)) |
                                      (~choice & reinterpret_cast<TwoIntegers>(b)));
}

struct Two {
  TwoDoubles sine, cosine;
};

Two sineCosineOf(const TwoDoubles& angle) {
  // The parts of pi / 2. Each of the first three has 25 bits, so that its product with `quarters` is exact.
  constexpr double kPart1 = 0x1.921fb5p+0, kPart2 = 0x1.110b46p-26, kPart3 = 0x1.1a6263p-54,
                   kPart4 = 0x1.8a2e03707344ap-81, kQuartersPerRadian = 0.63661977236758134308;
  // Adding this number rounds to an integer, which is then in the lowest bits of the sum.
  constexpr double kRound = 0x1.8p+52;
  const TwoDoubles sum = angle * two(kQuartersPerRadian) + two(kRound), quarters = sum - two(kRound);
  const TwoDoubles x =
      ((angle - quarters * two(kPart1)) - quarters * two(kPart2)) - quarters * two(kPart3) - quarters * two(kPart4);
  // Now x is within -pi/4 .. pi/4, apart from rounding. The next terms of both series are less than 1e-17.
  const TwoDoubles square = x * x;
  TwoDoubles s = two(1.0 / 355687428096000), c = two(1.0 / 20922789888000);
  for (const double term :
       {-1.0 / 1307674368000, 1.0 / 6227020800, -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6}) {
    s = s * square + two(term);
  }
  for (const double term :
       {-1.0 / 87178291200, 1.0 / 479001600, -1.0 / 3628800, 1.0 / 40320, -1.0 / 720, 1.0 / 24, -1.0 / 2}) {
    c = c * square + two(term);
  }
  const TwoDoubles sine = x + x * square * s, cosine = two(1.0) + square * c;
  // Each quarter turn exchanges the two and changes one sign.
  const TwoIntegers number = reinterpret_cast<TwoIntegers>(sum), one{1, 1}, sign_shift{62, 62};
  const TwoIntegers odd = TwoIntegers{0, 0} - (number & one);
  const TwoIntegers sine_sign = (number & TwoIntegers{2, 2}) << sign_shift,
                    cosine_sign = ((number + one) & TwoIntegers{2, 2}) << sign_shift;
  return {reinterpret_cast<TwoDoubles>(reinterpret_cast<TwoIntegers>(chosen(odd, cosine, sine)) ^ sine_sign),
          reinterpret_cast<TwoDoubles>(reinterpret_cast<TwoIntegers>(chosen(odd, sine, cosine)) ^ cosine_sign)};
}

}  // namespace

SineCosine sineCosine(const FourDoubles& angles) {
  const Two low = sineCosineOf(angles.low), high = sineCosineOf(angles.high);
  return {{low.sine, high.sine}, {low.cosine, high.cosine}};
}

}  // namespace hgrid
