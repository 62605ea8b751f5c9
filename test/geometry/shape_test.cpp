// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/shape.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "test/support/refusals.h"
#include "test/support/shapes.h"

namespace hgrid {
namespace {

using test::refusalOf;
using test::says;

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInfinity = std::numeric_limits<double>::infinity();

std::shared_ptr<TriangleMesh> tetrahedron() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TEST(Shape, RefusesEveryMeasureThatCannotBe) {
  const std::pair<const char*, std::function<Shape(double)>> makers[] = {
      {"sphere", [](double v) { return Shape::sphere(v); }},
      {"box",
       [](double v) {
         return Shape::box({v, 1, 1});
       }},
      {"box",
       [](double v) {
         return Shape::box({1, v, 1});
       }},
      {"box",
       [](double v) {
         return Shape::box({1, 1, v});
       }},
      {"cylinder", [](double v) { return Shape::cylinder(v, 1); }},
      {"cylinder", [](double v) { return Shape::cylinder(1, v); }},
      {"cone", [](double v) { return Shape::cone(v, 1); }},
      {"cone", [](double v) { return Shape::cone(1, v); }},
      {"capsule", [](double v) { return Shape::capsule(v, 1); }},
      {"capsule", [](double v) { return Shape::capsule(1, v); }},
  };
  for (const auto& maker : makers) {
    for (const double bad : {0.0, -0.0, -1.0, kNan, kInfinity, -kInfinity, 1e-320, 1e308}) {
      std::string sentence;
      EXPECT_EQ(refusalOf([&] { maker.second(bad); }, &sentence), Code::bad_geometry) << maker.first << " " << bad;
      EXPECT_TRUE(says(sentence, maker.first));
      EXPECT_TRUE(says(sentence, text(bad)));
    }
    for (const double good : {1e-4, 1e5, 1.0}) {
      EXPECT_EQ(refusalOf([&] { maker.second(good); }), Code::ok) << maker.first << " " << good;
    }
  }
}

TEST(Shape, TakesItsLimitsFromTheCaller) {
  ShapeLimits limits;
  limits.min_size = 0.5;
  limits.max_size = 2.0;
  EXPECT_EQ(refusalOf([&] { Shape::sphere(0.5, limits); }), Code::ok);
  EXPECT_EQ(refusalOf([&] { Shape::sphere(2.0, limits); }), Code::ok);
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { Shape::sphere(std::nextafter(0.5, 0.0), limits); }), Code::bad_geometry);
  EXPECT_EQ(refusalOf([&] { Shape::sphere(std::nextafter(2.0, 3.0), limits); }, &sentence), Code::bad_geometry);
  EXPECT_TRUE(says(sentence, "0.5"));
}

TEST(Shape, TakesAPlateOnlyWherePlatesAreAllowed) {
  ShapeLimits flat;
  flat.allow_flat = true;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d size(1, 1, 1);
    size[axis] = 0.0;
    EXPECT_EQ(refusalOf([&] { Shape::box(size); }), Code::bad_geometry);
    EXPECT_EQ(refusalOf([&] { Shape::box(size, flat); }), Code::ok);
    size[(axis + 1) % 3] = 0.0;
    EXPECT_EQ(refusalOf([&] { Shape::box(size, flat); }), Code::bad_geometry)
        << "a box that is flat on two axes must be refused";
  }
  EXPECT_EQ(refusalOf([&] { Shape::box({0, 0, 0}, flat); }), Code::bad_geometry);
  EXPECT_EQ(refusalOf([&] { Shape::box({-1, 1, 1}, flat); }), Code::bad_geometry);
  EXPECT_EQ(refusalOf([&] { Shape::sphere(0.0, flat); }), Code::bad_geometry);
}

TEST(Shape, PrimitiveCountsItsDimensionsAndKnowsItsKind) {
  const std::size_t expected[] = {0, 1, 3, 2, 2, 2};
  for (int kind = 1; kind <= 5; ++kind) {
    for (std::size_t count = 0; count <= 4; ++count) {
      const std::vector<double> dimensions(count, 1.0);
      const Code code = refusalOf([&] { Shape::primitive(kind, dimensions); });
      EXPECT_EQ(code, count == expected[kind] ? Code::ok : Code::bad_geometry) << kind << " with " << count;
    }
  }
  for (const int kind : {-1, 0, 6, 7, 8, 255, 1 << 20}) {
    EXPECT_EQ(refusalOf([&] { Shape::primitive(kind, {1, 1, 1}); }), Code::unsupported) << kind;
  }
}

