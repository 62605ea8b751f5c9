// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hgrid_proximity/adapters/octomap.h"
#include "test/adapters/octomap_bytes.h"
#include "test/adapters/octomap_judge.h"
#include "test/adapters/octomap_oracle.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

const OctomapFormat kBinary{"OcTree", true, 0.5}, kFull{"OcTree", false, 0.5};
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Octomap read(const OctomapFormat& format, const std::string& data, const OctomapOptions& options) {
  return readOctomapData(format, data, "map 'm'", options);
}

std::uint64_t countTouching(const std::vector<Voxel>& voxels, const Eigen::AlignedBox3d& box, double resolution) {
  return static_cast<std::uint64_t>(std::count_if(voxels.begin(), voxels.end(), [&](const Voxel& voxel) {
    return box.intersects(Eigen::AlignedBox3d(minCorner(voxel, resolution), maxCorner(voxel, resolution)));
  }));
}

TEST(OctomapOptions, ACropKeepsWhatTouchesIt) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const WrittenMap written = randomMap(random, "OcTree", true);
    OctomapOptions options;
    options.keep_free = random.chance(0.5);
    const Octomap all = read(written.format, written.data, options);
    const Voxel& some = all.occupied.empty() ? Voxel{} : all.occupied[all.occupied.size() / 2];
    const Eigen::Vector3d corner = minCorner(some, all.resolution);  // then some faces touch the crop box exactly
    const double side = all.resolution * random.below(100);
    options.crop = Eigen::AlignedBox3d(corner, corner + Eigen::Vector3d::Constant(side));
    if (random.chance(0.3)) options.crop->max().x() = kInfinity;
    const Octomap cropped = read(written.format, written.data, options);
    EXPECT_EQ(cropped.occupied.size(), countTouching(all.occupied, *options.crop, all.resolution));
    EXPECT_EQ(cropped.free.size(), countTouching(all.free, *options.crop, all.resolution));
    EXPECT_EQ(cropped.cropped, all.occupied.size() + all.free.size() - cropped.occupied.size() - cropped.free.size());
    EXPECT_EQ(cropped.nodes, all.nodes);
    EXPECT_EQ(flawOf(cropped, options), "");
    for (const Voxel& voxel : cropped.occupied) {
      EXPECT_EQ(countTouching({voxel}, *options.crop, all.resolution), 1u);
    }
    if (HasFailure()) return;
  }
}

TEST(OctomapOptions, ACropReachesToTheEndsOfTheKeysAndBeyond) {
  const std::string corners = btNode("o......o");
  const auto kept = [&](double low, double high) {
    OctomapOptions options;
    options.crop = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(low), Eigen::Vector3d::Constant(high));
    return read(kBinary, corners, options).occupied.size();
  };
  EXPECT_EQ(kept(-kInfinity, kInfinity), 2u);
  EXPECT_EQ(kept(-1e9, 1e9), 2u);
  EXPECT_EQ(kept(0.0, 0.0), 2u) << "both voxels touch the origin";
  EXPECT_EQ(kept(1e-9, 1.0), 1u);
  EXPECT_EQ(kept(16384.0, 1e9), 1u);
  EXPECT_EQ(kept(16384.0001, 1e9), 0u);
  EXPECT_EQ(kept(-1e9, -16384.0), 1u);
  EXPECT_EQ(kept(-1e9, -16384.0001), 0u);
}

TEST(OctomapOptions, CroppedLeavesDoNotCountAsKept) {
  OctomapOptions options;
  options.max_leaves = 1;
  options.crop = Eigen::AlignedBox3d(Eigen::Vector3d::Constant(1.0), Eigen::Vector3d::Constant(2.0));
  EXPECT_EQ(read(kBinary, btNode("o......o"), options).cropped, 1u);
}

TEST(OctomapOptions, ACropIsABoxWithoutNan) {
  std::string sentence;
  OctomapOptions options;
  options.crop = Eigen::AlignedBox3d(Eigen::Vector3d(0, 2, 0), Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(refusalOf([&] { read(kBinary, btNode("o"), options); }, &sentence), Code::out_of_range);
  EXPECT_TRUE(says(sentence, "y from 2 to 1"));
  options.crop = Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, NAN), Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(refusalOf([&] { read(kBinary, btNode("o"), options); }, &sentence), Code::nonfinite);
  EXPECT_TRUE(says(sentence, "z from nan"));
}

