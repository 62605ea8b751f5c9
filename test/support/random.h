// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace hgrid {
namespace test {

/// Generates random numbers that are the same with every compiler and library (SplitMix64, Steele et al. 2014).
/// Therefore a seed in a failure message creates the same test data everywhere. The distributions of the standard
/// library return different numbers in different libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 0x1234567u) {}

  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Returns a uniformly distributed number in [low, high).
  double uniform(double low, double high) { return low + (high - low) * std::ldexp(double(bits() >> 11), -53); }
  /// Returns a random integer in 0 .. count - 1.
  int below(int count) { return int(bits() % std::uint64_t(count)); }
  /// Returns a random integer in low .. high, both included.
  int between(int low, int high) { return low + below(high - low + 1); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  /// Returns a number in [low, high) whose logarithm is uniformly distributed. Useful for sizes.
  double logUniform(double low, double high) { return low * std::exp(uniform(0, std::log(high / low))); }

 private:
  std::uint64_t state_;
};

/// Returns the float that is `steps` units in the last place above `value`, or below it if `steps` is negative.
inline float stepped(float value, int steps) {
  const float towards = steps < 0 ? -std::numeric_limits<float>::infinity() : std::numeric_limits<float>::infinity();
  for (int i = std::abs(steps); i > 0; --i) value = std::nextafter(value, towards);
  return value;
}
inline double stepped(double value, int steps) {
  const double towards = steps < 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  for (int i = std::abs(steps); i > 0; --i) value = std::nextafter(value, towards);
  return value;
}

/// Returns the count in an environment variable, which makes a test shorter or longer; `otherwise` if it is not set.
inline int countFromEnvironment(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text ? std::atoi(text) : otherwise;
}

}  // namespace test
}  // namespace hgrid
