// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// An occupied cell of a map or cloud that is near a body.
struct NearCell {
  Eigen::Vector3d center;  ///< [m, world] center of the cell
  double edge = 0.0;       ///< [m] edge of the cell
  double distance = 0.0;   ///< [m] distance of the cell from the body
};

/// Maximum number of cells that PairDistance::cells lists.
inline constexpr std::size_t kNearCells = 4;

/// Whether two bodies come closer. The numbers are part of the interface: do not change them.
enum class Approach : std::uint8_t {
  unknown = 0,      ///< not measured in this tick and the tick before, or a pose is not FRESH
  approaching = 1,  ///< they come closer
  apart = 2,        ///< they do not come closer
  contact = 3,      ///< they touch
};

/// The exact distance of a pair of bodies: the distance of their nearest shapes. The shapes of a map are its occupied
/// cells.
struct PairDistance {
  std::uint32_t first = 0;         ///< index into Structure::bodies, first < second
  std::uint32_t second = 0;        ///< index into Structure::bodies
  std::uint32_t first_shape = 0;   ///< index of the nearest shape among the shapes of the first body
  std::uint32_t second_shape = 0;  ///< index of the nearest shape among the shapes of the second body
  double gap = 0.0;                ///< [m] distance of the boxes of the two bodies
  std::uint8_t flags = 0;          ///< bits of PairFlags
  Proximity proximity;             ///< how the nearest shapes lie relative to each other
  Contact contact;                 ///< of these two shapes, or of this shape and cell; all NaN if they are apart
  /// [m] Lower bound of the distance of the pair at the stamp of the snapshot. At the poses, it is the
  /// proved lower bound of the distance if that was measured for this tick; if not, the larger of two values: `gap`,
  /// and the last measured distance minus how far the two bodies have moved relative to each other since that
  /// measurement. If poses are old, Snapshot::reachBetween() is subtracted.
  double lower_bound = 0.0;
  Time measured{0};                       ///< stamp of the data of the last measurement of this pair; 0: never measured
  std::vector<NearCell> cells;            ///< only in pairs with a map or cloud: its nearest cells, nearest first
  Approach approach = Approach::unknown;  ///< what the next two values mean
  double closing_speed = Proximity::kUnknown;      ///< [m/s] estimate from past ticks; > 0: the bodies come closer
  double time_to_contact = Proximity::kUnknown;    ///< [s] estimate; infinite if the bodies do not come closer
  double no_contact_before = Proximity::kUnknown;  ///< [s] NoContact::before; NoContact::assumed is kAssumedFlag
};

/// Measures one pair of bodies of a snapshot, even if the bodies are far apart. Both bodies must have poses. The result
/// has no gap, no lower bound and no estimates.
/// @param up_to  [m] a larger distance is returned as infinite
PairDistance measurePair(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                         std::uint32_t second, double up_to);

/// One contact of two bodies.
struct PairContact {
  std::uint32_t first_shape = 0;   ///< index of the touching shape among the shapes of the first body
  std::uint32_t second_shape = 0;  ///< index of the touching shape among the shapes of the second body
  Contact contact;                 ///< point, normal and depth of the contact
};

/// Finds the contacts of two bodies of a snapshot, deepest first. Both bodies must have poses.
/// @param most  the search ends after this many contacts, even if others are deeper
/// @throws std::exception if the solver failed for one of their shapes
std::vector<PairContact> contactsOf(const NarrowPhase& narrow_phase, const Snapshot& snapshot, std::uint32_t first,
                                    std::uint32_t second, std::size_t most);

}  // namespace hgrid
