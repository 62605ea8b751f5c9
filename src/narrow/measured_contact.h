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

}  // namespace hgrid
