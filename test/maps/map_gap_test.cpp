// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "maps/map_gap.h"

#include <gtest/gtest.h>

#include "test/support/maps.h"

namespace hgrid {
namespace test {
namespace {

/// Claim: the gap of a box and a cell is never larger than it really is, however far the cell is. A gap that is larger
/// by a rounding error than a margin would hide a pair whose gap equals the margin.
TEST(MapGap, IsNeverTooLarge) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const double edge = random.uniform(0.01, 0.3);
    const int cells = random.between(2, 30000);
    const auto key = static_cast<std::uint16_t>(Voxel::kOriginKey + cells);
    const StaticGrid grid(edge, {{key, Voxel::kOriginKey, Voxel::kOriginKey, 0}});
    const auto half = static_cast<float>(random.uniform(0.001, 0.01));
    const Aabb box{Eigen::Vector3f::Constant(-half), Eigen::Vector3f::Constant(half)};
    const double margin = static_cast<double>(static_cast<long double>(cells) * edge - half);  // the gap, rounded
    const double gap = gapTo(grid, boxInMap(Pose::Identity(), box, Eigen::Vector3d::Zero()), margin);
    EXPECT_LE(gap, margin) << cells << " cells of " << edge << " m";
    EXPECT_NEAR(gap, margin, 1e-13 * margin);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
