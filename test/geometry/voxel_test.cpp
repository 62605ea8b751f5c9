// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/geometry/voxel.h"

#include <gtest/gtest.h>

#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

TEST(Voxel, TheMortonCodeInterleavesTheBitsWithXLowest) {
  EXPECT_EQ(mortonOf({0xffff, 0, 0, 0}), 0x249249249249u);
  EXPECT_EQ(mortonOf({0, 0xffff, 0, 0}), 0x492492492492u);
  EXPECT_EQ(mortonOf({0, 0, 0xffff, 0}), 0x924924924924u);
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t bits = random.bits();
    const Voxel voxel{std::uint16_t(bits), std::uint16_t(bits >> 16), std::uint16_t(bits >> 32), 0};
    std::uint64_t slowly = 0;
    for (int bit = 0; bit < 16; ++bit) {
      slowly |= std::uint64_t(voxel.x >> bit & 1) << 3 * bit | std::uint64_t(voxel.y >> bit & 1) << (3 * bit + 1) |
                std::uint64_t(voxel.z >> bit & 1) << (3 * bit + 2);
    }
    ASSERT_EQ(mortonOf(voxel), slowly) << voxel.x << " " << voxel.y << " " << voxel.z;
  }
}

TEST(Voxel, CornersReachFromOneEndOfTheKeysToTheOtherWithoutWrapping) {
  const Voxel whole{0, 0, 0, 16}, last{65535, 65535, 65535, 0}, origin{32768, 32768, 32768, 0};
  EXPECT_EQ(minCorner(whole, 0.5), Eigen::Vector3d::Constant(-16384.0));
  EXPECT_EQ(maxCorner(whole, 0.5), Eigen::Vector3d::Constant(16384.0));
  EXPECT_EQ(edgeOf(whole, 0.5), 32768.0);
  EXPECT_EQ(maxCorner(last, 0.5), maxCorner(whole, 0.5));
  EXPECT_EQ(minCorner(origin, 0.5), Eigen::Vector3d::Zero());
  EXPECT_EQ(edgeOf(origin, 0.05), 0.05) << "the edge must be computed from the level; the corners are rounded";
  EXPECT_NE(origin, (Voxel{32768, 32768, 32768, 1}));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
