// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares StaticGrid with a scan of all voxels in extended precision, for many kinds of maps.
#include "hgrid_proximity/maps/static_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "test/maps/random_maps.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

/// Checks that `found` contains all voxels that are surely at most `within` [m] from the box. It must not contain a
/// voxel that is surely farther away.
void expectRight(const Map& map, const std::vector<Voxel>& found, const Eigen::AlignedBox3d& box, double within) {
  std::vector<Voxel> surely, perhaps;
  for (const Voxel& voxel : map.voxels) {
    const Real distance = distanceOf(map, voxel, box);
    if (distance <= within) surely.push_back(voxel);
    if (distance <= within + slack(box, within)) perhaps.push_back(voxel);
  }
  const auto before = [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); };
  ASSERT_TRUE(std::is_sorted(found.begin(), found.end(), before));
  ASSERT_TRUE(std::includes(found.begin(), found.end(), surely.begin(), surely.end(), before))
      << "a voxel within the distance is missing";
  ASSERT_TRUE(std::includes(perhaps.begin(), perhaps.end(), found.begin(), found.end(), before))
      << "a voxel beyond the distance was found";
}

class StaticGridOracle : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Map map_ = maps()[GetParam()];
  const StaticGrid grid_{map_.edge, map_.voxels};
  Random random_{GetParam() + 1};
};

INSTANTIATE_TEST_SUITE_P(Maps, StaticGridOracle, ::testing::Range<std::size_t>(0, maps().size()),
                         [](const auto& info) { return testName(maps()[info.param]); });

TEST_P(StaticGridOracle, HasTheVoxelsThatItWasMadeOf) {
  EXPECT_EQ(grid_.size(), map_.voxels.size());
  EXPECT_EQ(grid_.voxels(), map_.voxels);
  for (const Voxel& voxel : map_.voxels) {
    ASSERT_TRUE(grid_.bounds().contains(minCorner(voxel, map_.edge)));
    ASSERT_TRUE(grid_.bounds().contains(maxCorner(voxel, map_.edge)));
  }
  EXPECT_EQ(grid_.bounds().isEmpty(), map_.voxels.empty());
}

TEST_P(StaticGridOracle, FindsWhatBoxesAndBallsTouch) {
  std::vector<Voxel> found, fewer;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d at = somewhere(map_, random_);
    Eigen::AlignedBox3d box(at);
    if (random_.chance(0.8)) box.extend(somewhere(map_, random_));
    ASSERT_TRUE(grid_.overlapping(box, 1000000, found));
    ASSERT_NO_FATAL_FAILURE(expectRight(map_, found, box, 0.0));
    if (!found.empty()) {
      EXPECT_FALSE(grid_.overlapping(box, found.size() - 1, fewer));
      EXPECT_EQ(fewer.size(), found.size() - 1);
    }
    const Sphere sphere{at, length(map_, random_)};
    ASSERT_TRUE(grid_.overlapping(sphere, 1000000, found));
    ASSERT_NO_FATAL_FAILURE(expectRight(map_, found, Eigen::AlignedBox3d(at), sphere.radius));
    ASSERT_EQ(grid_.touches(sphere), !found.empty());
  }
}

TEST_P(StaticGridOracle, FindsTheNearest) {
  std::vector<NearVoxel> found;
  for (int i = 0; i < 300; ++i) {
    Eigen::AlignedBox3d box(somewhere(map_, random_));
    if (random_.chance(0.5)) box.extend(somewhere(map_, random_));
    const auto count = static_cast<std::size_t>(random_.between(1, 10));
    const double limit = random_.chance(0.5) ? std::numeric_limits<double>::infinity() : length(map_, random_);
    grid_.nearest(box, count, limit, found);
    std::vector<Real> distances;
    for (const Voxel& voxel : map_.voxels) distances.push_back(distanceOf(map_, voxel, box));
    std::sort(distances.begin(), distances.end());
    const double rounding = slack(box, 0.0);
    for (std::size_t k = 0; k < std::min(count, distances.size()); ++k) {
      if (distances[k] > limit + rounding) break;
      if (k >= found.size()) {
        ASSERT_GT(distances[k], std::max(0.0, limit - rounding)) << "a voxel is missing";
        break;
      }
      ASSERT_NEAR(found[k].distance, static_cast<double>(distances[k]), rounding);
      ASSERT_NEAR(static_cast<double>(distanceOf(map_, found[k].voxel, box)), found[k].distance, rounding);
    }
    ASSERT_LE(found.size(), std::min(count, map_.voxels.size()));
    for (std::size_t k = 1; k < found.size(); ++k) ASSERT_FALSE(found[k].voxel == found[k - 1].voxel);
  }
}

