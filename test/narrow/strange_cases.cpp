// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/narrow/strange_cases.h"

namespace hgrid {
namespace test {
namespace {

/// Returns the vertices of a degenerate hull: all in one point, on a line or in a plane, and some of them repeated.
TriangleMesh poorHull(Random& random, double size) {
  const int dimensions = random.below(4), count = random.between(1, 12);
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int k = 0; k < dimensions; ++k)
      point[k] = size * (random.chance(0.5) ? random.between(-1, 1) : random.uniform(-1, 1));
    for (int copies = random.between(1, 3); copies > 0; --copies) mesh.vertices.push_back(point);
  }
  return mesh;
}

/// Adds triangles of area 0: with two equal corners, with all corners on a line, or with three equal corners.
void addPoorTriangles(Random& random, TriangleMesh& mesh) {
  for (int i = random.between(1, 6); i > 0; --i) {
    const auto [a, b, c] = mesh.triangles[std::size_t(random.below(int(mesh.triangles.size())))];
    const auto middle = std::uint32_t(mesh.vertices.size());
    switch (random.below(3)) {
      case 0:
        mesh.triangles.push_back({a, b, a});
        break;
      case 1:
        mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
        mesh.triangles.push_back({a, middle, b});
        break;
      default:
        mesh.triangles.push_back({c, c, c});
    }
  }
}

}  // namespace

Shape strangeShape(Random& random) {
  const auto kind = ShapeKind(random.between(1, 7));
  const double huge = random.logUniform(1e4, 4e4);
  switch (random.below(7)) {
    case 0:  // thin plates and needles
      if (kind == ShapeKind::box) return Shape::box({random.logUniform(0.1, 2), random.logUniform(0.1, 2), 1e-4});
      if (kind == ShapeKind::cylinder) return Shape::cylinder(random.logUniform(0.1, 2), 1e-4);
      if (kind == ShapeKind::cone) return Shape::cone(1e-4, random.logUniform(0.1, 2));
      if (kind == ShapeKind::mesh) return meshOf(boxMesh({1.0, random.logUniform(0.1, 2), 1e-4}));
      return Shape::capsule(random.logUniform(0.1, 2), 1e-4);
    case 1:  // tiny shapes
      return randomSolid(random, kind, {2e-4, 4e-4, 1.0});
    case 2:  // huge shapes
      return randomSolid(random, kind, {huge, huge, 2.0});
    case 3:
      return Shape::hull(std::make_shared<TriangleMesh>(poorHull(random, random.logUniform(1e-3, 2))));
    case 4: {
      TriangleMesh mesh = lumpMesh(random, {1.0, random.uniform(0.1, 1.0), 0.5});
      addPoorTriangles(random, mesh);
      return meshOf(random.chance(0.5) ? mesh : without(mesh, 0));
    }
    case 5: {
      ShapeLimits flat;
      flat.allow_flat = true;
      return Shape::box({random.logUniform(0.1, 2), random.logUniform(0.1, 2), 0.0}, flat);
    }
    default:
      return randomSolid(random, kind);
  }
}

Case strangeCase(Random& random) {
  const Shape first = strangeShape(random), second = random.chance(0.1) ? first : strangeShape(random);
  const double reach = first.reach() + second.reach();
  const auto padding = [&] { return random.chance(0.7) ? 0.0 : random.logUniform(1e-6, 0.1); };
  Case strange{first, second, randomPose(random, 1.0), randomPose(random, 1.0), padding(), padding()};
  switch (random.below(5)) {
    case 0:
      strange.world_from_second = strange.world_from_first;
      break;
    case 1:
      strange.world_from_second.translation() = strange.world_from_first.translation();
      break;
    case 2:
      strange.world_from_second = randomPose(random, reach);
      break;
    default: {
      const bool parallel = random.chance(0.5);
      if (parallel) strange.world_from_second = strange.world_from_first;
      strange.world_from_second.translation() += 1.5 * reach * randomPose(random, 1.0).linear().col(random.below(3));
      bringTo(random.logUniform(1e-16, 1e-6) * (random.chance(0.3) ? -1.0 : 1.0), strange);
    }
  }
  if (random.chance(0.2)) {
    const Eigen::Vector3d off = 1e6 * randomPose(random, 1.0).linear().col(0);
    strange.world_from_first.translation() += off;
    strange.world_from_second.translation() += off;
  }
  return strange;
}

}  // namespace test
}  // namespace hgrid
