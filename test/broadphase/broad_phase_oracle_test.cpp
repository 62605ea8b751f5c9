// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <set>

#include "test/broadphase/broad_phase_suite.h"

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

/// Returns a random size [m] for a query: 0, or up to 100 times the size of a box.
double someLength(const std::vector<Aabb>& boxes, Random& random) {
  if (random.chance(0.2) || boxes.empty()) return 0.0;
  const Aabb& box = boxes[std::size_t(random.below(int(boxes.size())))];
  return double((box.max - box.min).maxCoeff()) * random.logUniform(0.01, 100);
}

void expectRightBoxAnswers(const BroadPhaseReader& tested, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d a = pointNear(boxes, random), b = pointNear(boxes, random);
    Aabb query = {a.cwiseMin(b).cast<float>(), a.cwiseMax(b).cast<float>()};
    if (i % 2 && !boxes.empty()) query = boxes[std::size_t(random.below(int(boxes.size())))];
    std::vector<ProxyId> expected;
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      if (test::oracleOverlap(query, boxes[id])) expected.push_back(id);
    }
    ASSERT_EQ(test::foundBy(tested, query), expected);
  }
}

void expectRightSphereAnswers(const BroadPhaseReader& tested, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 3; ++i) {
    const Sphere sphere{pointNear(boxes, random), someLength(boxes, random)};
    const std::vector<ProxyId> found = test::foundBy(tested, sphere);
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));
    const std::set<ProxyId> hits(found.begin(), found.end());
    ASSERT_EQ(hits.size(), found.size()) << "a box was found twice";
    const long double slack = test::promisedSlack(sphere.center, sphere.center, sphere.radius);
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      const long double near = test::distanceAt(boxes[id], sphere.center, sphere.center, 0);
      if (hits.count(id) != 0) {
        ASSERT_LE(near, sphere.radius + slack) << "box " << id << " was found, but does not touch the sphere";
      } else if (near <= sphere.radius + slack) {
        ASSERT_FALSE(test::exactlyTouches(boxes[id], sphere.center, sphere.radius)) << "box " << id << " is missing";
      }
    }
  }
}

void expectRightSegmentAnswers(const BroadPhaseReader& tested, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 3; ++i) {
    Segment segment{pointNear(boxes, random), pointNear(boxes, random),
                    random.chance(0.5) ? 0.0 : someLength(boxes, random)};
    for (int k = 0; k < 3; ++k) {
      if (random.chance(0.2)) segment.to[k] = segment.from[k];
    }
    const std::vector<SegmentHit> found = test::alongOf(tested, segment);
    std::set<ProxyId> hits;
    for (std::size_t h = 0; h < found.size(); ++h) {
      ASSERT_TRUE(hits.insert(found[h].id).second) << "a box was found twice";
      if (h == 0) continue;
      const SegmentHit &before = found[h - 1], &here = found[h];
      ASSERT_TRUE(before.along < here.along || (before.along == here.along && before.id < here.id))
          << "the boxes are not in order";
    }
    const Aabb around = {segment.from.cwiseMin(segment.to).cast<float>(),
                         segment.from.cwiseMax(segment.to).cast<float>()};
    const double slack = test::promisedSlack(segment.from, segment.to, segment.radius);
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      const bool hit = hits.count(id) != 0;
      if (!hit && !test::oracleWithin(around, boxes[id], segment.radius + slack + 1e-6 * around.max.norm())) continue;
      const auto approach = test::approachOf(boxes[id], segment.from, segment.to, segment.radius);
      if (hit) {
        ASSERT_LE(approach.least, segment.radius + slack)
            << "box " << id << " was found, but does not touch the segment";
      } else {
        ASSERT_GT(approach.least, segment.radius) << "box " << id << " is missing";
        if (segment.radius > 0.0) continue;
        ASSERT_FALSE(test::exactlyMeets(boxes[id], segment.from, segment.to)) << "box " << id << " is missing";
      }
    }
  }
}

