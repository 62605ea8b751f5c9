// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "bench/workload/random.h"
#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// One thing that was timed: a frame, or a pass over all queries.
struct Sample {
  double ms = 0.0;
  double bytes = 0.0;          ///< held by the peer then; 0: not asked
  std::uint64_t count = 0;     ///< pairs, or hits
  std::uint64_t checksum = 0;  ///< of the set of pairs, or of the hits of all judged queries; whatever their order
  std::uint64_t number = 0;    ///< of the frame; results of the same number are of the same boxes
  std::uint64_t timed = 0;     ///< 0: to warm up only, the time does not count
};

/// The same for equal sets of numbers, in any order; one that is there twice changes it.
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
