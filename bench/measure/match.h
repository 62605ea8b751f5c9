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
  double bytes = 0.0;                     ///< [byte] greatest memory that the peer held
  std::size_t timed = 0;                  ///< number of timed samples
  std::size_t compared = 0;               ///< number of results that could be compared with a reference
  std::uint64_t count = 0, checksum = 0;  ///< of the result with the lowest sample number
  bool correct = false;                   ///< whether results were compared and all of them equal the reference
};

/// Returns the remark of a table on a contestant: why it gave no more results, that its results could not be compared,
/// or that they are wrong. Returns an empty text if there is nothing to say. The text is valid as long as `status`.
/// @param status  of the contestant
const char* remarkOn(const Score& score, const std::string& status);

/// Runs contestants in turn, block by block, and compares their results. Because they take turns, other programs on the
/// machine slow down all of them alike.
class Match {
 public:
  /// Adds a contestant.
  /// @param votes    whether its results help to decide which result is correct; false for the program under test
  /// @param decides  whether its results are correct by definition, for example those of brute force
  void add(std::unique_ptr<Contestant> contestant, bool votes, bool decides);

  /// Sets the correct count and checksum of all results with the sample number `number`.
  void decide(std::uint64_t number, std::uint64_t count, std::uint64_t checksum) {
    decided_[number] = {count, checksum};
  }

  /// Runs `rounds` blocks of each contestant. A contestant that needs more than `limit_s` [s] for a block is ended.
  void play(int rounds, double budget_ms, double limit_s);

  /// Returns the scores in the order of add(). A result is correct if it equals the reference. The reference is the
  /// first of these that exists:
  /// - the result that decide() has set
  /// - the result of a contestant that decides
  /// - the result with the most votes, if it has at least two votes and no other result has as many
  std::vector<Score> scores() const;

  const Contestant& contestant(std::size_t i) const { return *entries_[i].contestant; }

 private:
  struct Entry {
    std::unique_ptr<Contestant> contestant;
    bool votes, decides;
  };

  std::vector<Entry> entries_;
  std::map<std::uint64_t, std::pair<std::uint64_t, std::uint64_t>> decided_;  // count and checksum by result number
};

}  // namespace bench
}  // namespace hgrid
