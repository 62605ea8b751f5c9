// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "hgrid_proximity/geometry/shape.h"
#include "hgrid_proximity/geometry/sphere.h"
#include "hgrid_proximity/narrow/narrow_phase.h"

namespace hgrid {

class Enclosure;
class MeshTree;

/// Largest number of spheres of one shape.
constexpr std::size_t kMostInnerSpheres = 24;

/// Returns some spheres that lie inside a shape, in the frame of the shape [m]. If a sphere of one shape and a sphere
/// of another shape meet, the shapes are in contact, and there is no need to measure them. A mesh that is
/// not Enclosure::simple() has no certain inside; the spheres are then points of its surface, with radius 0. Returns
/// nothing for a plane or a hull, and for a mesh that another narrow phase has prepared.
///
/// The spheres of a mesh are found when they are asked for first. This takes a few milliseconds for a small mesh.
std::vector<Sphere> innerSpheresOf(const Shape& shape, const Solid& solid);

/// Finds spheres inside a mesh, or points of a mesh that is not Enclosure::simple(). @param low, high  [m] box around
/// the mesh
std::vector<Sphere> innerSpheresOf(const MeshTree& tree, const Enclosure& enclosure, const Eigen::Vector3d& low,
                                   const Eigen::Vector3d& high);

}  // namespace hgrid
