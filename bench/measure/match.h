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

/// Times and results of one contestant, computed from its samples.
struct Score {
  double median_ms = 0.0;                 ///< median over the blocks of each block's median
  double min_ms = 0.0;                    ///< shortest of all timed samples
  double spread = 0.0;                    ///< (largest - smallest median of a block) / median_ms
  double bytes = 0.0;                     ///< most bytes that the peer held
  std::size_t timed = 0;                  ///< number of timed samples
  std::size_t compared = 0;               ///< number of results that could be compared with a reference
  std::uint64_t count = 0, checksum = 0;  ///< count and checksum of the result with the lowest number
  bool correct = false;                   ///< all compared results equal the reference, and there is at least one
};

/// Runs contestants in turn, block by block, and compares their results. Since they take turns, other load on the
/// machine slows down all of them alike.
class Match {
 public:
  /// Adds a contestant.
  /// @param votes    its results help to decide which result is correct; false for the program under test
  /// @param decides  its results are correct by definition, for example those of brute force
  void add(std::unique_ptr<Contestant> contestant, bool votes, bool decides);

  /// Sets the correct count and checksum of results with this number.
  void decide(std::uint64_t number, std::uint64_t count, std::uint64_t checksum) {
    decided_[number] = {count, checksum};
  }

  /// Runs `rounds` blocks of each contestant. If a contestant needs more than `limit_s` [s], it does not run again.
  void play(int rounds, double budget_ms, double limit_s);

  /// Returns the scores in the order of add(). A result is correct if it equals the one that decide() has set. Without
  /// that, the reference is the result of a contestant that decides. Without such a contestant, it is the result with
  /// the most votes, if it has at least two and no other result has as many.
  std::vector<Score> scores() const;

  const Contestant& contestant(std::size_t i) const { return *entries_[i].contestant; }

 private:
  struct Entry {
    std::unique_ptr<Contestant> contestant;
    bool votes, decides;
  };

  std::vector<Entry> entries_;
  std::map<std::uint64_t, std::pair<std::uint64_t, std::uint64_t>> decided_;  // result number -> count and checksum
};

}  // namespace bench
}  // namespace hgrid
