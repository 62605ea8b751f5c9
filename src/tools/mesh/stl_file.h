// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "tools/mesh/faces.h"

namespace hgrid {

/// Reads a binary or text STL file.
/// @throws Refusal truncated  if a text file ends before `endsolid`
/// @throws Refusal parse  if it is neither binary nor text, has a zero byte in its text, or a facet without 3 vertices
Faces readStl(const std::string& data);

}  // namespace hgrid