TEST(Shape, PrimitiveMakesWhatTheMakerMakes) {
  EXPECT_EQ(Shape::primitive(1, {0.5}).kind(), ShapeKind::sphere);
  EXPECT_EQ(Shape::primitive(1, {0.5}).dimensions(), std::vector<double>({0.5}));
  EXPECT_EQ(Shape::primitive(2, {1, 2, 3}).kind(), ShapeKind::box);
  EXPECT_EQ(Shape::primitive(2, {1, 2, 3}).dimensions(), std::vector<double>({1, 2, 3}));
  const ShapeKind round[] = {ShapeKind::cylinder, ShapeKind::cone, ShapeKind::capsule};
  for (int kind = 3; kind <= 5; ++kind) {
    EXPECT_EQ(Shape::primitive(kind, {2, 0.5}).kind(), round[kind - 3]);
    EXPECT_EQ(Shape::primitive(kind, {2, 0.5}).dimensions(), std::vector<double>({2, 0.5}))
        << "the dimensions must be height and radius, in this order";
  }
}

TEST(Shape, RefusesMeshesWithoutSurface) {
  EXPECT_EQ(refusalOf([&] { Shape::mesh(tetrahedron()); }), Code::ok);
  EXPECT_EQ(refusalOf([&] { Shape::mesh(nullptr); }), Code::bad_geometry);
  EXPECT_EQ(refusalOf([&] { Shape::hull(nullptr); }), Code::bad_geometry);
  EXPECT_EQ(refusalOf([&] { Shape::mesh(std::make_shared<TriangleMesh>()); }), Code::bad_geometry);
  EXPECT_EQ(refusalOf([&] { Shape::hull(std::make_shared<TriangleMesh>()); }), Code::bad_geometry);
  auto mesh = tetrahedron();
  mesh->triangles.clear();
  EXPECT_EQ(refusalOf([&] { Shape::mesh(mesh); }), Code::bad_geometry);
  mesh = tetrahedron();
  mesh->vertices.resize(1);
  mesh->triangles = {{0, 0, 0}};
  EXPECT_EQ(refusalOf([&] { Shape::mesh(mesh); }), Code::bad_geometry);
  mesh = tetrahedron();
  mesh->triangles = {{0, 0, 1}, {1, 2, 2}, {3, 3, 3}};
  EXPECT_EQ(refusalOf([&] { Shape::mesh(mesh); }), Code::bad_geometry) << "all triangles are degenerate";
  mesh->vertices[2] << 0.5, 0, 0;
  mesh->triangles = {{0, 1, 2}};
  EXPECT_EQ(refusalOf([&] { Shape::mesh(mesh); }), Code::bad_geometry) << "three corners on one line";
  mesh->triangles = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_EQ(refusalOf([&] { Shape::mesh(mesh); }), Code::ok) << "one triangle with an area must be enough";
}

TEST(Shape, RefusesTrianglesThatNameNoVertex) {
  for (const std::uint32_t bad : {4u, 5u, 0xffffffffu}) {  // 0xffffffff is -1 as an unsigned number
    for (std::size_t corner = 0; corner < 3; ++corner) {
      auto mesh = tetrahedron();
      mesh->triangles[2][corner] = bad;
      std::string sentence;
      EXPECT_EQ(refusalOf([&] { Shape::mesh(mesh); }, &sentence), Code::bad_geometry);
      EXPECT_TRUE(says(sentence, std::to_string(bad)));
    }
  }
}

TEST(Shape, RefusesVerticesThatAreNotFiniteOrTooFar) {
  for (const bool hull : {false, true}) {
    const auto codeWith = [&](double value) {
      auto mesh = tetrahedron();
      mesh->vertices[3].y() = value;
      return refusalOf([&] { hull ? Shape::hull(mesh) : Shape::mesh(mesh); });
    };
    EXPECT_EQ(codeWith(kNan), Code::nonfinite);
    EXPECT_EQ(codeWith(kInfinity), Code::nonfinite);
    EXPECT_EQ(codeWith(-kInfinity), Code::nonfinite);
    EXPECT_EQ(codeWith(1e38), Code::out_of_range);
    EXPECT_EQ(codeWith(-1e38), Code::out_of_range);
    EXPECT_EQ(codeWith(1e5), Code::ok);
    EXPECT_EQ(codeWith(std::nextafter(1e5, 2e5)), Code::out_of_range);
  }
}

TEST(Shape, CopiesShareTheirVertices) {
  const Shape mesh = Shape::mesh(tetrahedron()), copy = mesh;
  EXPECT_EQ(mesh.mesh(), copy.mesh());
  EXPECT_EQ(Shape::sphere(1).mesh(), nullptr);
  EXPECT_TRUE(mesh.dimensions().empty());
}

TEST(Shape, KindsHaveTheirNames) {
  EXPECT_STREQ(name(ShapeKind::sphere), "sphere");
  EXPECT_STREQ(name(ShapeKind::cylinder), "cylinder");
  EXPECT_STREQ(name(ShapeKind::mesh), "mesh");
}

}  // namespace
}  // namespace hgrid