TEST(OctomapOptions, NanIsRefusedOrOccupied) {
  const std::string data = otNode(NAN, 3) + otNode(NAN) + otNode(-1.0f);  // the NaN of a parent node is ignored
  std::string sentence;
  OctomapOptions options;
  EXPECT_EQ(refusalOf([&] { read(kFull, data, options); }, &sentence), Code::parse);
  EXPECT_TRUE(says(sentence, "nan"));
  options.nan_is_occupied = true;
  const Octomap map = read(kFull, data, options);
  EXPECT_EQ(map.occupied, (std::vector<Voxel>{{0, 0, 0, 15}}));
  EXPECT_EQ(map.nan_leaves, 1u);
  EXPECT_EQ(map.free_leaves, 1u);
}

TEST(OctomapOptions, UnknownSpaceCanBeOccupied) {
  OctomapOptions options;
  options.unknown = UnknownSpace::occupied;
  options.keep_free = true;
  const Octomap map = read(kBinary, btNode("of.....n") + btNode("fffffff."), options);
  EXPECT_EQ(map.unknown_leaves, 6u);
  EXPECT_EQ(map.occupied.size(), 7u);
  EXPECT_EQ(map.occupied.back(), (Voxel{0xc000, 0xc000, 0xc000, 14}));
  EXPECT_EQ(map.free.size(), 8u);
  EXPECT_EQ(map.nodes, 11u);
  std::uint64_t covered = 0;
  for (const auto* voxels : {&map.occupied, &map.free}) {
    for (const Voxel& voxel : *voxels) covered += std::uint64_t{1} << 3 * voxel.level;
  }
  EXPECT_EQ(covered, std::uint64_t{1} << 48) << "all space must be occupied or free";
  const Octomap full = read(kFull, otNode(0.0f, 1) + otNode(-1.0f), options);
  EXPECT_EQ(full.unknown_leaves, 7u);
  EXPECT_EQ(full.occupied.front(), (Voxel{32768, 0, 0, 15}));
}

TEST(OctomapOptions, UnknownSpaceCanBeKeptSeparately) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const WrittenMap written = randomMap(random, "OcTree", random.chance(0.5));
    OctomapOptions options;
    options.keep_free = true;
    const Octomap without = read(written.format, written.data, options);
    options.unknown = UnknownSpace::report;
    const Octomap with = read(written.format, written.data, options);
    EXPECT_TRUE(without.unknown.empty());
    EXPECT_TRUE(with.occupied == without.occupied);
    EXPECT_TRUE(with.free == without.free);
    EXPECT_EQ(with.unknown_leaves, with.unknown.size());
    std::uint64_t covered = 0;
    std::vector<Voxel> all;
    for (const auto* voxels : {&with.occupied, &with.free, &with.unknown}) {
      for (const Voxel& voxel : *voxels) covered += std::uint64_t{1} << 3 * voxel.level;
      all.insert(all.end(), voxels->begin(), voxels->end());
    }
    EXPECT_EQ(covered, std::uint64_t{1} << 48) << "all space must be occupied, free or unknown";
    std::sort(all.begin(), all.end(), [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
    for (std::size_t i = 1; i < all.size(); ++i) {
      ASSERT_GE(mortonOf(all[i]), mortonOf(all[i - 1]) + (std::uint64_t{1} << 3 * all[i - 1].level))
          << "two voxels overlap";
    }
  }
}

TEST(OctomapOptions, AnEmptyMapIsUnknownAllOver) {
  OctomapOptions options;
  options.unknown = UnknownSpace::occupied;
  options.allow_empty = true;
  for (const OctomapFormat& format : {kBinary, kFull}) {
    const Octomap map = read(format, "", options);
    EXPECT_EQ(map.occupied, (std::vector<Voxel>{{0, 0, 0, 16}}));
    EXPECT_EQ(map.unknown_leaves, 1u);
    EXPECT_EQ(map.nodes, 0u);
  }
}

TEST(OctomapOptions, TheThresholdIsAProbabilityAndItselfOccupied) {
  OctomapOptions options;
  EXPECT_EQ(read(kFull, otNode(-0.0f), options).occupied.size(), 1u);
  EXPECT_EQ(read(kFull, otNode(-1e-30f), options).occupied.size(), 0u);
  options.occupied_from = 0.7;
  const auto threshold = static_cast<float>(std::log(0.7 / 0.3));
  EXPECT_EQ(read(kFull, otNode(threshold), options).occupied.size(), 1u);
  EXPECT_EQ(read(kFull, otNode(std::nextafter(threshold, 0.0f)), options).occupied.size(), 0u);
  EXPECT_EQ(read(kBinary, btNode("o"), options).occupied.size(), 1u)
      << "the threshold is only used for maps with probabilities";
  for (const double bad : {0.0, 1.0, -0.1, 1.1, double(NAN)}) {
    std::string sentence;
    options.occupied_from = bad;
    EXPECT_EQ(refusalOf([&] { read(kFull, otNode(0.0f), options); }, &sentence), Code::out_of_range);
    EXPECT_TRUE(says(sentence, text(bad)));
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
