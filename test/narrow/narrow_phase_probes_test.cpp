// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Queries use points, needles and blocks as probes. Distances to a probe equal those to the shape that it represents.
#include <gtest/gtest.h>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

class Probes : public testing::TestWithParam<ShapeKind> {
 protected:
  /// Puts `probe` at random poses near a shape of the tested kind. Expects the distance that the oracle gives for
  /// `shape` instead of the probe.
  void expectLike(const Shape& shape, const Solid& probe, double radius, double padding) {
    Cases cases(17, {GetParam(), ShapeKind::sphere});
    for (int i = 0; i < 40; ++i) {
      Case placed = cases.next();
      placed.second_shape = shape;
      placed.second_padding = padding;
      bringTo(cases.random().uniform(-0.01, 0.1), placed);
      const Interval truth = distanceOf(placed.first(), placed.second()).interval;
      const auto solid = narrowPhase().solidOf(placed.first_shape);
      const Proximity answer = narrowPhase().measure({*solid, placed.world_from_first, placed.first_padding},
                                                     {probe, placed.world_from_second, radius + padding}, 100.0);
      ASSERT_EQ(unsound(answer, 100.0), "") << placed.text();
      ASSERT_LE(truth.errorOf(answer.distance), 1e-6) << placed.text();
    }
  }
};

INSTANTIATE_TEST_SUITE_P(NarrowPhase, Probes, testing::ValuesIn(testedKinds()),
                         [](const auto& info) { return std::string(name(info.param)); });

TEST_P(Probes, APointWithARadiusIsASphere) {
  const auto point = narrowPhase().point();
  for (const double radius : {1e-3, 0.5}) expectLike(Shape::sphere(radius), *point, radius, 0.01);
}

TEST_P(Probes, ANeedleWithARadiusIsACapsule) {
  for (const double length : {1e-3, 1.0, 5.0}) {
    expectLike(Shape::capsule(length, 0.2), *narrowPhase().needle(length), 0.2, 0.01);
  }
}

// A block may have sides of length 0. It is then a plate, a segment or a point.
TEST_P(Probes, ABlockIsABox) {
  for (const Eigen::Vector3d& size : {Eigen::Vector3d(0.1, 0.5, 1.0), Eigen::Vector3d(0.5, 0.5, 0.0),
                                      Eigen::Vector3d(0.5, 0.0, 0.0), Eigen::Vector3d(0.0, 0.0, 0.0)}) {
    const Shape corners = Shape::hull(std::make_shared<TriangleMesh>(boxMesh(size)));
    expectLike(corners, *narrowPhase().block(size), 0.0, 0.01);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
