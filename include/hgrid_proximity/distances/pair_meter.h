// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// An occupied cell of a map that is near to a body.
struct NearCell {
  Eigen::Vector3d center;  ///< [m, world]
  double edge = 0.0;       ///< [m]
  double distance = 0.0;   ///< [m] from the body
};

/// So many of a map's cells are told of in a pair, the nearest.
inline constexpr std::size_t kNearCells = 4;

/// The exact distance of a candidate pair of bodies: that of their nearest shapes; a map's are its occupied cells.
struct PairDistance {
  std::uint32_t first = 0, second = 0;              ///< indices into Structure::bodies, first < second
  std::uint32_t first_shape = 0, second_shape = 0;  ///< the nearest ones, in the order of each body's shapes
  double gap = 0.0;                                 ///< [m] distance of their boxes
  std::uint8_t flags = 0;                           ///< as NearPair::flags
  Proximity proximity;
  /// [m] The pair is not nearer than this: its distance if it was measured, otherwise the larger of `gap` and the last
  /// measured distance less what both bodies can have moved since.
  double lower_bound = 0.0;
  Time measured{0};             ///< time of the data of the last measurement of this pair; 0: there was none
  std::vector<NearCell> cells;  ///< pairs with a map: its nearest cells, nearest first
  double closing_speed = Proximity::kUnknown;      ///< [m/s] estimate from past ticks; > 0: they come closer
  double time_to_contact = Proximity::kUnknown;    ///< [s] estimate; infinite if they do not come closer
  double no_contact_before = Proximity::kUnknown;  ///< [s] bound by max_speed, from the stamp on
};

/// Exact distances of one snapshot. Immutable.
struct PairDistances {
  std::vector<PairDistance> pairs;  ///< contacts first, then by distance, not measured ones by gap; then by names
  std::size_t measured = 0;         ///< pairs whose distance was asked for or known
  std::size_t failed = 0;           ///< pairs of those that the solver failed on: listed, to be taken as contact
  std::size_t left_out = 0;         ///< pairs that are candidates, but no time was left to measure them
};

/// Measures one pair of bodies of a snapshot, near or not; without estimates from the past. Both must have poses.
/// @param up_to  [m] beyond this distance it is infinite
PairDistance measurePair(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                         std::uint32_t second, double up_to);

/// A place where two bodies are in contact.
struct PairContact {
  std::uint32_t first_shape = 0, second_shape = 0;  ///< in the order of each body's shapes
  Contact contact;
};

/// Places where two bodies of a snapshot are in contact, deepest first. Both must have poses. A pair that measurePair()
/// calls FAILED may have none.
/// @param most  the search ends with so many, whichever they are
std::vector<PairContact> contactsOf(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                    std::uint32_t second, std::size_t most);

/// What a PairMeter can be told.
struct MeterOptions {
  double report_distance = 0.1;  ///< [m] pairs that are farther apart are left out
  double budget = 0.0;           ///< [s] per snapshot; 0: as long as it takes
  int threads = 1;               ///< 1 .. 64
};

/// Measures the candidates of one snapshot after the other, nearest boxes first, and remembers of each pair what makes
/// the next time cheaper. One thread at a time.
class PairMeter {
 public:
  PairMeter(std::shared_ptr<const NarrowPhase> narrow_phase, const MeterOptions& options);
  ~PairMeter();

  /// An exception on any thread reaches the caller after all threads have stopped. The meter then knows what it knew
  /// before, and can be used again.
  std::shared_ptr<const PairDistances> measure(const Snapshot& snapshot);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hgrid
