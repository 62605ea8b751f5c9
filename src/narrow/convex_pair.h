// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>
#include <vector>

#include "narrow/convex_solid.h"

namespace hgrid {

constexpr double kTouchingGap = 1e-9;  ///< [m] parts this far apart count as in contact when contacts are listed

/// How two convex cores overlap, in the frame of the first.
struct Overlap {
  double depth = 0.0;  ///< [m] of the cores
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), point = Eigen::Vector3d::Zero();
};

/// Finds an overlap of two cores that meet, or nothing. It may be wrong: the caller checks it.
using FindOverlap = std::optional<Overlap> (*)(const ConvexSolid& a, const ConvexSolid& b, const Pose& a_from_b);

/// A solver that knows no overlap.
inline std::optional<Overlap> noOverlap(const ConvexSolid&, const ConvexSolid&, const Pose&) { return std::nullopt; }

/// Measures two convex solids in the frame of the first. @param findOverlap  asked first when the cores meet
Proximity measureConvex(const Side& a, const Side& b, double up_to, FindOverlap findOverlap);
/// The contacts of two convex solids, at most one, in the frame of the first.
std::vector<Contact> contactsOfConvex(const Side& a, const Side& b, std::size_t most, FindOverlap findOverlap);

// Steps that convex solids and meshes have in common.

/// An answer without points. @param distance [m]
Proximity answerOf(Measure status, double distance);
/// The answer before the cores are measured, if there is one: the poses are not finite, or the two are too far apart.
std::optional<Proximity> answerByReach(const Side& a, const Side& b, const Pose& a_from_b, double up_to);
/// The answer for two cores whose gap is proved to be above 0. A contact gets no depth.
Proximity answerByGap(const Side& a, const Side& b, const Pose& a_from_b, const CoreGap& gap, double up_to);
/// The contact of two parts whose cores are no farther apart than what is around them.
Contact contactByGap(const Side& a, const Side& b, const CoreGap& gap);

}  // namespace hgrid
