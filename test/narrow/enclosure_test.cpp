// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Meshes as other programs write them: faces that are turned around, faces that are given for both sides, parts that
// overlap or share edges, gaps. The answers are compared with the winding number of the mesh before it was disordered,
// or with formulas. A point that is enclosed must never be outside.
#include "narrow/enclosure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "test/support/mesh_oracle.h"
#include "test/support/random.h"
#include "test/support/solids.h"

namespace hgrid {

void PrintTo(Inside inside, std::ostream* out) {
  *out << (inside == Inside::no ? "outside" : inside == Inside::yes ? "inside" : "unknown");
}

namespace test {
namespace {

using Vector = Eigen::Vector3d;

Vector randomPoint(Random& random, const Vector& size) {
  return {random.uniform(-0.5, 0.5) * size[0], random.uniform(-0.5, 0.5) * size[1],
          random.uniform(-0.5, 0.5) * size[2]};
}

/// Returns whether a point is in a box around a center.
bool inBox(const Vector& point, const Vector& center, const Vector& size) {
  return ((point - center).cwiseAbs().array() < 0.5 * size.array()).all();
}

TriangleMesh turnedAround(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

/// Expects that no random point that is inside is outside of a mesh. @returns the share of the other points that are
/// outside
double expectNoneOutside(Random& random, const TriangleMesh& mesh, const std::function<bool(const Vector&)>& isInside,
                         const Vector& size, int count = 60) {
  const Enclosure enclosure(mesh);
  int outside = 0, others = 0;
  for (int i = 0; i < count; ++i) {
    const Vector point = randomPoint(random, size);
    const Inside holds = enclosure.holds(point);
    if (isInside(point)) {
      EXPECT_NE(holds, Inside::no) << point.transpose();
    } else {
      ++others;
      outside += holds == Inside::no;
    }
  }
  return others == 0 ? 1.0 : double(outside) / others;
}

TEST(Enclosure, DoesNotDependOnTheDirectionsAndCopiesOfFaces) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(1000 * seed);
    const Vector size(2.0, 1.6, 1.2);
    const TriangleMesh meshes[] = {boxMesh(size), trayMesh(size, 0.2), lumpMesh(random, size), ballMesh(seed % 3)};
    const TriangleMesh& mesh = meshes[seed % 4];
    TriangleMesh written = seed < 5 ? twoSided(mesh) : disordered(random, mesh);
    if (random.chance(0.5)) written = unwelded(written);
    const Enclosure enclosure(written);
    EXPECT_TRUE(enclosure.simple());
    for (int i = 0; i < 40; ++i) {
      const Vector point = randomPoint(random, 1.2 * size);
      const bool inside = std::abs(bruteForceWindingNumber(mesh, point)) > 0.5;
      ASSERT_EQ(enclosure.holds(point), inside ? Inside::yes : Inside::no) << point.transpose();
    }
  }
}

/// Two boxes that overlap, that touch in an edge, that share a face, or of which one is flush with the other.
TEST(Enclosure, KnowsTheInsideOfEachOfTwoParts) {
  const Vector size(1, 1, 1), shifts[] = {{0.3, 0.4, 0.5}, {1, 1, 0}, {1, 0, 0}, {0, 0.25, 0}};
  const Vector sizes[] = {size, size, size, {0.5, 0.5, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    for (unsigned seed = 1; seed <= 30; ++seed) {
      SCOPED_TRACE("shift " + std::to_string(k) + ", seed " + std::to_string(seed));
      Random random(1000 * seed);
      TriangleMesh one = boxMesh(size), other = moved(boxMesh(sizes[k]), shifts[k]);
      if (seed % 3 == 1) other = turnedAround(other);  // as a mirrored part
      TriangleMesh both = joined(one, other);
      if (seed % 3 == 2) both = joined(disordered(random, one), disordered(random, other));
      if (seed % 4 == 3) both = disordered(random, both);
      if (seed % 5 == 3) both = twoSided(both);
      if (random.chance(0.5)) both = unwelded(both);
      const auto isInside = [&](const Vector& point) {
        return inBox(point, {0, 0, 0}, size) || inBox(point, shifts[k], sizes[k]);
      };
      EXPECT_GE(expectNoneOutside(random, both, isInside, {4, 4, 4}), 0.8);
    }
  }
}

/// Two boxes, one of which stands on a part of a face of the other, without a common edge.
TEST(Enclosure, OfPartsThatAreAsTheProgramWroteThemIsExact) {
  Random random(3);
  const Vector size(1, 1, 1), above(0.1, 0.2, 0.75), small(0.5, 0.5, 0.5);
  const Enclosure enclosure(joined(boxMesh(size), moved(boxMesh(small), above)));
  for (int i = 0; i < 500; ++i) {
    const Vector point = randomPoint(random, {2, 2, 3});
    const bool inside = inBox(point, {0, 0, 0}, size) || inBox(point, above, small);
    ASSERT_EQ(enclosure.holds(point), inside ? Inside::yes : Inside::no) << point.transpose();
  }
}

/// Returns a box whose sides are divided along the other diagonals than those of boxMesh().
TriangleMesh boxOfOtherDiagonals(const Vector& size) {
  TriangleMesh mesh = boxMesh(size);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 2) {
    auto &one = mesh.triangles[i], &other = mesh.triangles[i + 1];
    // The corner of one that is not of the other, and the reverse.
    const auto isIn = [](std::uint32_t corner, const std::array<std::uint32_t, 3>& t) {
      return t[0] == corner || t[1] == corner || t[2] == corner;
    };
    std::size_t a = 0, b = 0;
    while (isIn(one[a], other)) ++a;
    while (isIn(other[b], one)) ++b;
    const std::uint32_t p = one[a], q = one[(a + 1) % 3], r = other[b], s = one[(a + 2) % 3];
    one = {p, q, r};
    other = {p, r, s};
  }
  return mesh;
}

TEST(Enclosure, OfFacesForBothSidesMayBeDividedAlongOtherDiagonals) {
  const Vector size(1, 1.5, 2);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector(1, 2, 3).normalized()).toRotationMatrix();
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(1000 * seed);
    TriangleMesh mesh = joined(boxMesh(size), turnedAround(boxOfOtherDiagonals(size)));
    if (seed % 2 == 0) mesh = joined(disordered(random, boxMesh(size)), disordered(random, boxOfOtherDiagonals(size)));
    // In single precision, the corners of a side that is not along an axis are not quite in a plane.
    for (Vector& vertex : mesh.vertices) vertex = (turn * vertex).cast<float>().cast<double>();
    const auto isInside = [&](const Vector& point) { return inBox(turn.transpose() * point, {0, 0, 0}, 0.999 * size); };
    EXPECT_GE(expectNoneOutside(random, mesh, isInside, {3, 3, 3}), seed % 2 == 0 ? 0.6 : 0.95);
  }
}

