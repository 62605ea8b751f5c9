// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "tools/mesh/faces.h"

namespace hgrid {

/// Reads the vertices and faces of an OBJ file. Statements that add no surface, such as normals, groups, materials,
/// lines and points, are skipped. All others are refused, because a part of the surface would be missing.
///
/// A file that was cut between two lines cannot be told from a complete one.
/// @throws Refusal truncated  if the file ends within a line
/// @throws Refusal unsupported  if it has another statement, such as `surf`; the sentence names it
/// @throws Refusal parse
Faces readObj(const std::string& data);

}  // namespace hgrid
