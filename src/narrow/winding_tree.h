// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace hgrid {

/// What a straight line from a point meets.
struct LineView {
  double thin = 0.0;                                          ///< [m] surfaces that are this near to each other are one
  double distance = std::numeric_limits<double>::infinity();  ///< [m] to the first surface; infinite: there is none
  bool front = false, back = false;                           ///< which sides of triangles are seen at this distance
  int sum = 0;          ///< number of all triangles met from behind, minus those met from the front
  bool unsure = false;  ///< the line touches the border of a triangle within the rounding error
};

/// Computes how often the surface of a mesh winds around a point, without visiting all triangles. Immutable.
///
/// The winding number is the sum of the signed solid angles of all triangles / (4 pi). For a closed mesh it is an
/// integer, and 0 outside. For an open mesh it can be any number. The result is that of the sum over all triangles,
/// except for rounding.
///
/// Seen from a point outside of its bounding box, a part of the surface has the same solid angle as any other surface
/// in the box with the same boundary. So the tree replaces the part by a fan of triangles over its boundary edges
/// (Jacobson, Kavan, Sorkine-Hornung 2013, "Robust Inside-Outside Segmentation using Generalized Winding Numbers",
/// section 4.1). For a mesh whose triangles share corners, the time grows like the square root of the number of
/// triangles. Triangles that share no corners have no smaller boundary, so the time is then linear.
class WindingTree {
 public:
  using Corners = std::array<std::uint32_t, 3>;

  /// @param triangles  numbers of vertices; triangles that meet in an edge use the same numbers for its ends
  WindingTree(std::vector<Eigen::Vector3d> vertices, std::vector<Corners> triangles);

  /// Whether each edge of a triangle has a matching edge of opposite direction in another triangle.
  bool closed() const { return closed_; }
  double windingNumber(const Eigen::Vector3d& point) const;
  /// Follows a line from a point in a direction, a unit vector along no axis. Adds the triangles that it meets to
  /// `view`.
  void look(const Eigen::Vector3d& point, const Eigen::Vector3d& direction, LineView& view) const;

 private:
  class Builder;
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  // start and end, as the triangle on its left visits them
  struct Span {
    std::uint32_t begin = 0, end = 0;
  };
  /// A part of the surface. Its first child is the next node, its second child is the node `second_child`.
  struct Node {
    bool holds(const Eigen::Vector3d& point) const {
      return (point.array() >= low.array()).all() && (point.array() <= high.array()).all();
    }
    Eigen::Vector3d low, high;  // [m] bounding box
    Span triangles, boundary;
    bool has_boundary = false;       // whether the boundary is stored, since it has few edges
    std::uint32_t second_child = 0;  // 0: no children
  };

  /// Returns the sum of half of the solid angles of the triangles below a node.
  double halfAngles(std::size_t node, const Eigen::Vector3d& point) const;
  void look(std::size_t node, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
            const Eigen::Vector3d& per_length, LineView& view) const;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<Corners> triangles_;
  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
  bool closed_ = false;
};

}  // namespace hgrid
