// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "hgrid_proximity/distances/pair_distance.h"

namespace hgrid {

/// The exact distances of the pairs of one snapshot. Immutable.
struct PairDistances {
  std::vector<PairDistance> pairs;  ///< measured pairs, sorted by distance, then others by gap; equal pairs by name
  std::size_t measured = 0;         ///< number of pairs whose distance was measured or already known
  std::size_t failed = 0;           ///< number of measured pairs on which the solver failed: treat them as contacts
  std::size_t left_out = 0;         ///< number of pairs that were not measured because the time ran out
  /// For how many successive snapshots, including this one, the pair that waits longest was left out. 0 if no pair was
  /// left out.
  std::uint64_t longest_wait = 0;
};

/// The settings of a PairMeter.
struct MeterOptions {
  /// [m] Pairs that are farther apart are not listed. A pair with a margin of its own (Structure::pair_margins) is
  /// listed up to that margin instead.
  double report_distance = 0.1;
  double budget = 0.0;  ///< [s] time for each snapshot; 0: no limit
  int threads = 1;      ///< number of threads, 1 .. 64
  /// The clock that the budget refers to. Any thread may call it.
  std::function<std::chrono::steady_clock::time_point()> now = std::chrono::steady_clock::now;
};

/// Measures the pairs of successive snapshots. It remembers results of each pair, so that later snapshots take less
/// time. One thread at a time may call its functions.
///
/// A pair needs no measurement if its bodies did not move relative to each other, or if its last distance proves that
/// they are farther apart than the report distance. If the budget does not suffice for all other pairs, half of it goes
/// to the pairs with the smallest lower bounds. The other half goes to the pairs that have waited longest. At least one
/// of the waiting pairs is measured for each snapshot. So each pair is measured again within a bounded number of
/// snapshots. A measurement that has begun is completed, even if the budget ends. It includes the description of a
/// contact (PairDistance::contact), which takes up to three times as long as measuring the same pair while it is apart.
class PairMeter {
 public:
  /// @param narrow_phase  measures the shapes; the solids of the bodies must come from it
  PairMeter(std::shared_ptr<const NarrowPhase> narrow_phase, const MeterOptions& options);
  ~PairMeter();

  /// Sets two of the options, from the next call of measure() on. Keeps the results of earlier calls.
  /// @param report_distance  [m] MeterOptions::report_distance
  /// @param budget           [s] MeterOptions::budget
  void tune(double report_distance, double budget);

  /// Measures the pairs of a snapshot. An exception on any thread reaches the caller after all threads have stopped.
  /// The meter is then in the same state as before the call and can be used again.
  std::shared_ptr<const PairDistances> measure(const Snapshot& snapshot);

  /// Returns how many threads measure. If the system could not create all of them, it is less than
  /// MeterOptions::threads.
  int threads() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hgrid
