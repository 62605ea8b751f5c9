// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <vector>

#include "narrow/convex_solid.h"

namespace hgrid {

constexpr double kTouchingGap = 1e-9;  ///< [m] a list of contacts includes parts that are at most this far apart

/// Measures two convex solids in the frame of the first.
Proximity measureConvex(const Side& a, const Side& b, double up_to);
/// Returns the contact of two convex solids that are in contact, in the frame of the first.
Contact contactOfConvex(const Side& a, const Side& b);
/// Returns the contacts of two convex solids in the frame of the first. There is at most one.
std::vector<Contact> contactsOfConvex(const Side& a, const Side& b, std::size_t most);

// The following steps are the same for convex solids and meshes.

/// Returns the pose of the second solid in the frame of the first. Where both are far from the origin, this is more
/// precise than a product of poses.
Pose relativePose(const Side& a, const Side& b);
/// Returns a result that has only a status and a distance [m], which is also the lower bound.
Proximity answerOf(Measure status, double distance);
/// Whether two solids with this status have contacts. @throws std::runtime_error if the measurement failed
bool hasContacts(Measure status);
/// Returns a result if it is known without measuring the cores: the poses are not finite, or the solids are too far
/// apart.
std::optional<Proximity> answerByReach(const Side& a, const Side& b, const Pose& a_from_b, double up_to);
/// Returns the limits of a search for a gap that decides whether two solids are in contact, and finds the distance if
/// it is at most `up_to` [m].
GapLimits limitsOf(const Side& a, const Side& b, double up_to);
/// Returns the result for two cores whose gap is proved to be greater than 0. For a contact, the depth is not set.
Proximity answerByGap(const Side& a, const Side& b, const Pose& a_from_b, const CoreGap& gap, double up_to);
/// Returns the contact of two parts, whose cores are at most as far apart as the sum of the radii around them.
Contact contactByGap(const Side& a, const Side& b, const CoreGap& gap);

}  // namespace hgrid
