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
enum class ShapeKind : std::uint8_t { sphere = 1, box = 2, cylinder = 3, cone = 4, capsule = 5, hull = 6, mesh = 7 };

/// The kind as a word, as in "cylinder".
const char* name(ShapeKind kind);

/// Vertices [m] and triangles (three indices into them, counter-clockwise seen from outside).
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Checks a mesh: finite vertices within max_size, indices in range, at least one triangle with an area.
/// @throws Refusal nonfinite, out_of_range, bad_geometry
void checkMesh(const TriangleMesh& mesh, double max_size, const std::string& what);

/// What a shape may measure.
struct ShapeLimits {
  double min_size = 1e-4;   ///< [m] smallest radius, side or height
  double max_size = 1e5;    ///< [m] largest radius, side, height or vertex coordinate
  bool allow_flat = false;  ///< a box may have one side of 0 (a plate)
};

/// One collision shape in its own frame, immutable and cheap to copy (vertices are shared).
/// Box, cylinder, cone and capsule are centred in the origin; axes are z; a cone's tip is at +z.
class Shape {
 public:
  /// Every maker throws Refusal (bad_geometry, nonfinite, out_of_range) naming the value and the rule.
  static Shape sphere(double radius, const ShapeLimits& limits = {});
  static Shape box(const Eigen::Vector3d& size, const ShapeLimits& limits = {});  ///< full lengths
  static Shape cylinder(double height, double radius, const ShapeLimits& limits = {});
  static Shape cone(double height, double radius, const ShapeLimits& limits = {});
  static Shape capsule(double height, double radius, const ShapeLimits& limits = {});  ///< height without the ends
  static Shape hull(std::shared_ptr<const TriangleMesh> vertices, const ShapeLimits& limits = {});
  static Shape mesh(std::shared_ptr<const TriangleMesh> mesh, const ShapeLimits& limits = {});

  /// A primitive from a kind and its dimensions, in the order of the parameters of its maker above. A box has three.
  /// @throws Refusal unsupported for a kind that is none, bad_geometry for a wrong number of dimensions.
  static Shape primitive(int kind, const std::vector<double>& dimensions, const ShapeLimits& limits = {});

  ShapeKind kind() const { return kind_; }
  /// [m] in the order that primitive() takes; empty for hull and mesh.
  std::vector<double> dimensions() const;
  /// Of hull and mesh; null otherwise.
  const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }
  /// [m] distance of the farthest point of the shape from its origin.
  double reach() const;

 private:
  Shape(ShapeKind kind, const Eigen::Vector3d& size, std::shared_ptr<const TriangleMesh> mesh);
  friend Aabb boxOf(const Shape&, const Pose&, double, const Eigen::Vector3d&);

  ShapeKind kind_;
  Eigen::Vector3d size_;  // box: lengths; sphere: radius; others: height, radius
  std::shared_ptr<const TriangleMesh> mesh_;
  double reach_ = 0.0;
};

/// The tight box, relative to `origin` [m], of a shape at a pose, the shape grown by `padding` [m].
///
/// Computed in double, half-widths rounded up by 64 units of rounding of the terms (several times
/// what the formulas need), then rounded outward to float: it contains the exact box of the shape.
/// Formulas after Ericson, Real-Time Collision Detection, 2005, section 4.2.
Aabb boxOf(const Shape& shape, const Pose& world_from_shape, double padding, const Eigen::Vector3d& origin);

}  // namespace hgrid