/// Returns where a sphere that moves along a segment first touches a voxel, as a fraction of the segment; empty if it
/// never does. Searches by nested intervals, because the distance is a convex function along a line.
std::optional<Real> touchOf(const Map& map, const Voxel& voxel, const Segment& segment, Real radius) {
  const auto distanceAt = [&](Real share) {
    const Eigen::Vector3d min = minCorner(voxel, map.edge), max = maxCorner(voxel, map.edge);
    Real sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Real at = Real(segment.from[axis]) + share * (Real(segment.to[axis]) - Real(segment.from[axis]));
      const Real gap = std::max({Real(0), Real(min[axis]) - at, at - Real(max[axis])});
      sum += gap * gap;
    }
    return std::sqrt(sum);
  };
  Real low = 0, high = 1;
  for (int i = 0; i < 120; ++i) {
    const Real a = low + (high - low) / 3, b = high - (high - low) / 3;
    const Real at_a = distanceAt(a), at_b = distanceAt(b);
    if (at_a <= radius || at_a <= at_b) {
      high = b;
      if (at_a <= radius) high = a;
    } else {
      low = a;
    }
    if (distanceAt(high) <= radius) break;
  }
  if (distanceAt(high) > radius) return std::nullopt;
  for (Real outside = 0; distanceAt(0) > radius;) {
    const Real middle = (outside + high) / 2;
    if (middle == outside || middle == high) return high;
    (distanceAt(middle) <= radius ? high : outside) = middle;
  }
  return Real(0);
}

TEST_P(StaticGridOracle, FindsWhatASegmentTouchesFirst) {
  std::size_t hits = 0;
  for (int i = 0; i < 200; ++i) {
    Segment segment{somewhere(map_, random_), somewhere(map_, random_), 0.0};
    if (random_.chance(0.3)) segment.radius = length(map_, random_);
    if (random_.chance(0.2)) segment.to = segment.from;
    if (random_.chance(0.3)) segment.to[random_.below(3)] = segment.from[1];  // along borders of voxels
    const Eigen::AlignedBox3d around = Eigen::AlignedBox3d(segment.from).extend(segment.to);
    const double rounding = slack(around, segment.radius), whole = (segment.to - segment.from).norm();
    std::optional<Real> surely, perhaps;
    for (const Voxel& voxel : map_.voxels) {
      if (distanceOf(map_, voxel, around) > segment.radius + rounding) continue;
      if (const auto at = touchOf(map_, voxel, segment, segment.radius)) surely = std::min(surely.value_or(2), *at);
      if (const auto at = touchOf(map_, voxel, segment, segment.radius + rounding)) {
        perhaps = std::min(perhaps.value_or(2), *at);
      }
    }
    const auto found = grid_.firstAlong(segment);
    ASSERT_TRUE(found || !surely) << "the segment surely touches a voxel, but none was found";
    if (!found) continue;
    ++hits;
    ASSERT_TRUE(perhaps) << "a voxel was found, but the segment surely touches none";
    ASSERT_LE(found->along, static_cast<double>(surely.value_or(1)) * whole + rounding);
    ASSERT_GE(found->along, static_cast<double>(*perhaps) * whole - rounding);
    const Eigen::Vector3d at = segment.from + (whole > 0.0 ? found->along / whole : 0.0) * (segment.to - segment.from);
    ASSERT_LE(static_cast<double>(distanceOf(map_, found->voxel, Eigen::AlignedBox3d(at))),
              segment.radius + 10.0 * rounding);
  }
  if (!map_.voxels.empty()) {
    EXPECT_GT(hits, 10u);
  }
}

