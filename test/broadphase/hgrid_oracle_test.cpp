// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <set>

#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::Family;
using test::Random;

Eigen::Vector3d pointNear(const std::vector<Aabb>& boxes, Random& random) {
  if (boxes.empty()) return test::randomVector(random, -1, 1);
  const Aabb& box = boxes[std::size_t(random.below(int(boxes.size())))];
  const Eigen::Vector3d size = (box.max - box.min).cast<double>();
  Eigen::Vector3d point = box.min.cast<double>();
  for (int k = 0; k < 3; ++k) point[k] += size[k] * (random.chance(0.4) ? random.below(2) : random.uniform(-1, 2));
  return point;
}

/// A query's size, from nothing to the whole world.
double someLength(const std::vector<Aabb>& boxes, Random& random) {
  if (random.chance(0.2) || boxes.empty()) return 0.0;
  const Aabb& box = boxes[std::size_t(random.below(int(boxes.size())))];
  return double((box.max - box.min).maxCoeff()) * random.logUniform(0.01, 100);
}

void expectRightBoxAnswers(const HGrid& grid, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d a = pointNear(boxes, random), b = pointNear(boxes, random);
    Aabb query = {a.cwiseMin(b).cast<float>(), a.cwiseMax(b).cast<float>()};
    if (i % 2 && !boxes.empty()) query = boxes[std::size_t(random.below(int(boxes.size())))];
    std::vector<ProxyId> expected;
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      if (test::oracleOverlap(query, boxes[id])) expected.push_back(id);
    }
    ASSERT_EQ(test::foundBy(grid, query), expected);
  }
}

void expectRightBallAnswers(const HGrid& grid, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 3; ++i) {
    const Sphere ball{pointNear(boxes, random), someLength(boxes, random)};
    const std::vector<ProxyId> found = test::foundBy(grid, ball);
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    const std::set<ProxyId> hits(found.begin(), found.end());
    ASSERT_EQ(hits.size(), found.size()) << "one box twice";
    const long double slack = test::promisedSlack(ball.center, ball.center, ball.radius);
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      const long double near = test::distanceAt(boxes[id], ball.center, ball.center, 0);
      if (hits.count(id) != 0) {
        ASSERT_LE(near, ball.radius + slack) << "box " << id << " is too much";
      } else if (near <= ball.radius + slack) {
        ASSERT_FALSE(test::exactlyTouches(boxes[id], ball.center, ball.radius)) << "box " << id << " is missed";
      }
    }
  }
}

void expectRightSegmentAnswers(const HGrid& grid, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 3; ++i) {
    Segment segment{pointNear(boxes, random), pointNear(boxes, random),
                    random.chance(0.5) ? 0.0 : someLength(boxes, random)};
    for (int k = 0; k < 3; ++k) {
      if (random.chance(0.2)) segment.to[k] = segment.from[k];
    }
    const std::vector<SegmentHit> found = test::alongOf(grid, segment);
    std::set<ProxyId> hits;
    for (std::size_t h = 0; h < found.size(); ++h) {
      ASSERT_TRUE(hits.insert(found[h].id).second) << "one box twice";
      if (h == 0) continue;
      const SegmentHit &before = found[h - 1], &here = found[h];
      ASSERT_TRUE(before.along < here.along || (before.along == here.along && before.id < here.id)) << "not in order";
    }
    const Aabb around = {segment.from.cwiseMin(segment.to).cast<float>(),
                         segment.from.cwiseMax(segment.to).cast<float>()};
    const double slack = test::promisedSlack(segment.from, segment.to, segment.radius);
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      const bool hit = hits.count(id) != 0;
      if (!hit && !test::oracleWithin(around, boxes[id], segment.radius + slack + 1e-6 * around.max.norm())) continue;
      const auto approach = test::approachOf(boxes[id], segment.from, segment.to, segment.radius);
      if (hit) {
        ASSERT_LE(approach.least, segment.radius + slack) << "box " << id << " is too much";
      } else {
        ASSERT_GT(approach.least, segment.radius) << "box " << id << " is missed";
        if (segment.radius > 0.0) continue;
        ASSERT_FALSE(test::exactlyMeets(boxes[id], segment.from, segment.to)) << "box " << id << " is missed";
      }
    }
  }
}

