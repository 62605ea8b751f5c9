// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>

#include "tools/mesh/faces.h"

namespace hgrid {

/// Adds the faces of the scene of a COLLADA file to `triangles`, in meters by its <unit>. As in RViz, <up_axis> does
/// not count. Lines, splines, cameras and lights are skipped, because they add no surface. Whatever else is not read is
/// refused, because a part of the surface would be missing or at a wrong place.
/// @throws Refusal as parseXml() and Triangles::add()
/// @throws Refusal unsupported  if the scene has another element, such as <convex_mesh>; the sentence names it
/// @throws Refusal parse  if the file contradicts itself, such as by a name of nothing or a wrong count
void readDae(const std::string& data, Triangles& triangles);

}  // namespace hgrid