/// Returns a segment for which rounding is critical. Its ends are on planes, edges and corners of cells, far away from
/// the map, or very close to each other.
Segment hardSegment(const Map& map, Random& random) {
  Segment segment{somewhere(map, random), somewhere(map, random), 0.0};
  const int kind = random.below(8);
  if (kind == 0) segment.to = segment.from + std::ldexp(map.edge, random.below(12)) * Eigen::Vector3d::Ones();
  if (kind == 1) segment.from -= 1e4 * (segment.to - segment.from);
  if (kind == 2) segment.to = segment.from + 1e-13 * (segment.to - segment.from);
  if (kind <= 4) segment.to[random.below(3)] = segment.from[random.below(3)];
  if (kind == 5) segment.to[0] = segment.from[0], segment.to[2] = segment.from[2];
  if (random.chance(0.5)) std::swap(segment.from, segment.to);
  if (random.chance(0.2)) segment.radius = length(map, random);
  return segment;
}

TEST_P(StaticGridOracle, LeavesNoVoxelOutAlongASegment) {
  const int count = std::max(100, countFromEnvironment("HGRID_TEST_WORLDS", 10000) / 10);
  std::vector<Aabb> boxes;  // the voxels as boxes, in units of the edge of the smallest voxel
  for (const Voxel& voxel : map_.voxels) {
    const auto key = [](std::uint16_t at) { return static_cast<float>(at - Voxel::kOriginKey); };
    const Eigen::Vector3f min(key(voxel.x), key(voxel.y), key(voxel.z));
    boxes.push_back({min, min + Eigen::Vector3f::Constant(static_cast<float>(keysAlong(voxel)))});
  }
  for (int i = 0; i < count; ++i) {
    const Segment segment = hardSegment(map_, random_);
    const Segment in_keys{segment.from / map_.edge, segment.to / map_.edge, segment.radius / map_.edge};
    const double length = (in_keys.to - in_keys.from).norm();
    std::optional<double> share;
    for (const Aabb& box : boxes) {
      const auto along = FirstTouch(in_keys)(box);
      if (along) share = std::min(share.value_or(1e9), length > 0.0 ? *along / length : 0.0);
    }
    const auto found = grid_.firstAlong(segment);
    ASSERT_EQ(found.has_value(), share.has_value()) << "segment " << i;
    if (found) {
      ASSERT_EQ(found->along, *share * (segment.to - segment.from).norm()) << "segment " << i;
    }
  }
}

TEST(StaticGrid, RefusesVoxelsThatAreNotAsSaid) {
  const auto expectRefusal = [](Code code, const std::string& words, double edge, const std::vector<Voxel>& voxels) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { StaticGrid(edge, voxels); }, &sentence), code);
    EXPECT_TRUE(says(sentence, words));
  };
  expectRefusal(Code::bad_geometry, "voxel 0 (keys 1, 0, 0, level 1) is not valid; keys must be multiples of the edge",
                0.1, {{1, 0, 0, 1}});
  expectRefusal(Code::bad_geometry, "voxel 0 (keys 0, 0, 0, level 17)", 0.1, {{0, 0, 0, 17}});
  const std::vector<Voxel> twice{{0, 0, 0, 0}, {0, 0, 0, 0}}, back{{1, 0, 0, 0}, {0, 0, 0, 0}},
      inside{{0, 0, 0, 1}, {1, 1, 1, 0}};
  for (const auto& voxels : {twice, back, inside}) {
    expectRefusal(Code::bad_geometry, "begins before the previous voxel ends; voxels must be disjoint", 0.1, voxels);
  }
  for (const double edge : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    expectRefusal(Code::out_of_range, "m; it must be greater than 0", edge, {});
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
