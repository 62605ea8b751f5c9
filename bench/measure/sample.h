// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "bench/workload/random.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// Time and result of one measured step, for example of a frame or of a pass over all queries.
struct Sample {
  double ms = 0.0;             ///< [ms] duration of the step
  double bytes = 0.0;          ///< bytes that the peer held; 0: not measured
  std::uint64_t count = 0;     ///< number of pairs or hits
  std::uint64_t checksum = 0;  ///< of the pairs, or of the hits of all judged queries; their order does not matter
  std::uint64_t number = 0;    ///< frame number; results with equal numbers are results for the same boxes
  std::uint64_t timed = 0;     ///< 0: warm-up, the time does not count
};

/// A checksum of a set of numbers. Their order does not matter; a number that is added twice changes the checksum.
class Checksum {
 public:
  void add(std::uint64_t number) { sum_ += mixed(number + 0x9e3779b97f4a7c15ull); }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

inline std::uint64_t checksumOf(const std::vector<ProxyPair>& pairs) {
  Checksum sum;
  for (const ProxyPair& pair : pairs) sum.add(std::uint64_t{pair.first} << 32 | pair.second);
  return sum.value();
}

}  // namespace bench
}  // namespace hgrid
