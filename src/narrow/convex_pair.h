// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <vector>

#include "narrow/convex_solid.h"

namespace hgrid {

constexpr double kTouchingGap = 1e-9;  ///< [m] a list of contacts includes parts that are at most this far apart

/// [m] To verify a depth, the solids are moved apart by the depth plus this length. Then they must be apart.
constexpr double kHair = 1e-6;

/// The overlap of two convex cores, in the frame of the first core.
struct Overlap {
  double depth = 0.0;  ///< [m] penetration depth of the cores, without the radius around them
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), point = Eigen::Vector3d::Zero();
};

/// Proposes an overlap of two cores that meet, or nullopt. The proposal may be wrong, so the caller checks it.
using FindOverlap = std::optional<Overlap> (*)(const ConvexSolid& a, const ConvexSolid& b, const Pose& a_from_b);

/// A FindOverlap that never proposes an overlap.
inline std::optional<Overlap> noOverlap(const ConvexSolid&, const ConvexSolid&, const Pose&) { return std::nullopt; }

/// Measures two convex solids in the frame of the first.
/// @param findOverlap  called first if the cores meet
Proximity measureConvex(const Side& a, const Side& b, double up_to, FindOverlap findOverlap);
/// Returns the contact of two convex solids that are in contact, in the frame of the first. Depth and normal are known
/// if the cores are apart, if they only touch, or if `findOverlap` finds them.
Contact contactOfConvex(const Side& a, const Side& b, FindOverlap findOverlap);
/// Returns the contacts of two convex solids in the frame of the first. There is at most one.
std::vector<Contact> contactsOfConvex(const Side& a, const Side& b, std::size_t most, FindOverlap findOverlap);

// The following steps are the same for convex solids and meshes.

/// Returns a result that has only a status and a distance [m].
Proximity answerOf(Measure status, double distance);
/// Whether two solids with this status have contacts. @throws std::runtime_error if the measurement failed
bool hasContacts(Measure status);
/// Returns a result if it is known without measuring the cores: the poses are not finite, or the solids are too far
/// apart.
std::optional<Proximity> answerByReach(const Side& a, const Side& b, const Pose& a_from_b, double up_to);
/// Returns the result for two cores whose gap is proved to be greater than 0. For a contact, the depth is not set.
Proximity answerByGap(const Side& a, const Side& b, const Pose& a_from_b, const CoreGap& gap, double up_to);
/// Returns the contact of two parts, whose cores are at most as far apart as the sum of the radii around them.
Contact contactByGap(const Side& a, const Side& b, const CoreGap& gap);

}  // namespace hgrid
