// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/adapters/octomap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "test/adapters/octomap_bytes.h"
#include "test/adapters/octomap_judge.h"
#include "test/adapters/octomap_oracle.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

OctomapOptions keepingFree() {
  OctomapOptions options;
  options.keep_free = true;
  return options;
}

/// Expects the leaves that the OctoMap library reads, in the order of a depth-first walk.
void expectSame(const Octomap& map, const JudgedMap& truth) {
  EXPECT_EQ(map.nodes, truth.nodes);
  EXPECT_EQ(map.occupied.size(), truth.occupied.size());
  EXPECT_EQ(map.free_leaves, truth.free.size());
  EXPECT_TRUE(map.occupied == truth.occupied);
  EXPECT_TRUE(map.free == truth.free);
}

/// Returns the `.bt` nodes of a random subtree whose first node is at this depth. The tree is at most 16 levels deep.
/// @param chance  probability that a child has children
std::string randomBinaryNodes(Random& random, double chance, int depth = 0) {
  std::string kinds(8, '.'), below;
  for (char& kind : kinds) {
    kind = ".fo"[random.below(3)];
    if (depth == 15 || !random.chance(chance)) continue;
    kind = 'n';
    below += randomBinaryNodes(random, chance, depth + 1);
  }
  return btNode(kinds) + below;
}

/// Returns the `.ot` nodes of a random subtree. @param color  bytes of a color; empty for a tree without colors
std::string randomFullNodes(Random& random, const std::string& color, double chance, int depth = 0) {
  unsigned children = 0;
  std::string below;
  for (unsigned i = 0; i < 8 && depth < 16; ++i) {
    if (!random.chance(0.5)) continue;
    children |= 1u << i;
    below += depth == 15 || !random.chance(2 * chance)
                 ? otNode(static_cast<float>(random.uniform(-3.0, 3.0))).insert(4, color)
                 : randomFullNodes(random, color, chance, depth + 1);
  }
  return otNode(static_cast<float>(random.uniform(-3.0, 3.0)), children).insert(4, color) + below;
}

class OctomapFormats : public testing::TestWithParam<OctomapFormat> {};

TEST_P(OctomapFormats, HasTheLeavesOfOctoMapsOwnIterator) {
  for (unsigned seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double from = random.chance(0.5) ? 0.5 : random.uniform(0.2, 0.9);
    OctomapOptions options = keepingFree();
    options.occupied_from = from;
    const WrittenMap written = randomMap(random, GetParam().id, GetParam().binary, from);
    const JudgedMap truth = judged(written.format, written.data, from);
    const Octomap map = readOctomapData(written.format, written.data, "map", options);
    expectSame(map, truth);
    EXPECT_EQ(flawOf(map, options), "");
    EXPECT_EQ(map.resolution, written.format.resolution);
    const Octomap from_file = readOctomap(written.file, "map", options);
    expectSame(from_file, truth);
    EXPECT_NEAR(from_file.resolution, map.resolution, 1e-5 * map.resolution) << "the header stores six digits";
    if (HasFailure()) return;
  }
}

TEST_P(OctomapFormats, HasTheLeavesOfOctoMapAtEveryDepth) {
  std::vector<int> of_level(Voxel::kLevels + 1);
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const double chance = random.uniform(0.05, 0.15);  // 0.125: each depth has about as many nodes as the one above
    const std::string data = GetParam().binary
                                 ? randomBinaryNodes(random, chance)
                                 : randomFullNodes(random, GetParam().id == "OcTree" ? "" : "rgb", chance);
    const Octomap map = readOctomapData(GetParam(), data, "map", keepingFree());
    expectSame(map, judged(GetParam(), data));
    EXPECT_EQ(flawOf(map, keepingFree()), "");
    for (const Voxel& voxel : map.occupied) ++of_level[voxel.level];
    if (HasFailure()) return;
  }
  for (int level = 0; level < 16; ++level) EXPECT_GT(of_level[level], 0) << "no voxel of level " << level;
}

INSTANTIATE_TEST_SUITE_P(All, OctomapFormats,
                         testing::Values(OctomapFormat{"OcTree", true, 0.1}, OctomapFormat{"OcTree", false, 0.1},
                                         OctomapFormat{"ColorOcTree", true, 0.1},
                                         OctomapFormat{"ColorOcTree", false, 0.1}),
                         [](const auto& format) { return format.param.id + (format.param.binary ? "Bt" : "Ot"); });

// OctoMap never writes `.bt` nodes without children. Our reader must read such nodes as OctoMap does.
TEST(Octomap, NodesWithoutChildrenMeanWhatOctoMapTakesThemFor) {
  const OctomapFormat binary{"OcTree", true, 0.1}, full{"OcTree", false, 0.1};
  const std::vector<std::pair<OctomapFormat, std::string>> cases = {
      {binary, btNode("........")},                                      // a root without children: an occupied leaf
      {binary, btNode("n......o") + btNode("........")},                 // an empty node below the root: a free leaf
      {binary, btNode("n.......") + btNode("n.......") + btNode("")},    // an empty node at depth 2: a free leaf
      {full, otNode(0.0f)},                                              // a root without children: its value decides
      {full, otNode(-1.0f)},                                             //
      {full, otNode(3.0f, 1) + otNode(-0.5f)},                           // the value of an inner node is ignored
      {full, otNode(-3.0f, 128) + otNode(-3.0f, 1) + otNode(INFINITY)},  //
  };
  for (const auto& [format, data] : cases) {
    expectSame(readOctomapData(format, data, "map", keepingFree()), judged(format, data));
  }
  EXPECT_EQ(readOctomapData(binary, btNode(""), "map").occupied, (std::vector<Voxel>{{0, 0, 0, 16}}));
}

TEST(Octomap, AFloorOfARealBuildingHasTheLeavesOfOctoMapsOwnIterator) {
  HGRID_NEEDS_SHARED_DATA();
  const std::string folder = sharedData() + "/octomap";
  if (!std::filesystem::exists(folder + "/geb079.bt")) GTEST_SKIP() << "no geb079.bt in " << folder;
  ResourcePolicy policy;
  policy.file_roots = {folder};
  const Octomap map = readOctomapFile(openResource("file://" + folder + "/geb079.bt", policy), keepingFree());
  const std::string file = fileText(folder + "/geb079.bt");
  EXPECT_EQ(map.occupied.size(), 143729u);
  EXPECT_EQ(map.resolution, 0.08);
  expectSame(map, judgedBinaryFile(file));
  EXPECT_EQ(flawOf(map, keepingFree()), "");

  std::vector<double> ours, octomaps;
  for (int i = 0; i < 11; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    readOctomap(file, "map");
    ours.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    octomaps.push_back(secondsOfReadBinary(file));
  }
  for (auto* times : {&ours, &octomaps}) std::sort(times->begin(), times->end());
  std::printf("  geb079.bt: %zu occupied leaves read in %.2f ms, by OctoMap's readBinary in %.2f ms (%.1f times)\n",
              map.occupied.size(), 1e3 * ours[5], 1e3 * octomaps[5], octomaps[5] / ours[5]);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
