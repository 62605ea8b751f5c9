// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Faces of more than three corners, in OBJ and DAE files. The oracle for the area of a polygon is the even-odd rule: a
// point is inside if a ray from it crosses an odd number of sides.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/adapters/temporary_folder.h"
#include "test/support/random.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

bool isInside(const Polygon& polygon, const Point& p) {
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) * (b.x() - a.x()) / (b.y() - a.y())) inside = !inside;
  }
  return inside;
}

double areaOf(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// Returns the outline of random cells of a grid, without holes and without places where it touches itself. Some of its
/// corners do not turn.
Polygon rightAngled(Random& random) {
  using Cell = std::pair<int, int>;
  std::set<Cell> cells{{0, 0}};
  const auto has = [&](int x, int y) { return cells.count({x, y}) > 0; };
  for (int i = random.between(3, 30); i > 0; --i) {
    const Cell at = *std::next(cells.begin(), random.below(static_cast<int>(cells.size())));
    const int way = random.below(4), x = at.first + (way == 0) - (way == 1), y = at.second + (way == 2) - (way == 3);
    // The cells around the new one, one after the other, must change between inside and outside exactly twice.
    const int around[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    int changes = 0;
    for (int k = 0; k < 8; ++k) {
      const int *a = around[k], *b = around[(k + 1) % 8];
      changes += has(x + a[0], y + a[1]) != has(x + b[0], y + b[1]) ? 1 : 0;
    }
    if (changes == 2) cells.insert({x, y});
  }
  std::map<Cell, Cell> next;  // by corner: the next corner of the outline, counterclockwise
  for (const auto& [x, y] : cells) {
    if (!has(x, y - 1)) next[{x, y}] = {x + 1, y};
    if (!has(x + 1, y)) next[{x + 1, y}] = {x + 1, y + 1};
    if (!has(x, y + 1)) next[{x + 1, y + 1}] = {x, y + 1};
    if (!has(x - 1, y)) next[{x, y + 1}] = {x, y};
  }
  Polygon polygon;
  Cell before = next.begin()->first, corner = next[before];
  for (std::size_t i = 0; i < next.size(); ++i) {
    const Cell after = next[corner];
    const bool turns = (corner.first == before.first) != (after.first == corner.first);
    if (turns || random.chance(0.2)) polygon.emplace_back(0.1 * corner.first, 0.1 * corner.second);
    before = corner, corner = after;
  }
  return polygon;
}

Polygon starShaped(Random& random) {
  std::vector<double> angles;
  for (int i = random.between(4, 20); i > 0; --i) angles.push_back(random.uniform(0, 2 * EIGEN_PI));
  std::sort(angles.begin(), angles.end());
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double gap = i > 0 ? angles[i] - angles[i - 1] : angles[0] + 2 * EIGEN_PI - angles.back();
    if (gap > 3.0 || gap < 1e-3) return starShaped(random);  // the center must lie inside
  }
  Polygon polygon;
  for (const double angle : angles) polygon.push_back(random.uniform(0.1, 1) * Point(std::cos(angle), std::sin(angle)));
  return polygon;
}

/// A square with a square hole. Two sides at the same place lead to the hole and back.
Polygon withHole(Random& random) {
  const double low = random.uniform(0.1, 0.4), high = random.uniform(0.5, 0.9);
  return {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {low, low}, {low, high}, {high, high}, {high, low}, {low, low}};
}

/// Returns the polygon from another corner on, in half of all cases in the other direction.
Polygon turned(Polygon polygon, Random& random) {
  const int first = random.below(static_cast<int>(polygon.size()));
  std::rotate(polygon.begin(), polygon.begin() + first, polygon.end());
  if (random.chance(0.5)) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

/// One face in 3D, each polygon at a height of its own.
struct Face {
  Polygon polygon;
  std::vector<Eigen::Vector3d> corners;
};
constexpr double kStep = 3.0;  // between two heights

/// Puts polygon number i into the plane where coordinate `axis` is i * kStep.
std::vector<Face> placed(const std::vector<Polygon>& polygons, int axis) {
  std::vector<Face> faces;
  for (const Polygon& polygon : polygons) {
    Face face{polygon, {}};
    for (const Point& point : polygon) {
      Eigen::Vector3d corner;
      corner[axis] = kStep * static_cast<double>(faces.size());
      corner[(axis + 1) % 3] = point.x();
      corner[(axis + 2) % 3] = point.y();
      face.corners.push_back(corner);
    }
    faces.push_back(face);
  }
  return faces;
}

std::string numbers(const Eigen::Vector3d& v) {
  std::string words;
  for (int axis = 0; axis < 3; ++axis) words += " " + std::to_string(v[axis]);
  return words;
}

std::string obj(const std::vector<Face>& faces) {
  std::string text;
  for (const Face& face : faces) {
    for (const Eigen::Vector3d& corner : face.corners) text += "v" + numbers(corner) + "\n";
    text += "f";
    for (std::size_t i = face.corners.size(); i > 0; --i) text += " -" + std::to_string(i);
    text += "\n";
  }
  return text;
}

/// @param kind  `polylist` or `polygons`
std::string dae(const std::vector<Face>& faces, const std::string& kind) {
  std::string places, sizes, indices;
  std::size_t count = 0;
  for (const Face& face : faces) {
    if (kind == "polygons") indices += "<p>";
    for (const Eigen::Vector3d& corner : face.corners) {
      places += numbers(corner);
      indices += std::to_string(count++) + " ";
    }
    if (kind == "polygons") indices += "</p>";
    sizes += std::to_string(face.corners.size()) + " ";
  }
  if (kind == "polylist") indices = "<vcount>" + sizes + "</vcount><p>" + indices + "</p>";
  const std::string floats = std::to_string(3 * count), vertices = std::to_string(count);
  return "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><library_geometries>"
         "<geometry id='g'><mesh><source id='s'><float_array id='a' count='" +
         floats + "'>" + places + "</float_array><technique_common><accessor source='#a' stride='3' count='" +
         vertices +
         "'><param name='X' type='float'/><param name='Y' type='float'/><param name='Z' type='float'/></accessor>"
         "</technique_common></source><vertices id='v'><input semantic='POSITION' source='#s'/></vertices><" +
         kind + " count='" + std::to_string(faces.size()) + "'><input semantic='VERTEX' source='#v' offset='0'/>" +
         indices + "</" + kind +
         "></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id='w'><node>"
         "<instance_geometry url='#g'/></node></visual_scene></library_visual_scenes>"
         "<scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

using Facet = std::array<Eigen::Vector3d, 3>;

/// Returns the triangles of each of the `count` faces.
std::vector<std::vector<Facet>> facetsOf(const TriangleMesh& mesh, std::size_t count, int axis) {
  std::vector<std::vector<Facet>> triangles(count);
  for (const auto& t : mesh.triangles) {
    const Facet triangle = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    triangles.at(static_cast<std::size_t>(std::lround(triangle[0][axis] / kStep))).push_back(triangle);
  }
  return triangles;
}

Polygon flattened(const Facet& triangle, int axis) {
  Polygon flat;
  for (const Eigen::Vector3d& corner : triangle) flat.emplace_back(corner[(axis + 1) % 3], corner[(axis + 2) % 3]);
  return flat;
}

class PolygonFaces : public ::testing::Test {
 protected:
  std::shared_ptr<const TriangleMesh> load(const std::string& name, const std::string& text) {
    TemporaryFolder folder;
    MeshPolicy policy = meshPolicy();
    policy.resources.file_roots = {folder.path()};
    policy.timeout = policy.total = std::chrono::seconds(60);
    return MeshLoader(policy).load("file://" + folder.write(name, text), {1, 1, 1});
  }

  /// Expects that random points lie in one triangle of their polygon if they are inside, and in none otherwise.
  void expectOwnAreas(const TriangleMesh& mesh, const std::vector<Face>& faces, int axis, Random& random) {
    const auto triangles = facetsOf(mesh, faces.size(), axis);
    for (std::size_t i = 0; i < faces.size(); ++i) {
      SCOPED_TRACE("polygon " + std::to_string(i));
      const Polygon& polygon = faces[i].polygon;
      EXPECT_EQ(triangles[i].size(), polygon.size() - 2);
      double area = 0;
      for (const Facet& triangle : triangles[i]) area += areaOf(flattened(triangle, axis));
      EXPECT_NEAR(area, areaOf(polygon), 1e-5) << "the triangles turn like the polygon";
      Eigen::AlignedBox2d box;
      for (const Point& point : polygon) box.extend(point);
      int wrong = 0;
      for (int sample = 0; sample < 60; ++sample) {
        const Point p(random.uniform(box.min().x(), box.max().x()), random.uniform(box.min().y(), box.max().y()));
        int covered = 0;
        for (const Facet& triangle : triangles[i]) covered += isInside(flattened(triangle, axis), p) ? 1 : 0;
        wrong += covered != (isInside(polygon, p) ? 1 : 0) ? 1 : 0;
      }
      EXPECT_EQ(wrong, 0) << "of 60 points, corners " << polygon.size();
    }
  }

  void expectOwnAreasInEveryFormat(Polygon (*make)(Random&), std::uint64_t seed) {
    Random random(seed);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Polygon> polygons;
      for (int i = 0; i < 80; ++i) polygons.push_back(turned(make(random), random));
      const std::vector<Face> faces = placed(polygons, axis);
      for (const std::string kind : {"obj", "polylist", "polygons"}) {
        SCOPED_TRACE(kind);
        const auto mesh = kind == "obj" ? load("a.obj", obj(faces)) : load("a.dae", dae(faces, kind));
        expectOwnAreas(*mesh, faces, axis, random);
      }
    }
  }
};

TEST_F(PolygonFaces, RightAngledOnesCoverTheirOwnArea) { expectOwnAreasInEveryFormat(rightAngled, 1); }
TEST_F(PolygonFaces, StarShapedOnesCoverTheirOwnArea) { expectOwnAreasInEveryFormat(starShaped, 2); }
TEST_F(PolygonFaces, WithAHoleThatTwoSidesLeadToCoverTheirOwnArea) { expectOwnAreasInEveryFormat(withHole, 3); }

/// Claim: a sphere in the notch of an L, 0.15 m from everything, is apart from it, whichever corner is the first one.
TEST_F(PolygonFaces, LeaveTheNotchOfAnLOpen) {
  const Polygon outline = {{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}};
  const auto narrow = makeCoreNarrowPhase();
  const auto sphere = narrow->point();
  for (int first = 0; first < 6; ++first) {
    Polygon base = outline;
    std::rotate(base.begin(), base.begin() + first, base.end());
    std::vector<Face> faces;
    Face bottom{{}, {}}, top{{}, {}};
    for (std::size_t i = 0; i < 6; ++i) {
      const Point a = base[i], b = base[(i + 1) % 6];
      bottom.corners.insert(bottom.corners.begin(), {a.x(), a.y(), 0});
      top.corners.emplace_back(a.x(), a.y(), 1);
      faces.push_back({{}, {{a.x(), a.y(), 0}, {b.x(), b.y(), 0}, {b.x(), b.y(), 1}, {a.x(), a.y(), 1}}});
    }
    faces.insert(faces.end(), {bottom, top});
    for (const auto& mesh : {load("l.obj", obj(faces)), load("l.dae", dae(faces, "polylist"))}) {
      const auto solid = narrow->solidOf(Shape::mesh(mesh));
      const Pose identity = Pose::Identity();
      Pose place = Pose::Identity();
      place.translation() = Eigen::Vector3d(0.75, 0.75, 1.0);
      const Proximity notch = narrow->measure({*solid, identity, 0}, {*sphere, place, 0.1}, 1.0);
      EXPECT_EQ(notch.status, Measure::apart) << first;
      EXPECT_NEAR(notch.distance, 0.15, 1e-6) << first;
      place.translation() = Eigen::Vector3d(0.25, 0.25, 0.5);
      EXPECT_TRUE(isContact(narrow->measure({*solid, identity, 0}, {*sphere, place, 0}, 1.0).status)) << first;
    }
  }
}

/// Returns the height of the plane through three places above a point of the x-y plane; -infinity if the triangle of
/// the places is not above the point.
double heightAt(const Point& p, const Facet& t) {
  Eigen::Matrix3d corners;
  corners << t[0].x(), t[1].x(), t[2].x(), t[0].y(), t[1].y(), t[2].y(), 1, 1, 1;
  if (std::abs(corners.determinant()) < 1e-9) return -std::numeric_limits<double>::infinity();
  const Eigen::Vector3d parts = corners.inverse() * Eigen::Vector3d(p.x(), p.y(), 1);
  if (parts.minCoeff() < 0) return -std::numeric_limits<double>::infinity();
  return parts.x() * t[0].z() + parts.y() * t[1].z() + parts.z() * t[2].z();
}

/// Claim: a convex polygon that is not flat becomes the surface that encloses most. Its oracle is the highest triangle
/// of any three corners above each point.
TEST_F(PolygonFaces, ThatAreNotFlatEncloseAllThatAnyTrianglesDo) {
  Random random(4);
  std::vector<Face> faces(40);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const int count = random.between(4, 8);
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * EIGEN_PI * (k + random.uniform(0.1, 0.9)) / count;
      const double height = kStep * static_cast<double>(i) + random.uniform(-0.1, 0.1);
      faces[i].corners.emplace_back(std::cos(angle), std::sin(angle), height);
    }
  }
  const auto triangles = facetsOf(*load("a.obj", obj(faces)), faces.size(), 2);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::vector<Eigen::Vector3d>& corners = faces[i].corners;
    ASSERT_EQ(triangles[i].size(), corners.size() - 2);
    for (int sample = 0; sample < 30; ++sample) {
      const Point p(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
      double own = -1.0, highest = -1.0;
      for (const Facet& triangle : triangles[i]) own = std::max(own, heightAt(p, triangle));
      for (std::size_t a = 0; a < corners.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          for (std::size_t c = 0; c < b; ++c) {
            highest = std::max(highest, heightAt(p, {corners[a], corners[b], corners[c]}));
          }
        }
      }
      EXPECT_NEAR(own, highest, 1e-4) << corners.size() << " corners";
    }
  }
}

/// Claim: a face whose sides cross each other is covered wherever it winds around a point, also around the lobe that
/// turns the other way.
TEST_F(PolygonFaces, WhoseSidesCrossCoverAllTheirLobes) {
  Random random(5);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Polygon> polygons = {{{0, 0}, {1, 0}, {0, 1}, {1, 1}}};  // two lobes of the same size
    while (polygons.size() < 50) {
      polygons.emplace_back();
      for (int k = random.between(4, 8); k > 0; --k) {
        polygons.back().emplace_back(random.uniform(0, 1), random.uniform(0, 1));
      }
    }
    const auto triangles = facetsOf(*load("a.obj", obj(placed(polygons, axis))), polygons.size(), axis);
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      for (int sample = 0; sample < 100; ++sample) {
        const Point p(random.uniform(0, 1), random.uniform(0, 1));
        const bool covered = std::any_of(triangles[i].begin(), triangles[i].end(),
                                         [&](const Facet& triangle) { return isInside(flattened(triangle, axis), p); });
        EXPECT_TRUE(covered || !isInside(polygons[i], p)) << i;
      }
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
