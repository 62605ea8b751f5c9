// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// An occupied cell of a map or cloud that is near a body.
struct NearCell {
  Eigen::Vector3d center;  ///< [m, world]
  double edge = 0.0;       ///< [m]
  double distance = 0.0;   ///< [m] distance of the cell from the body
};

/// Maximum number of cells that PairDistance::cells lists.
inline constexpr std::size_t kNearCells = 4;

/// The exact distance of a pair of bodies: the distance of their nearest shapes. The shapes of a map are its occupied
/// cells.
struct PairDistance {
  std::uint32_t first = 0;         ///< index into Structure::bodies, first < second
  std::uint32_t second = 0;        ///< index into Structure::bodies
  std::uint32_t first_shape = 0;   ///< index of the nearest shape among the shapes of the first body
  std::uint32_t second_shape = 0;  ///< index of the nearest shape among the shapes of the second body
  double gap = 0.0;                ///< [m] distance of the boxes of the two bodies
  std::uint8_t flags = 0;          ///< the same as NearPair::flags
  Proximity proximity;             ///< how the nearest shapes lie relative to each other
  /// [m] The distance of the pair is at least this: its distance if it was measured in this tick. Otherwise the larger
  /// of `gap` and the last measured distance minus what both bodies can have moved since.
  double lower_bound = 0.0;
  Time measured{0};             ///< stamp of the data of the last measurement of this pair; 0: never measured
  std::vector<NearCell> cells;  ///< only in pairs with a map or cloud: its nearest cells, nearest first
  double closing_speed = Proximity::kUnknown;      ///< [m/s] estimate from past ticks; > 0: the bodies come closer
  double time_to_contact = Proximity::kUnknown;    ///< [s] estimate; infinite if the bodies do not come closer
  double no_contact_before = Proximity::kUnknown;  ///< [s] as Snapshot::noContactBefore() returns it
};

/// The exact distances of the pairs of one snapshot. Immutable.
struct PairDistances {
  std::vector<PairDistance> pairs;  ///< measured pairs by distance, then the others by gap; equal ones by name
  std::size_t measured = 0;         ///< number of pairs whose distance was measured or already known
  std::size_t failed = 0;           ///< number of measured pairs on which the solver failed: treat them as contacts
  std::size_t left_out = 0;         ///< number of pairs that were not measured because the time ran out
};

/// Measures one pair of bodies of a snapshot, even if the bodies are far apart. Fills in no gap, bounds or estimates.
/// Both bodies must have poses.
/// @param up_to  [m] a larger distance is returned as infinite
PairDistance measurePair(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                         std::uint32_t second, double up_to);

/// One contact of two bodies.
struct PairContact {
  std::uint32_t first_shape = 0;   ///< index of the touching shape among the shapes of the first body
  std::uint32_t second_shape = 0;  ///< index of the touching shape among the shapes of the second body
  Contact contact;                 ///< point, normal and depth of the contact
};

/// Finds the contacts of two bodies of a snapshot, deepest first. Both bodies must have poses. If the status of
/// measurePair() is `failed`, there may be no contacts.
/// @param most  the search ends after this many contacts, even if others are deeper
std::vector<PairContact> contactsOf(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                    std::uint32_t second, std::size_t most);

/// The settings of a PairMeter.
struct MeterOptions {
  double report_distance = 0.1;  ///< [m] pairs that are farther apart are not listed
  double budget = 0.0;           ///< [s] time for each snapshot; 0: no limit
  int threads = 1;               ///< number of threads, 1 .. 64
};

/// Measures the pairs of successive snapshots, those with the smallest gap first. It remembers results of each pair, so
/// that later snapshots take less time. One thread at a time may call its functions.
class PairMeter {
 public:
  /// @param narrow_phase  measures the shapes; the solids of the bodies must come from it
  PairMeter(std::shared_ptr<const NarrowPhase> narrow_phase, const MeterOptions& options);
  ~PairMeter();

  /// Measures the pairs of a snapshot. An exception on any thread reaches the caller after all threads have stopped.
  /// The meter is then in the same state as before the call and can be used again.
  std::shared_ptr<const PairDistances> measure(const Snapshot& snapshot);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hgrid
