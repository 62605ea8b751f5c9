// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/geometry/aabb.h"
#include "hgrid_proximity/geometry/pose.h"

namespace hgrid {

/// Kinds of collision shape. The numbers are part of the interface: do not change them.
/// 8 stands for the cells of a map in messages, so no shape has it.
enum class ShapeKind : std::uint8_t {
  sphere = 1,
  box = 2,
  cylinder = 3,
  cone = 4,
  capsule = 5,
  hull = 6,
  mesh = 7,
  plane = 9,
};

/// Returns the kind as a word, such as "cylinder".
const char* name(ShapeKind kind);

/// A mesh: vertices [m], and triangles as three vertex indices each, counter-clockwise when seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;                ///< [m] in the frame of the shape
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
};

/// Checks that all vertices are finite and within `max_size` [m], that all indices are in range, and that at least one
/// triangle has an area.
/// @param what  name of the mesh for the error sentence
/// @throws Refusal nonfinite or out_of_range for a vertex
/// @throws Refusal bad_geometry for an index, or if no triangle has an area
void checkMesh(const TriangleMesh& mesh, double max_size, const std::string& what);

/// Limits for the size of a shape.
struct ShapeLimits {
  double min_size = 1e-4;   ///< [m] smallest radius, side or height
  double max_size = 1e5;    ///< [m] largest radius, side, height or vertex coordinate
  bool allow_flat = false;  ///< whether one side of a box may be 0 (a plate)
};

/// One collision shape in its own frame. It is immutable and cheap to copy, because copies share the vertices.
///
/// Sphere, box, cylinder, cone and capsule are centered at the origin. The axis of cylinder, cone and capsule is z. The
/// tip of a cone is at +z. A plane is the half-space z <= 0.
class Shape {
 public:
  ///@{
  /// Creates a shape from its lengths [m] or its vertices.
  ///
  /// The size of a box is its full side lengths. The height of a capsule does not include the round ends. A hull is the
  /// convex hull of all vertices of a mesh; its triangles are ignored.
  /// @throws Refusal with code bad_geometry, nonfinite or out_of_range; its sentence names the value and the rule
  static Shape sphere(double radius, const ShapeLimits& limits = {});
  static Shape box(const Eigen::Vector3d& size, const ShapeLimits& limits = {});
  static Shape cylinder(double height, double radius, const ShapeLimits& limits = {});
  static Shape cone(double height, double radius, const ShapeLimits& limits = {});
  static Shape capsule(double height, double radius, const ShapeLimits& limits = {});
  static Shape hull(std::shared_ptr<const TriangleMesh> vertices, const ShapeLimits& limits = {});
  static Shape mesh(std::shared_ptr<const TriangleMesh> mesh, const ShapeLimits& limits = {});
  ///@}
  /// Creates a plane: the half-space z <= 0.
  static Shape plane();

  /// Creates a sphere, box, cylinder, cone or capsule.
  /// @param kind        a ShapeKind as a number, 1 .. 5
  /// @param dimensions  [m] the lengths in the order in which the function above with this name takes them
  /// @throws Refusal with code unsupported if `kind` is not 1 .. 5
  /// @throws Refusal with code bad_geometry if there are too few or too many dimensions, or if one is out of range
  static Shape primitive(int kind, const std::vector<double>& dimensions, const ShapeLimits& limits = {});

  /// Returns the kind of the shape.
  ShapeKind kind() const { return kind_; }
  /// Returns the dimensions [m] in the order that primitive() expects; empty for hull, mesh and plane.
  std::vector<double> dimensions() const;
  /// Returns the vertices and triangles of a hull or a mesh; null for other kinds.
  const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }
  /// Returns the distance [m] from the origin of the shape to its farthest point; infinite for a plane.
  double reach() const;

 private:
  Shape(ShapeKind kind, const Eigen::Vector3d& size, std::shared_ptr<const TriangleMesh> mesh);
  friend Aabb boxOf(const Shape&, const Pose&, double, const Eigen::Vector3d&);

  ShapeKind kind_;
  Eigen::Vector3d size_;  // box: side lengths; sphere: radius; others: height, radius
  std::shared_ptr<const TriangleMesh> mesh_;
  double reach_ = 0.0;
};

/// Returns the tight box of a shape at a pose, relative to `origin` [m, world]. The shape is grown by `padding` [m].
///
/// The result always contains the exact box of the shape. The box is computed in double, enlarged by 64 units of
/// rounding of its terms, and then rounded outward to float. The formulas need only a part of these 64 units. They
/// follow Ericson, Real-Time Collision Detection, 2005, section 4.2. No box is around a plane: the result is the
/// largest box of floats. Use halfSpaceOf() for planes.
Aabb boxOf(const Shape& shape, const Pose& world_from_shape, double padding, const Eigen::Vector3d& origin);

}  // namespace hgrid
