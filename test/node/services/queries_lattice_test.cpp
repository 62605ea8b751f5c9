// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <array>
#include <set>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using Point = std::array<double, 3>;

/// A lattice of 5 x 5 x 5 places for boxes of 1 m, whose corners have integer coordinates from -2 to 3. Like on a
/// checkerboard, every second place is empty. The cells of the grid are also 1 m long. Therefore a segment along faces
/// of cells is also along faces of boxes.
class QueryLattice : public ::testing::Test {
 protected:
  static bool filled(int x, int y, int z) { return (x + y + z) % 2 == 0; }
  static std::string nameOf(int x, int y, int z) {
    return "box_" + std::to_string(x) + "_" + std::to_string(y) + "_" + std::to_string(z);
  }
  template <class Function>
  static void forEachBox(Function&& function) {
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = -2; z <= 2; ++z) {
          if (filled(x, y, z)) function(x, y, z);
        }
      }
    }
  }
  static NodeSetup setup() {
    Value obstacles = list();
    forEachBox([&](int x, int y, int z) {
      obstacles[obstacles.size()] = box(nameOf(x, y, z), xyz(x + 0.5, y + 0.5, z + 0.5), xyz(1, 1, 1));
    });
    NodeSetup setup;
    setup.params = dict({{"world_frame", "base"}, {"margin", 0.0}, {"obstacles", obstacles}});
    setup.params["accept_uncovered"] = list({waiver("robot/*", "there is no robot")});
    setup.beside["robot_description"] = urdf(link("base"));
    return setup;
  }
  /// Returns whether the segment touches the closed box [low, low + 1]^3. The result is exact, because all coordinates
  /// are small multiples of 1/4.
  static bool meets(const Point& from, const Point& to, const Point& low) {
    double enter = 0.0, leave = 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double way = to[axis] - from[axis];
      if (way == 0.0) {
        if (from[axis] < low[axis] || from[axis] > low[axis] + 1.0) return false;
        continue;
      }
      const double one = (low[axis] - from[axis]) / way, other = (low[axis] + 1.0 - from[axis]) / way;
      enter = std::max(enter, std::min(one, other));
      leave = std::min(leave, std::max(one, other));
    }
    return enter <= leave;
  }
};

TEST_F(QueryLattice, ASegmentAlongFacesEdgesAndThroughCornersMissesNothing) {
  NodeUnderTest node(setup());
  node.waitForComplete();
  const std::vector<std::pair<Point, Point>> segments = {
      {{-4, 0.5, 0.5}, {4, 0.5, 0.5}},   // along an axis
      {{4, 0.5, 0.5}, {-4, 0.5, 0.5}},   // the same in the other direction
      {{-4, 1, 0.5}, {4, 1, 0.5}},       // on a face
      {{-4, -0.0, 0.5}, {4, 0.0, 0.5}},  // on the face at 0, with both zeros
      {{-4, 1, -1}, {4, 1, -1}},         // on an edge
      {{0.5, 3, -4}, {0.5, 3, 4}},       // on an outer face of the outermost boxes
      {{-4, -4, -4}, {4, 4, 4}},         // through corners
      {{4, -4, 4}, {-4, 4, -4}},         // through corners, in other directions
      {{-4, -4, 1}, {4, 4, 1}},          // diagonally on a face
      {{-4, 0, 0}, {4, 2, 1}},           // oblique, through points with integer coordinates
      {{0, 0, 0}, {0, 0, 0}},            // a point in the common corner of eight cells
      {{-1, 2, 0.25}, {-1, 2, 0.25}},    // a point on an edge
      {{3, 3, 3}, {4, 4, 4}},            // begins in the last corner and leads away from all boxes
  };
  for (const auto& ends : segments) {
    const Point &from = ends.first, &to = ends.second;
    SCOPED_TRACE(::testing::PrintToString(ends));
    const auto answer = node.segment(xyz(from[0], from[1], from[2]), xyz(to[0], to[1], to[2]), 0.0).answer;
    std::set<std::string> met, expected;
    double along = 0.0;
    for (const msg::Hit& hit : answer.hits) {
      EXPECT_TRUE(met.insert(hit.name).second) << hit.name << " is listed twice";
      EXPECT_GE(hit.along, along);
      along = hit.along;
    }
    forEachBox([&](int x, int y, int z) {
      const Point low = {double(x), double(y), double(z)};
      if (meets(from, to, low)) expected.insert("obstacle/" + nameOf(x, y, z));
    });
    for (const std::string& name : expected) EXPECT_EQ(met.count(name), 1u) << name << " is missed";
    EXPECT_EQ(met.size(), answer.total);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
