// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/distances/pair_distance.h"

namespace hgrid {

/// The points and the normal of a pair, as messages have them [m, world].
struct PairPoints {
  Eigen::Vector3d on_first, on_second, normal;
};

/// Returns the nearest points of a pair that is apart. In contact: its deepest points, or the contact point if these
/// are not known.
inline PairPoints pointsOf(const PairDistance& pair) {
  const Proximity& found = pair.proximity;
  if (!isContact(found.status)) return {found.on_first, found.on_second, found.normal};
  const bool known = found.on_first.allFinite() && found.on_second.allFinite();
  return {known ? found.on_first : pair.contact.point, known ? found.on_second : pair.contact.point,
          pair.contact.normal};
}

}  // namespace hgrid
