// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/refusal.h"
#include "test/adapters/mutation.h"
#include "test/adapters/octomap_judge.h"
#include "test/adapters/octomap_oracle.h"
#include "test/fuzz/seeds.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

const std::vector<std::string> kWords = {"size ",
                                         "res ",
                                         "id ",
                                         "data\n",
                                         "-1",
                                         "nan",
                                         "1e30",
                                         "ColorOcTree",
                                         "\r\n",
                                         "\xff\xff",
                                         "\xaa\xaa",
                                         "\x55\x55",
                                         std::string("\0\0\xc0\x7f", 4),
                                         std::string("\0\0", 2)};

TEST(OctomapMutation, ADamagedMapIsValidOrRefused) {
  int read_anyway = 0;
  const int count = countFromEnvironment("HGRID_TEST_MUTATIONS", 4000);
  for (int seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(static_cast<std::uint64_t>(seed));
    const WrittenMap map = randomMap(random, random.chance(0.5) ? "OcTree" : "ColorOcTree", random.chance(0.5));
    OctomapOptions options;
    options.nan_is_occupied = random.chance(0.5);
    options.keep_free = random.chance(0.5);
    options.unknown = static_cast<UnknownSpace>(random.chance(0.4) ? random.below(3) : 0);
    options.max_leaves = random.chance(0.1) ? 100 : 1000000;
    try {
      const Octomap read = random.chance(0.5)
                               ? readOctomap(mutated(map.file, kWords, random), "map", options)
                               : readOctomapData(map.format, mutated(map.data, kWords, random), "map", options);
      ++read_anyway;
      ASSERT_EQ(flawOf(read, options), "");
    } catch (const Refusal& refusal) {
      ASSERT_NE(refusal.code(), Code::ok);
      ASSERT_STRNE(refusal.what(), "");
    }
  }
  EXPECT_GT(read_anyway, count / 50) << "the damage is too strong: too few maps can be read";
  EXPECT_LT(read_anyway, count) << "the damage is too weak: all maps can be read";
}

TEST(OctomapMutation, TheSeedsOfTheFuzzerAreReadCorrectly) { expectNoFlawInSeeds("octomap", fuzzOctomap); }

}  // namespace
}  // namespace test
}  // namespace hgrid
