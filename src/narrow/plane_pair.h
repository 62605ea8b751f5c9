// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "narrow/ordered_solid.h"

namespace hgrid {

/// The half-space z <= 0 as a solid.
class PlaneSolid final : public OrderedSolid {
 public:
  PlaneSolid() : OrderedSolid(Shape::plane()) {}
};

// The functions below measure a plane and another solid, in the frame of the plane. The deepest point of the other
// solid decides, so the penetration depth and the normal of a contact are always known. Two planes count as in contact,
// because two half-spaces meet unless they are exactly parallel; their depth is not known.

Proximity measurePlane(const Side& plane, const Side& other, double up_to);
/// Returns the contact of a plane and a solid that are in contact. Nothing is known about the contact of two planes.
Contact contactOfPlane(const Side& plane, const Side& other);
/// A convex solid has at most one contact with a plane. A mesh has one for each triangle that meets the plane.
std::vector<Contact> contactsOfPlane(const Side& plane, const Side& other, std::size_t most);

}  // namespace hgrid
