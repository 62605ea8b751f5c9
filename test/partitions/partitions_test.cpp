// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests of the parts that the partitions of the book consist of. The tests broad_phase_*_test.cpp test the partitions.
#include "hgrid_proximity/partitions/partitions.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <thread>

#include "src/partitions/bucket_grid.h"
#include "src/partitions/cell_bits.h"
#include "src/partitions/hashed_grid.h"
#include "src/partitions/kd_tree.h"
#include "src/partitions/loose_octree.h"
#include "src/partitions/pair_bits.h"
#include "src/partitions/pair_counts.h"
#include "src/partitions/stamps.h"
#include "test/support/expectations.h"
#include "test/support/grids.h"

namespace hgrid {
namespace book {
namespace {

using test::Random;

TEST(PairBits, EachPairHasOneBitOfATriangle) {
  for (const std::uint64_t count : {0u, 1u, 2u, 3u, 10u, 65u}) {
    PairBits bits;
    bits.reset(count);
    std::set<std::uint64_t> indices;
    for (std::uint64_t a = 0; a < count; ++a) {
      for (std::uint64_t b = a + 1; b < count; ++b) {
        EXPECT_TRUE(indices.insert(bits.indexOf(a, b)).second) << a << " and " << b;
        EXPECT_EQ(bits.indexOf(a, b), bits.indexOf(b, a));
        EXPECT_TRUE(bits.mark(b, a));
        EXPECT_FALSE(bits.mark(a, b));
      }
    }
    EXPECT_EQ(indices.size(), count * (count - std::min<std::uint64_t>(count, 1)) / 2);
    EXPECT_TRUE(indices.empty() || *indices.rbegin() == indices.size() - 1) << "the triangle has gaps";
  }
}

/// Claim: indices of large worlds do not overflow. With 32 bits, the last index of 100,000 objects would.
TEST(PairBits, IndicesHave64Bits) {
  PairBits bits;
  bits.reset(100000);
  EXPECT_EQ(bits.indexOf(99998, 99999), 100000ull * 99999 / 2 - 1);
}

/// Claim: a query never takes an object for visited that an earlier query visited. For small stamps, the test runs over
/// many uses of each number.
template <class Marks, class Begin>
void expectFreshMarks(Marks& marks, Begin&& begin, std::size_t count) {
  Random random(count);
  std::vector<bool> visited(count);
  for (int query = 0; query < 2000; ++query) {
    begin();
    std::fill(visited.begin(), visited.end(), false);
    for (int visit = random.below(40); visit > 0; --visit) {
      const auto object = std::size_t(random.below(int(count)));
      ASSERT_EQ(marks.mark(object), !visited[object]) << "query " << query << ", object " << object;
      visited[object] = true;
    }
  }
}

TEST(Stamps, ForgetEarlierQueries) {
  for (const std::size_t count : {1u, 3u, 100u, 254u, 255u, 256u, 1000u}) {
    SCOPED_TRACE(count);
    Stamps stamps;
    expectFreshMarks(
        stamps, [&] { stamps.begin(count); }, count);
    SmallStamps small(count);
    expectFreshMarks(
        small, [&] { small.begin(); }, count);
  }
}

TEST(PairCounts, CountLikeAMap) {
  Random random(7);
  PairCounts counts;
  std::map<std::pair<ProxyId, ProxyId>, std::uint32_t> model;
  for (int step = 0; step < 40000; ++step) {
    const auto a = ProxyId(random.below(40)), b = ProxyId(random.below(40));
    if (a == b) continue;
    const auto key = std::minmax(a, b);
    const bool up = random.chance(step / 10000 % 2 == 0 ? 0.7 : 0.3);
    if (up) {
      counts.raise(a, b);
      ++model[key];
    } else {
      counts.lower(a, b);
      const auto place = model.find(key);
      if (place != model.end() && --place->second == 0) model.erase(place);
    }
    ASSERT_EQ(counts.size(), model.size()) << "step " << step;
    const auto place = model.find(key);
    ASSERT_EQ(counts.of(b, a), place == model.end() ? 0 : place->second) << "step " << step;
  }
  std::map<std::pair<ProxyId, ProxyId>, std::uint32_t> visited;
  counts.visit([&](ProxyId a, ProxyId b) { visited[{a, b}] = counts.of(a, b); });
  EXPECT_EQ(visited, model);
  EXPECT_GT(model.size(), 100u);
}

/// Claim: the table says that it lacks pairs, and holds none of them. Otherwise a later search would miss some.
TEST(PairCounts, BeyondTheirLimitAreDroppedUntilTheTableIsCleared) {
  PairCounts counts;
  counts.clear(200);
  const std::size_t least = counts.bytes();
  for (ProxyId other = 1; other <= 200; ++other) counts.raise(0, other);
  counts.raise(0, 200);
  EXPECT_TRUE(counts.isComplete());
  EXPECT_EQ(counts.size(), 200u);
  counts.raise(0, 201);
  counts.raise(0, 1);
  EXPECT_FALSE(counts.isComplete());
  EXPECT_EQ(counts.size(), 0u);
  EXPECT_EQ(counts.of(0, 1), 0u);
  EXPECT_EQ(counts.bytes(), least) << "the memory of dropped pairs is released";
  counts.clear(200);
  counts.raise(0, 1);
  EXPECT_TRUE(counts.isComplete());
  EXPECT_EQ(counts.of(0, 1), 1u);
}

TEST(LooseOctree, CodesInterleaveTheBitsOfTheIndices) {
  EXPECT_EQ(nodeCode(0, 0, 0, 0), 1u);
  EXPECT_EQ(nodeCode(1, 1, 0, 0), 8u + 1u);
  EXPECT_EQ(nodeCode(1, 0, 1, 0), 8u + 2u);
  EXPECT_EQ(nodeCode(1, 0, 0, 1), 8u + 4u);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const int depth = random.below(21);
    std::uint64_t index[3], expected = 1;
    for (std::uint64_t& one : index) one = std::uint64_t(random.below(1 << 20)) >> (20 - depth);
    for (int bit = depth - 1; bit >= 0; --bit) {  // as in section 7.3.3: the top bits select the child of the root
      expected = expected << 3 | (index[0] >> bit & 1) | (index[1] >> bit & 1) << 1 | (index[2] >> bit & 1) << 2;
    }
    EXPECT_EQ(nodeCode(depth, index[0], index[1], index[2]), expected) << "depth " << depth;
  }
}

TEST(CellBits, TellsEmptyCellsOfTheCoveredRangeOnly) {
  const CellRange range{{-3, 0, 5}, {4, 2, 9}};
  CellBits bits;
  bits.cover(range, 1000);
  ASSERT_TRUE(bits.covers());
  EXPECT_TRUE(bits.mayBeOccupied({-4, 0, 5})) << "a cell that is not covered may be occupied";
  range.visit([&](const Cell& cell) {
    EXPECT_FALSE(bits.mayBeOccupied(cell));
    bits.set(cell, true);
    EXPECT_TRUE(bits.mayBeOccupied(cell));
    if ((cell.x + cell.y) % 2 == 0) bits.set(cell, false);
  });
  range.visit([&](const Cell& cell) { EXPECT_EQ(bits.mayBeOccupied(cell), (cell.x + cell.y) % 2 != 0); });
  bits.cover(range, 100);
  EXPECT_FALSE(bits.covers()) << "the range has 120 cells";
  EXPECT_TRUE(bits.mayBeOccupied({0, 0, 6}));
}

/// Claim: the first hit of a segment is the first one that along() lists.
TEST(KdTree, FindsTheFirstHitOfASegment) {
  std::size_t hits = 0;
  for (int seed = 0; seed < 220; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{unsigned(seed)};
    const std::vector<Aabb> boxes = test::worldOf(test::Family(seed % test::kFamilies), unsigned(seed));
    if (boxes.empty()) continue;
    KdTree tree;
    tree.update(test::allIds(boxes.size()), boxes);
    for (int i = 0; i < 10; ++i) {
      const Aabb &a = boxes[std::size_t(random.below(int(boxes.size())))],
                 &b = boxes[std::size_t(random.below(int(boxes.size())))];
      const Eigen::Vector3d from = a.min.cast<double>() - 3.0 * (b.max - b.min).cast<double>();
      const Segment segment{from, b.max.cast<double>(), random.chance(0.5) ? 0.0 : random.uniform(0, 0.5)};
      const std::vector<SegmentHit> all = test::alongOf(tree, segment);
      const std::optional<SegmentHit> first = tree.firstAlong(segment);
      ASSERT_EQ(first.has_value(), !all.empty());
      ASSERT_TRUE(!first || *first == all.front());
      hits += all.size();
    }
  }
  EXPECT_GT(hits, 5000u);
}

TEST(Partitions, AreMadeByName) {
  std::set<std::string> names;
  for (const BroadPhaseType type : broadPhaseTypes()) {
    BroadPhaseType found = BroadPhaseType::hgrid;
    EXPECT_TRUE(find(name(type), found));
    EXPECT_EQ(found, type);
    names.insert(name(type));
    const std::unique_ptr<BroadPhase> made = makeBroadPhase({type});
    made->insert(3, {{0, 0, 0}, {1, 1, 1}});
    EXPECT_EQ(made->size(), 1u);
    EXPECT_GT(storedBytes(*made), sizeof(Aabb));
  }
  EXPECT_EQ(names.size(), broadPhaseTypes().size());
  EXPECT_EQ(broadPhaseTypes().back(), BroadPhaseType::sweep_array) << "the last kind has no row";
  BroadPhaseType unchanged = BroadPhaseType::kd_tree;
  EXPECT_FALSE(find("octree", unchanged));
  EXPECT_EQ(unchanged, BroadPhaseType::kd_tree);
}

/// Claim: all kinds find the same pairs and give the same answers in a world of a thousand boxes that move.
TEST(Partitions, AgreeWithEachOther) {
  Random random(11);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 1000; ++i) {
    boxes.push_back(test::boxAround(test::randomVector(random, -6, 6),
                                    random.logUniform(0.05, 3) * test::randomVector(random, 0.2, 1)));
  }
  std::vector<std::unique_ptr<BroadPhase>> all;
  for (const BroadPhaseType type : broadPhaseTypes()) all.push_back(makeBroadPhase({type}));
  for (int frame = 0; frame < 12; ++frame) {
    const double share = frame % 3 == 0 ? 1.0 : frame % 3 == 1 ? 0.1 : 0.01;
    for (Aabb& box : boxes) {
      if (!random.chance(share)) continue;
      const Eigen::Vector3f by = test::randomVector(random, -0.1, 0.1).cast<float>();
      box = {box.min + by, box.max + by};
    }
    for (auto& one : all) one->update(test::allIds(boxes.size()), boxes);
    const Sphere sphere{test::randomVector(random, -6, 6), 1.0};
    const Segment segment{test::randomVector(random, -6, 6), test::randomVector(random, -6, 6), 0.2};
    const test::Pairs expected = test::pairsOf(*all.front());
    ASSERT_GT(expected.size(), 500u);
    std::vector<NearHit> near, expected_near;
    all.front()->nearest(sphere.center, 8, 1e9, expected_near);
    for (std::size_t i = 0; i < all.size(); ++i) {
      SCOPED_TRACE(name(broadPhaseTypes()[i]));
      ASSERT_EQ(test::pairsOf(*all[i]), expected);
      ASSERT_EQ(test::foundBy(*all[i], sphere), test::foundBy(*all.front(), sphere));
      ASSERT_EQ(test::alongOf(*all[i], segment), test::alongOf(*all.front(), segment));
      all[i]->nearest(sphere.center, 8, 1e9, near);
      ASSERT_EQ(near.size(), expected_near.size());
      for (std::size_t k = 0; k < near.size(); ++k) ASSERT_EQ(near[k].id, expected_near[k].id);
    }
  }
}

/// Claim: a sphere finds the boxes that it touches also where the square of a coordinate, or the region of a node, is
/// out of range.
TEST(Partitions, MissNoBoxAmongTheLargestNumbers) {
  const Eigen::Vector3f far = Eigen::Vector3f::Constant(2e38f);
  const std::vector<Aabb> boxes = {{-far, -far}, {far, far}, {{0, 0, 0}, {1, 1, 1}}};
  std::vector<Aabb> row;
  for (int i = 0; i < 20; ++i) row.push_back({{float(i), 0, 0}, {float(i) + 0.5f, 1, 1}});
  for (const BroadPhaseType type : broadPhaseTypes()) {
    SCOPED_TRACE(name(type));
    const std::unique_ptr<BroadPhase> made = makeBroadPhase({type});
    made->update(test::allIds(boxes.size()), boxes);
    EXPECT_EQ(test::foundBy(*made, Sphere{{0, 0, 0}, 1.0}), std::vector<ProxyId>({2}));
    EXPECT_EQ(test::foundBy(*made, Sphere{far.cast<double>(), 1.0}), std::vector<ProxyId>({1}));
    made->update(test::allIds(row.size()), row);
    EXPECT_EQ(test::foundBy(*made, Sphere{{1e200, 0, 0}, 1e200}).size(), row.size());
  }
}

/// Claim: a box much larger than the cells takes no cells of a drawing. Here, it covers 10^6 cells.
TEST(Partitions, DrawNoCellsOfLargeBoxes) {
  std::vector<Aabb> boxes = {{{0, 0, 0}, {10, 10, 10}}};
  for (int i = 0; i < 100; ++i) boxes.push_back({{float(i), 0, 0}, {float(i) + 0.1f, 0.1f, 0.1f}});
  for (const bool with_buckets : {false, true}) {
    std::unique_ptr<Partition> grid;
    with_buckets ? grid = std::make_unique<BucketGrid>() : grid = std::make_unique<HashedGrid>();
    grid->update(test::allIds(boxes.size()), boxes);
    EXPECT_LE(grid->drawing().size(), 800u);
  }
}

/// Claim: several threads may make the first search after a change, which builds the structure again.
TEST(Partitions, AreBuiltOnceByOneOfManyThreads) {
  Random random(5);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 2000; ++i)
    boxes.push_back(test::boxAround(test::randomVector(random, -6, 6), test::randomVector(random, 0.1, 1)));
  for (const BroadPhaseType type : broadPhaseTypes()) {
    SCOPED_TRACE(name(type));
    const std::unique_ptr<BroadPhase> made = makeBroadPhase({type});
    made->update(test::allIds(boxes.size()), boxes);
    std::vector<std::vector<ProxyId>> found(4);
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < found.size(); ++i) {
      threads.emplace_back([&, i] { found[i] = test::foundBy(*made, Sphere{Eigen::Vector3d::Zero(), 3.0}); });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_GT(found[0].size(), 50u);
    for (const std::vector<ProxyId>& one : found) EXPECT_EQ(one, found[0]);
  }
}

}  // namespace
}  // namespace book
}  // namespace hgrid
