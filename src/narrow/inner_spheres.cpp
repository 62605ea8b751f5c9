// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/inner_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/rotation.h"
#include "narrow/mesh_solid.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr std::size_t kMostOfMesh = 12;  // largest number of spheres in a closed mesh
constexpr double kPoints = 700.0;        // about this many points of a mesh are tried as centers
constexpr double kLeast = 0.25;          // no sphere of a mesh is smaller than this share of its largest sphere
constexpr double kSpread = 0.7;          // no sphere is centered within this share of the radius of another sphere
constexpr double kSafe = 1 - 1e-6;       // spheres are this much smaller than computed, because of rounding

/// Returns how many spheres of a radius [m] cover a length [m] well; at most `most`.
int countAlong(double length, double radius, int most) {
  return 1 + static_cast<int>(std::min(most - 1.0, std::ceil(length / radius)));
}

/// Returns a coordinate [m] that runs from -0.5 * length to 0.5 * length while `i` runs from 0 to count - 1.
double along(double length, int i, int count) { return count < 2 ? 0.0 : length * (i / (count - 1.0) - 0.5); }

/// Fills a row of spheres along z. The centers are up to `length` [m] apart.
std::vector<Sphere> rowOf(double radius, double length) {
  std::vector<Sphere> spheres;
  const int count = countAlong(length, radius, 6);
  for (int i = 0; i < count; ++i) spheres.push_back({{0.0, 0.0, along(length, i, count)}, radius});
  return spheres;
}

std::vector<Sphere> spheresOfBox(const Vector& size) {
  Eigen::Index thin = 0;
  const double radius = 0.5 * size.minCoeff(&thin);
  const Eigen::Index second = (thin + 1) % 3, third = (thin + 2) % 3;
  const Vector length = size.array() - 2.0 * radius;
  const int rows = countAlong(length[second], radius, 3), columns = countAlong(length[third], radius, 4);
  std::vector<Sphere> spheres;
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < columns; ++k) {
      Sphere sphere{Vector::Zero(), radius};
      sphere.center[second] = along(length[second], i, rows);
      sphere.center[third] = along(length[third], k, columns);
      spheres.push_back(sphere);
    }
  }
  return spheres;
}

std::vector<Sphere> spheresOfCylinder(double height, double radius) {
  if (height >= 2.0 * radius) return rowOf(radius, height - 2.0 * radius);
  const double flat = 0.5 * height;
  std::vector<Sphere> spheres{{Vector::Zero(), flat}};
  for (int i = 0; i < 6; ++i) {
    const double x = cosine(i * M_PI / 3.0), y = sine(i * M_PI / 3.0);
    spheres.push_back({(radius - flat) * Vector(x, y, 0.0), flat});
  }
  return spheres;
}

/// Returns the largest sphere in a cone.
Sphere sphereOfCone(double height, double radius) {
  const double inner = radius * height / (radius + std::sqrt(radius * radius + height * height));
  return {{0.0, 0.0, inner - 0.5 * height}, inner};
}

std::vector<Sphere> spheresOf(const Shape& shape, const Solid& solid) {
  const std::vector<double> size = shape.dimensions();
  switch (shape.kind()) {
    case ShapeKind::sphere:
      return {{Vector::Zero(), size[0]}};
    case ShapeKind::box:
      return spheresOfBox({size[0], size[1], size[2]});
    case ShapeKind::cylinder:
      return spheresOfCylinder(size[0], size[1]);
    case ShapeKind::cone:
      return {sphereOfCone(size[0], size[1])};
    case ShapeKind::capsule:
      return rowOf(size[1], size[0]);
    case ShapeKind::mesh:
      if (const auto* mesh = dynamic_cast<const MeshSolid*>(&solid)) return mesh->innerSpheres();
      break;
    case ShapeKind::hull:
    case ShapeKind::plane:
      break;
  }
  return {};
}

/// Selects large spheres that are spread over the mesh. @param spheres  all spheres that were found
std::vector<Sphere> chosen(std::vector<Sphere> spheres) {
  std::stable_sort(spheres.begin(), spheres.end(),
                   [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  std::vector<Sphere> result;
  for (const Sphere& sphere : spheres) {
    if (result.size() == kMostOfMesh || sphere.radius < kLeast * spheres.front().radius) break;
    const bool apart = std::all_of(result.begin(), result.end(), [&](const Sphere& other) {
      return (sphere.center - other.center).norm() > kSpread * other.radius;
    });
    if (apart) result.push_back(sphere);
  }
  return result;
}

/// Returns corners of triangles that are far from each other, as spheres of radius 0. Each is the corner that is
/// farthest from the corners before it.
std::vector<Sphere> spreadCorners(const std::vector<Triangle>& triangles) {
  std::vector<Vector> corners;
  for (const Triangle& triangle : triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  std::vector<double> squared(corners.size(), std::numeric_limits<double>::infinity());
  std::vector<Sphere> spheres;
  std::size_t next = 0;
  while (spheres.size() < kMostInnerSpheres && squared[next] > 0.0) {
    spheres.push_back({corners[next], 0.0});
    for (std::size_t i = 0; i < corners.size(); ++i) {
      squared[i] = std::min(squared[i], (corners[i] - spheres.back().center).squaredNorm());
    }
    next = static_cast<std::size_t>(std::max_element(squared.begin(), squared.end()) - squared.begin());
  }
  return spheres;
}

}  // namespace

std::vector<Sphere> innerSpheresOf(const Shape& shape, const Solid& solid) {
  std::vector<Sphere> spheres = spheresOf(shape, solid);
  for (Sphere& sphere : spheres) sphere.radius *= kSafe;
  return spheres;
}

std::vector<Sphere> innerSpheresOf(const MeshTree& tree, const Enclosure& enclosure, const Vector& low,
                                   const Vector& high) {
  if (!enclosure.simple()) return spreadCorners(tree.triangles());
  const Vector size = high - low;
  const double step = std::cbrt(size.prod() / kPoints);
  if (!(step > 0.0)) return {};
  const ConvexSolid point(ConvexCore::point(), {});
  Eigen::Array3i count;
  // Odd numbers, so that the middle of the box is tried.
  for (Eigen::Index k = 0; k < 3; ++k) count[k] = static_cast<int>(std::min(40.0, std::ceil(size[k] / step))) | 1;
  std::vector<Sphere> spheres;
  for (int x = 0; x < count[0]; ++x) {
    for (int y = 0; y < count[1]; ++y) {
      for (int z = 0; z < count[2]; ++z) {
        const Vector share((x + 0.5) / count[0], (y + 0.5) / count[1], (z + 0.5) / count[2]);
        const Vector center = low + share.cwiseProduct(size);
        if (enclosure.holds(center) != Inside::yes) continue;
        const CoreGap gap = tree.gapTo(point, Pose(Eigen::Translation3d(center)), {0.0, size.norm()});
        if (gap.lower > 0.0) spheres.push_back({center, gap.lower});
      }
    }
  }
  return chosen(std::move(spheres));
}

}  // namespace hgrid
