// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

/// Describes the contact of two solids that were measured. All values are NaN if they are apart or if that failed.
inline Contact measuredContact(const NarrowPhase& narrow_phase, const PlacedSolid& first, const PlacedSolid& second,
                               Measure status) {
  return isContact(status) && status != Measure::failed ? narrow_phase.measureContact(first, second) : Contact{};
}

constexpr double kProvedLength = 1e-9;  ///< [m]
constexpr double kProvedDepth = 1e-6;

/// Completes the result for two convex solids that overlap: sets depth, normal and points, if the bounds of the depth
/// prove it to kProvedDepth of itself or to kProvedLength. Changes no other result.
inline void describeOverlap(const NarrowPhase& narrow_phase, const PlacedSolid& first, const PlacedSolid& second,
                            Proximity& found) {
  if (found.status != Measure::contact || !std::isnan(found.depth)) return;
  const Contact contact = narrow_phase.measureContact(first, second);
  if (!(contact.depth - contact.depth_at_least <= kProvedLength + kProvedDepth * contact.depth)) return;
  found.depth = contact.depth;
  found.normal = contact.normal;
  found.on_first = found.on_second = contact.point;
}

}  // namespace hgrid