void expectRightNearest(const BroadPhaseReader& tested, const std::vector<Aabb>& boxes, Random& random) {
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector3d point = pointNear(boxes, random);
    const auto count = std::size_t(random.below(12));
    const double limit = random.chance(0.5) ? std::numeric_limits<double>::infinity() : someLength(boxes, random);
    std::vector<std::pair<double, ProxyId>> expected;
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      const double away = distance(boxes[id], point);  // test/geometry tests distance()
      if (away <= limit) expected.emplace_back(away, id);
    }
    std::sort(expected.begin(), expected.end());
    expected.resize(std::min(count, expected.size()));
    std::vector<NearHit> found = {{7, 7.0}};
    tested.nearest(point, count, limit, found);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(std::make_pair(found[k].distance, found[k].id), expected[k]) << "number " << k;
    }
  }
}

/// Claim: for this family of worlds, pairs, box queries and nearest queries give the same results as a scan of all
/// boxes. Sphere and segment queries find all boxes, and extra boxes only within the rounding error.
template <class Tested>
void expectAnswersOfAScan(Family family) {
  const int worlds = std::max(1, test::worldsToTest() / test::kFamilies);
  std::size_t true_pairs = 0;
  for (int world = 0; world < worlds; ++world) {
    const auto seed = unsigned(world * test::kFamilies + int(family));
    SCOPED_TRACE(std::string(name(family)) + ", seed " + std::to_string(seed));
    Random random(seed + 1000000u);
    const std::vector<Aabb> boxes = test::worldOf(family, seed);
    const std::unique_ptr<BroadPhase> tested = test::Maker<Tested>::withAny(boxes, random);
    test::bringTo(*tested, boxes, random);
    const test::Pairs expected = test::allOverlaps(boxes);
    true_pairs += expected.size();
    ASSERT_EQ(test::pairsOf(*tested), expected);
    ASSERT_NO_FATAL_FAILURE(expectRightBoxAnswers(*tested, boxes, random));
    ASSERT_NO_FATAL_FAILURE(expectRightSphereAnswers(*tested, boxes, random));
    ASSERT_NO_FATAL_FAILURE(expectRightSegmentAnswers(*tested, boxes, random));
    ASSERT_NO_FATAL_FAILURE(expectRightNearest(*tested, boxes, random));
    ASSERT_NO_THROW(tested->checkInvariants());
  }
  if (family == Family::empty) {
    EXPECT_EQ(true_pairs, 0u);
  } else {
    // Makes sure that the test has found enough pairs: about 10^4 in a run with the default number of worlds.
    EXPECT_GE(true_pairs, std::size_t(worlds) * 12);
  }
}

template <class Tested>
class BroadPhaseOracle : public ::testing::Test {};
TYPED_TEST_SUITE(BroadPhaseOracle, test::AllBroadPhases, test::BroadPhaseNames);

TYPED_TEST(BroadPhaseOracle, AnswersAsAScanUniform) { expectAnswersOfAScan<TypeParam>(Family::uniform); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanClustered) { expectAnswersOfAScan<TypeParam>(Family::clustered); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanLattice) { expectAnswersOfAScan<TypeParam>(Family::lattice); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanSizeRatio) { expectAnswersOfAScan<TypeParam>(Family::size_ratio); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanNegative) { expectAnswersOfAScan<TypeParam>(Family::negative); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanFar) { expectAnswersOfAScan<TypeParam>(Family::far); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanEmpty) { expectAnswersOfAScan<TypeParam>(Family::empty); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanSamePlace) { expectAnswersOfAScan<TypeParam>(Family::same_place); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanThinPlates) { expectAnswersOfAScan<TypeParam>(Family::thin_plates); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanPoints) { expectAnswersOfAScan<TypeParam>(Family::points); }
TYPED_TEST(BroadPhaseOracle, AnswersAsAScanAroundZero) { expectAnswersOfAScan<TypeParam>(Family::around_zero); }
static_assert(test::kFamilies == 11, "each family has a test above");

}  // namespace
}  // namespace hgrid
