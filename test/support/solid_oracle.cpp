// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/solid_oracle.h"

#include <algorithm>
#include <map>
#include <utility>

namespace hgrid {
namespace test {
namespace {

using Key = std::array<double, 3>;

bool closesUp(const TriangleMesh& mesh) {
  std::map<std::pair<Key, Key>, int> sides;
  const auto key = [&](std::uint32_t index) {
    const Eigen::Vector3d& v = mesh.vertices[index];
    return Key{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};  // adding 0 turns -0 into 0
  };
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Key from = key(triangle[i]), to = key(triangle[(i + 1) % 3]);
      ++sides[{from, to}];
      --sides[{to, from}];
    }
  }
  for (const auto& side : sides) {
    if (side.second != 0) return false;
  }
  return true;
}

Real volume(const Vector3r& a, const Vector3r& b, const Vector3r& c) { return a.dot(b.cross(c)); }

Real farApart(const Convex& a, const Convex& b) { return (a.center() - b.center()).norm() - a.reach() - b.reach(); }

/// Returns the distance of the cores, which is the distance of the two nearest pieces.
CoreDistance nearestPieces(const SolidOracle& first, const SolidOracle& second) {
  const Convex *a_first = &first.pieces().front(), *b_first = &second.pieces().front();
  for (const Convex& a : first.pieces()) {
    for (const Convex& b : second.pieces()) {
      if (farApart(a, b) < farApart(*a_first, *b_first)) a_first = &a, b_first = &b;
    }
  }
  CoreDistance nearest = coreDistance(*a_first, *b_first);
  for (const Convex& a : first.pieces()) {
    for (const Convex& b : second.pieces()) {
      if (farApart(a, b) > nearest.upper) continue;
      const CoreDistance found = coreDistance(a, b, 1e-11L, nearest.upper);
      const Real lower = std::min(nearest.lower, found.lower);
      if (found.upper < nearest.upper) nearest = found;
      nearest.lower = lower;
    }
  }
  return nearest;
}

bool encloses(const SolidOracle& outer, const SolidOracle& inner) {
  return outer.isClosed() && outer.encloses(inner.pieces().front().support(Vector3r::UnitX()));
}

}  // namespace

SolidOracle::SolidOracle(const Shape& shape, const Pose& world_from_shape, double padding) {
  if (shape.kind() != ShapeKind::mesh) {
    pieces_.emplace_back(shape, world_from_shape, padding);
    return;
  }
  const TriangleMesh& mesh = *shape.mesh();
  for (const auto& triangle : mesh.triangles) {
    const std::array<Eigen::Vector3d, 3> corners = {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                                                    mesh.vertices[triangle[2]]};
    pieces_.emplace_back(corners, world_from_shape, padding);
    std::array<Vector3r, 3> placed;
    for (int i = 0; i < 3; ++i) {
      const Vector3r turned = world_from_shape.linear().cast<Real>() * corners[i].cast<Real>();
      placed[i] = turned + world_from_shape.translation().cast<Real>();
    }
    triangles_.push_back(placed);
  }
  closed_ = closesUp(mesh);
}

bool SolidOracle::encloses(const Vector3r& point) const {
  const Vector3r rays[] = {{0.31L, 0.52L, 0.79L},
                           {-0.83L, 0.17L, 0.53L},
                           {0.12L, -0.91L, 0.39L},
                           {0.45L, 0.37L, -0.81L},
                           {-0.57L, -0.71L, -0.41L}};
  int inside = 0;
  for (const Vector3r& ray : rays) {
    bool odd = false;
    for (const auto& [a, b, c] : triangles_) {
      const Vector3r p = a - point, q = b - point, r = c - point;
      const Real u = volume(ray, p, q), v = volume(ray, q, r), w = volume(ray, r, p);
      const bool leaves = u > 0 && v > 0 && w > 0, enters = u < 0 && v < 0 && w < 0;
      if (!leaves && !enters) continue;  // the ray misses the triangle, or the triangle has no area
      const Real ahead = volume(p, q, r);
      if ((ahead > 0) == leaves) odd = !odd;
    }
    inside += odd;
  }
  return inside > 2;
}

SolidDistance distanceOf(const SolidOracle& first, const SolidOracle& second) {
  const CoreDistance core = nearestPieces(first, second);
  const Real radii = first.radius() + second.radius();
  SolidDistance result;
  result.on_first = core.on_first;
  result.on_second = core.on_second;
  result.enclosed = core.lower > 0 && (encloses(first, second) || encloses(second, first));
  if (result.enclosed) return result;
  result.interval = {double(std::max<Real>(0, core.lower - radii)), double(std::max<Real>(0, core.upper - radii))};
  return result;
}

Interval distanceOf(const SolidOracle& solid, const Eigen::Vector3d& point) {
  const Convex there(point);
  if (solid.isClosed() && solid.encloses(point.cast<Real>())) return {};
  Interval nearest = distanceOf(solid.pieces().front(), there);
  for (const Convex& piece : solid.pieces()) {
    if (farApart(piece, there) - piece.radius() > nearest.upper) continue;
    const Interval found = distanceOf(piece, there);
    nearest = {std::min(nearest.lower, found.lower), std::min(nearest.upper, found.upper)};
  }
  return nearest;
}

bool overlapByMore(const SolidOracle& first, const SolidOracle& second, double depth) {
  const CoreDistance core = nearestPieces(first, second);
  if (core.lower > 0 && (encloses(first, second) || encloses(second, first))) return core.lower > depth;
  const Real radii = first.radius() + second.radius();
  if (core.upper > 1e-10L || radii > depth) return radii - core.upper > depth;
  for (const Convex& a : first.pieces()) {
    for (const Convex& b : second.pieces()) {
      if (farApart(a, b) < 0 && depthOf(a, b, depth).lower > depth) return true;
    }
  }
  return false;
}

}  // namespace test
}  // namespace hgrid