// The corners that faces have in common may be rounded in different ways, also those of two copies of a face.
TEST(Enclosure, MayHaveTinyGaps) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(1000 * seed);
    const Vector size(2, 1.6, 1.2);
    const TriangleMesh mesh = seed % 2 == 0 ? boxMesh(size) : ballMesh(2);
    const auto rounded = [&random](TriangleMesh written, double by) {
      for (Vector& vertex : written.vertices) vertex += randomPoint(random, {by, by, by});
      return written;
    };
    TriangleMesh written = rounded(unwelded(mesh), random.logUniform(1e-9, 1e-3));
    written = unwelded(seed % 4 < 2 ? twoSided(written) : disordered(random, written));
    if (random.chance(0.5)) written = rounded(written, random.logUniform(1e-9, 1e-5));
    const auto isWellInside = [&](const Vector& point) {
      return std::abs(bruteForceWindingNumber(mesh, 1.01 * point)) > 0.5;
    };
    expectNoneOutside(random, written, isWellInside, 0.95 * size, 30);
  }
}

TEST(Enclosure, OfABoxWithAPartitionIsKnownOnBothSidesOfThePartition) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(1000 * seed);
    TriangleMesh mesh = joined(boxMesh({1, 1, 1}), moved(boxMesh({1, 1, 1}), {1, 0, 0}));
    // The last four triangles of boxMesh() are its sides along x. Both boxes have the side between them, which is
    // removed from the second one.
    mesh.triangles.erase(mesh.triangles.end() - 4, mesh.triangles.end() - 2);
    const TriangleMesh written = disordered(random, mesh);
    const auto isInside = [](const Vector& point) { return inBox(point, {0.5, 0, 0}, {2, 1, 1}); };
    EXPECT_GE(expectNoneOutside(random, written, isInside, {4, 2, 2}), 0.7);
  }
}

