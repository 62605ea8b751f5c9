// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "narrow/ordered_solid.h"

namespace hgrid {

/// Measures a mesh and another solid, in the frame of the mesh. It sets no depth for a contact, since another part of
/// the mesh may prevent the move that would separate the two.
Proximity measureMesh(const Side& mesh, const Side& other, double up_to);
/// Returns the contact of a mesh and a solid that are in contact, in the frame of the mesh. Depth and normal are known
/// only if the cores are apart and a move along the nearest points is verified to separate the two.
Contact contactOfMesh(const Side& mesh, const Side& other);
/// Returns at most `most` contacts of a mesh with another solid, in the frame of the mesh.
std::vector<Contact> contactsOfMesh(const Side& mesh, const Side& other, std::size_t most);

}  // namespace hgrid
