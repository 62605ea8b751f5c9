// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/measure/contestant.h"

namespace hgrid {
namespace bench {

/// What a contestant's samples say.
struct Score {
  double median_ms = 0.0;  ///< median over the blocks of each block's median
  double min_ms = 0.0;     ///< of all timed samples
  double spread = 0.0;     ///< (largest - smallest median of a block) / median_ms
  double bytes = 0.0;
  std::size_t timed = 0;                  ///< samples that count
  std::size_t compared = 0;               ///< results that a reference was there for
  std::uint64_t count = 0, checksum = 0;  ///< of the lowest-numbered result
  bool correct = false;                   ///< every compared result equals the reference, and there was one
};

/// Contestants that play in turn, block by block, so that what disturbs the machine disturbs all of them alike; and the
/// judgement of their results.
class Match {
 public:
  /// @param votes  whether its results help to decide what is right: not those of the program under test
  /// @param decides  its results are right: brute force
  void add(std::unique_ptr<Contestant> contestant, bool votes, bool decides);

  /// Says what is right for results of this number.
  void decide(std::uint64_t number, std::uint64_t count, std::uint64_t checksum) {
    decided_[number] = {count, checksum};
  }

  /// So many blocks of each; one that does not answer within the limit is out.
  void play(int rounds, double budget_ms, double limit_s);

  /// In the order of add(). A result is right if it equals what was decided, else that of one who decides, else that on
  /// which at least two voters agree, more than on any other.
  std::vector<Score> scores() const;

  const Contestant& contestant(std::size_t i) const { return *entries_[i].contestant; }

 private:
  struct Entry {
    std::unique_ptr<Contestant> contestant;
    bool votes, decides;
  };

  std::vector<Entry> entries_;
  std::map<std::uint64_t, std::pair<std::uint64_t, std::uint64_t>> decided_;  // count and checksum by number
};

}  // namespace bench
}  // namespace hgrid