TEST(Enclosure, OfAnOpenMeshIsUnknownWhereItSurroundsAPointByAQuarter) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(1000 * seed);
    TriangleMesh mesh = seed % 2 == 0 ? ballMesh(1) : trayMesh({2, 1.6, 1.2}, 0.3);
    for (int holes = random.between(1, 2); holes > 0; --holes) {
      mesh = without(mesh, std::size_t(random.below(int(mesh.triangles.size()))));
    }
    const Enclosure given(mesh), disorderly(disordered(random, mesh));
    for (int i = 0; i < 60; ++i) {
      const Vector point = randomPoint(random, {2, 2, 2});
      if (!given.boxHolds(point)) continue;
      const bool quarter = std::abs(bruteForceWindingNumber(mesh, point)) >= 0.25;
      ASSERT_EQ(given.holds(point), quarter ? Inside::unknown : Inside::no) << point.transpose();
      if (quarter) {
        ASSERT_EQ(disorderly.holds(point), Inside::unknown) << point.transpose();
      }
    }
  }
}

TEST(Enclosure, OfAnOpenSheetForBothSidesIsNothing) {
  const Vector size(2, 1.6, 1.2);
  TriangleMesh mesh = boxMesh(size);
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // the top
  const Enclosure enclosure(twoSided(mesh));
  Random random(1);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(enclosure.holds(randomPoint(random, {1, 0.8, 0.6})), Inside::no);
}

TEST(Enclosure, ACavityOfAHollowMeshStaysOutside) {
  Random random(1);
  const TriangleMesh hollow = joined(boxMesh({2, 2, 2}), turnedAround(boxMesh({1, 1, 1})));
  const TriangleMesh rod = moved(boxMesh({0.1, 0.1, 0.1}), {3, 0, 0});
  for (const TriangleMesh& mesh :
       {hollow, turnedAround(hollow), joined(hollow, twoSided(rod)), joined(hollow, turnedAround(rod))}) {
    const Enclosure enclosure(mesh);
    for (int i = 0; i < 100; ++i) {
      const Vector point = randomPoint(random, {2.4, 2.4, 2.4});
      const bool inside = inBox(point, {0, 0, 0}, {2, 2, 2}) && !inBox(point, {0, 0, 0}, {1, 1, 1});
      ASSERT_EQ(enclosure.holds(point), inside ? Inside::yes : Inside::no) << point.transpose();
    }
  }
  // Which side of the inner surface is solid is not known if its faces are disordered.
  EXPECT_EQ(Enclosure(joined(twoSided(boxMesh({2, 2, 2})), twoSided(boxMesh({1, 1, 1})))).holds({0, 0, 0}),
            Inside::unknown);
}

// One whole surface is wound twice around its inside if all its faces are given twice for the same side.
TEST(Enclosure, OfASurfaceThatIsGivenTwiceIsItsInside) {
  const TriangleMesh box = boxMesh({1, 1, 1});
  const Enclosure enclosure(joined(box, box));
  EXPECT_EQ(enclosure.holds({0.1, 0.2, 0.3}), Inside::yes);
  EXPECT_EQ(enclosure.holds({0.6, 0.2, 0.3}), Inside::no);
}

TEST(Enclosure, AOneSidedSurfaceHasNoInside) {
  TriangleMesh strip;  // a Moebius strip
  constexpr std::uint32_t kParts = 12;
  for (std::uint32_t i = 0; i < kParts; ++i) {
    const double around = 2 * M_PI * i / kParts;
    for (const double across : {-0.2, 0.2}) {
      const double radius = 1.0 + across * std::cos(0.5 * around);
      strip.vertices.emplace_back(radius * std::cos(around), radius * std::sin(around),
                                  across * std::sin(0.5 * around));
    }
    const std::uint32_t a = 2 * i, b = a + 1;
    const bool last = i + 1 == kParts;
    const std::uint32_t c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    strip.triangles.push_back({a, b, c});
    strip.triangles.push_back({b, d, c});
  }
  const Enclosure enclosure(strip);
  EXPECT_FALSE(enclosure.simple());
  EXPECT_EQ(enclosure.holds({0, 0, 0.01}), Inside::no);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