void expectRightNearest(const HGrid& grid, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d point = pointNear(boxes, random);
    const auto count = std::size_t(random.below(12));
    const double limit = random.chance(0.5) ? std::numeric_limits<double>::infinity() : someLength(boxes, random);
    std::vector<std::pair<double, ProxyId>> expected;
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      const double away = distance(boxes[id], point);  // itself tested in test/geometry
      if (away <= limit) expected.emplace_back(away, id);
    }
    std::sort(expected.begin(), expected.end());
    expected.resize(std::min(count, expected.size()));
    std::vector<NearHit> found = {{7, 7.0}};
    grid.nearest(point, count, limit, found);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(std::make_pair(found[k].distance, found[k].id), expected[k]) << "number " << k;
    }
  }
}

/// Many questions at once are answered as each alone.
void expectBatchesAsSingles(const HGrid& grid, const std::vector<Aabb>& boxes, Random& random) {
  std::vector<Aabb> around;
  std::vector<Sphere> balls;
  std::vector<Segment> segments;
  for (int i = random.below(6); i > 0; --i) {
    const Eigen::Vector3d a = pointNear(boxes, random), b = pointNear(boxes, random);
    around.push_back({a.cwiseMin(b).cast<float>(), a.cwiseMax(b).cast<float>()});
    balls.push_back({a, someLength(boxes, random)});
    segments.push_back({a, b, random.chance(0.5) ? 0.0 : someLength(boxes, random)});
  }
  IdBatch ids;
  SegmentBatch hits;
  const auto listOf = [](const auto& batch, std::size_t i) {
    const auto begin = batch.found.begin() + std::ptrdiff_t(batch.begin[i]);
    return std::vector<std::decay_t<decltype(*begin)>>(begin, begin + std::ptrdiff_t(batch.count[i]));
  };
  grid.overlapping(around, ids);
  for (std::size_t i = 0; i < around.size(); ++i) ASSERT_EQ(listOf(ids, i), test::foundBy(grid, around[i]));
  grid.overlapping(balls, ids);
  for (std::size_t i = 0; i < balls.size(); ++i) ASSERT_EQ(listOf(ids, i), test::foundBy(grid, balls[i]));
  grid.along(segments, hits);
  for (std::size_t i = 0; i < segments.size(); ++i) ASSERT_EQ(listOf(hits, i), test::alongOf(grid, segments[i]));
  ASSERT_EQ(hits.begin.size(), segments.size());
}

class HGridOracle : public ::testing::TestWithParam<int> {};

/// Claim: all pairs, box and nearest queries equal brute force; balls and segments find no less and hardly more.
TEST_P(HGridOracle, AnswersAsAScanOfAllBoxesDoes) {
  const auto family = static_cast<Family>(GetParam());
  const int worlds = std::max(1, test::countFromEnvironment("HGRID_TEST_WORLDS", 10000) / test::kFamilies);
  std::size_t true_pairs = 0;
  for (int world = 0; world < worlds; ++world) {
    const auto seed = unsigned(world * test::kFamilies + GetParam());
    SCOPED_TRACE(std::string(name(family)) + ", seed " + std::to_string(seed));
    Random random(seed + 1000000u);
    const std::vector<Aabb> boxes = test::worldOf(family, seed);
    const HGrid grid = test::gridComeTo(boxes, test::scaleFor(boxes, random), random);
    const test::Pairs expected = test::allOverlaps(boxes);
    true_pairs += expected.size();
    ASSERT_EQ(test::pairsOf(grid), expected);
    ASSERT_NO_FATAL_FAILURE(expectRightBoxAnswers(grid, boxes, random));
    ASSERT_NO_FATAL_FAILURE(expectRightBallAnswers(grid, boxes, random));
    ASSERT_NO_FATAL_FAILURE(expectRightSegmentAnswers(grid, boxes, random));
    ASSERT_NO_FATAL_FAILURE(expectRightNearest(grid, boxes, random));
    ASSERT_NO_FATAL_FAILURE(expectBatchesAsSingles(grid, boxes, random));
    ASSERT_NO_THROW(grid.checkInvariants());
  }
  if (family == Family::empty) {
    EXPECT_EQ(true_pairs, 0u);
  } else {
    // 10^4 pairs in the default run: a comparison of two empty lists proves nothing.
    EXPECT_GE(true_pairs, std::size_t(worlds) * 12);
  }
}

std::string familyName(const ::testing::TestParamInfo<int>& info) { return name(static_cast<Family>(info.param)); }

INSTANTIATE_TEST_SUITE_P(Families, HGridOracle, ::testing::Range(0, test::kFamilies), familyName);

}  // namespace
}  // namespace hgrid
