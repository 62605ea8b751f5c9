// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "bench/workload/random.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// Time and result of one measured step, for example of one frame or of one pass over all queries.
struct Sample {
  double ms = 0.0;             ///< [ms] duration of the step
  double bytes = 0.0;          ///< memory that the peer held; 0: not measured
  std::uint64_t count = 0;     ///< number of pairs or hits
  std::uint64_t checksum = 0;  ///< checksum of the pairs, or of the hits of all judged queries, in any order
  std::uint64_t number = 0;    ///< number of the frame; samples with the same number have the same boxes
  std::uint64_t timed = 0;     ///< whether the time counts; 0 for a warm-up step
};

/// A checksum of a set of numbers. It does not depend on their order. Adding a number twice changes the checksum.
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
