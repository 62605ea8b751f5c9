// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace hgrid {

/// A number with about 31 decimal digits: the sum of two doubles, of which the second is the rounding error of the
/// first (Dekker 1971; Hida, Li, Bailey 2001).
///
/// A few operations suffice for the vectors of Eigen. The relative error of each is below 1e-31, unless a value is
/// greater than 1e290 or a result less than 1e-260. The digits are the same on all processors.
struct DoubleDouble {
  double high = 0.0, low = 0.0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : high(value) {}  // NOLINT: doubles are such numbers too
  constexpr DoubleDouble(double greater, double less) : high(greater), low(less) {}
  explicit operator double() const { return high + low; }

  /// Returns the exact sum of two doubles.
  static DoubleDouble sum(double a, double b) {
    const double rounded = a + b, part = rounded - a;
    return {rounded, (a - (rounded - part)) + (b - part)};
  }
  /// Returns the exact product of two doubles.
  static DoubleDouble product(double a, double b) {
    const double rounded = a * b;
    const DoubleDouble of_a = halves(a), of_b = halves(b);
    return {rounded,
            ((of_a.high * of_b.high - rounded) + of_a.high * of_b.low + of_a.low * of_b.high) + of_a.low * of_b.low};
  }

  friend DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }
  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble high = sum(a.high, b.high), low = sum(a.low, b.low);
    const DoubleDouble most = ordered(high.high, high.low + low.high);
    return ordered(most.high, most.low + low.low);
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble most = product(a.high, b.high);
    return ordered(most.high, most.low + (a.high * b.low + a.low * b.high));
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double first = a.high / b.high;
    DoubleDouble rest = a - b * first;
    const double second = rest.high / b.high;
    rest = rest - b * second;
    return ordered(first, second) + rest.high / b.high;
  }
  friend DoubleDouble sqrt(const DoubleDouble& a) {
    if (!(a.high > 0.0)) return 0.0;
    const double root = std::sqrt(a.high);
    return ordered(root, static_cast<double>(a - product(root, root)) / (2.0 * root));
  }

  DoubleDouble& operator+=(const DoubleDouble& b) { return *this = *this + b; }
  DoubleDouble& operator-=(const DoubleDouble& b) { return *this = *this - b; }
  DoubleDouble& operator*=(const DoubleDouble& b) { return *this = *this * b; }
  DoubleDouble& operator/=(const DoubleDouble& b) { return *this = *this / b; }

  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low < b.low);
  }
  friend bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend bool operator<=(const DoubleDouble& a, const DoubleDouble& b) {
    return a.high < b.high || (a.high == b.high && a.low <= b.low);
  }
  friend bool operator>=(const DoubleDouble& a, const DoubleDouble& b) { return b <= a; }
  friend bool operator==(const DoubleDouble& a, const DoubleDouble& b) { return a.high == b.high && a.low == b.low; }
  friend bool operator!=(const DoubleDouble& a, const DoubleDouble& b) { return !(a == b); }

 private:
  /// Returns the exact sum of two doubles, of which the first has the greater absolute value.
  static DoubleDouble ordered(double a, double b) {
    const double rounded = a + b;
    return {rounded, b - (rounded - a)};
  }
  /// Returns two numbers of at most 26 bits whose sum is the given number.
  static DoubleDouble halves(double a) {
    const double shifted = 134217729.0 * a, high = shifted - (shifted - a);
    return {high, a - high};
  }
};

}  // namespace hgrid

namespace Eigen {

template <>
struct NumTraits<hgrid::DoubleDouble> : GenericNumTraits<hgrid::DoubleDouble> {
  using Real = hgrid::DoubleDouble;
  using NonInteger = hgrid::DoubleDouble;
  using Nested = hgrid::DoubleDouble;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 20,
    MulCost = 30,
  };
};

}  // namespace Eigen
