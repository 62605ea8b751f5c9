// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hgrid {
namespace test {

/// An exact real number with a finite binary expansion. Each double is such a number. Sums, differences and products of
/// such numbers are computed with schoolbook long arithmetic, without rounding, overflow or any code of the product.
class Exact {
 public:
  Exact(double value = 0.0) {  // NOLINT: implicit, because formulas then read as on paper
    if (value == 0.0) return;
    int exponent = 0;
    const double fraction = std::frexp(std::fabs(value), &exponent);
    const auto mantissa = static_cast<std::uint64_t>(std::ldexp(fraction, 53));
    negative_ = value < 0;
    digits_ = {std::uint32_t(mantissa), std::uint32_t(mantissa >> 32)};
    exponent_ = exponent - 53;
    trim();
  }

  Exact operator-() const {
    Exact result = *this;
    result.negative_ = !negative_ && !digits_.empty();
    return result;
  }
  Exact operator+(const Exact& other) const {
    Exact a = *this, b = other;
    align(a, b);
    if (a.negative_ != b.negative_ && compareMagnitude(a.digits_, b.digits_) < 0) std::swap(a, b);
    const std::int64_t sign = a.negative_ == b.negative_ ? 1 : -1;
    std::int64_t carry = 0;
    a.digits_.resize(std::max(a.digits_.size(), b.digits_.size()) + 1, 0);
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      carry += std::int64_t(a.digits_[i]) + (i < b.digits_.size() ? sign * std::int64_t(b.digits_[i]) : 0);
      a.digits_[i] = std::uint32_t(carry & 0xffffffff);
      carry >>= 32;
    }
    a.trim();
    return a;
  }
  Exact operator-(const Exact& other) const { return *this + (-other); }
  Exact operator*(const Exact& other) const {
    Exact result;
    result.digits_.assign(digits_.size() + other.digits_.size(), 0);
    for (std::size_t i = 0; i < digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < other.digits_.size(); ++j) {
        carry += result.digits_[i + j] + std::uint64_t(digits_[i]) * other.digits_[j];
        result.digits_[i + j] = std::uint32_t(carry);
        carry >>= 32;
      }
      result.digits_[i + other.digits_.size()] = std::uint32_t(carry);
    }
    result.exponent_ = exponent_ + other.exponent_;
    result.negative_ = negative_ != other.negative_;
    result.trim();
    return result;
  }

  int sign() const { return digits_.empty() ? 0 : negative_ ? -1 : 1; }
  bool operator<=(const Exact& other) const { return (*this - other).sign() <= 0; }
  bool operator<(const Exact& other) const { return (*this - other).sign() < 0; }
  bool operator==(const Exact& other) const { return (*this - other).sign() == 0; }

 private:
  using Digits = std::vector<std::uint32_t>;  // base 2^32, least significant digit first

  static int compareMagnitude(const Digits& a, const Digits& b) {
    for (std::size_t i = std::max(a.size(), b.size()); i-- > 0;) {
      const std::uint32_t x = i < a.size() ? a[i] : 0, y = i < b.size() ? b[i] : 0;
      if (x != y) return x < y ? -1 : 1;
    }
    return 0;
  }
  void shiftLeft(int bits) {
    const auto old = digits_;
    const int words = bits / 32, rest = bits % 32;
    digits_.assign(old.size() + std::size_t(words) + 1, 0);
    for (std::size_t i = 0; i < old.size(); ++i) {
      const std::uint64_t wide = std::uint64_t(old[i]) << rest;
      digits_[i + std::size_t(words)] |= std::uint32_t(wide);
      digits_[i + std::size_t(words) + 1] |= std::uint32_t(wide >> 32);
    }
    exponent_ -= bits;
  }
  static void align(Exact& a, Exact& b) {
    if (a.digits_.empty()) a.exponent_ = b.exponent_;
    if (b.digits_.empty()) b.exponent_ = a.exponent_;
    if (a.exponent_ > b.exponent_) a.shiftLeft(a.exponent_ - b.exponent_);
    if (b.exponent_ > a.exponent_) b.shiftLeft(b.exponent_ - a.exponent_);
  }
  void trim() {
    while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
    if (digits_.empty()) negative_ = false;
  }

  Digits digits_;  // empty if the number is zero
  int exponent_ = 0;
  bool negative_ = false;
};

}  // namespace test
}  // namespace hgrid
