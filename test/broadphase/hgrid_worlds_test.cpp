// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "test/support/brute_force.h"
#include "test/support/expectations.h"
#include "test/support/uneven_world.h"

// Worlds that are difficult for a grid that computes the size of its cells from the boxes.

namespace hgrid {
namespace {

using test::allIds;
using test::boxAround;
using test::expectRight;
using test::Random;
using test::randomVector;

/// Returns boxes with a size of about 0.5 m around a place. Each box has a few neighbors.
std::vector<Aabb> crowd(std::size_t count, Random& random, const Eigen::Vector3d& place = Eigen::Vector3d::Zero()) {
  std::vector<Aabb> boxes;
  const double half = 0.35 * std::cbrt(double(count));
  while (boxes.size() < count) {
    const Eigen::Vector3d center = place + randomVector(random, -half, half);
    boxes.push_back(boxAround(center, randomVector(random, 0.2, 0.9)));
  }
  return boxes;
}

/// Moves every box a little.
void stir(std::vector<Aabb>& boxes, Random& random) {
  for (Aabb& box : boxes) {
    const Eigen::Vector3f way = randomVector(random, -0.2, 0.2).cast<float>();
    box = {box.min + way, (box.max + way).cwiseMax(box.min + way)};
  }
}

TEST(HGridWorlds, StraysAMillionMetersOutMeetTheirNeighborsOnly) {
  for (const Isa isa : test::supportedIsas()) {
    SCOPED_TRACE(name(isa));
    Random random(1);
    std::vector<Aabb> boxes = crowd(2000, random);
    HGrid grid;
    grid.setIsa(isa);
    for (int frame = 0; frame < 6; ++frame) {
      if (frame > 0) stir(boxes, random);
      for (int k = 0; k < 12; ++k) {  // moves two boxes to each end of each axis, different boxes in each step
        Eigen::Vector3d place(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
        place[k % 3] = k % 2 != 0 ? 1e6 : -1e6;
        boxes[std::size_t(100 * frame + k)] = boxAround(place, {2, 2, 2});
      }
      grid.update(allIds(boxes.size()), boxes);
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    }
    const Segment across{{-2e6, 0.1, 0.2}, {2e6, 0.1, 0.2}, 0.0};
    std::size_t met = 0;
    for (const Aabb& box : boxes) met += meet(across, box).has_value();
    EXPECT_EQ(test::alongOf(grid, across).size(), met) << "a segment between far boxes through all cells";
  }
}

TEST(HGridWorlds, HeapsTenKilometersApartAreEachAsRightAsOne) {
  for (const int heaps : {2, 10}) {
    SCOPED_TRACE(std::to_string(heaps) + " heaps");
    Random random(unsigned(heaps) + 0u);
    std::vector<Aabb> boxes;
    for (int i = 0; i < heaps; ++i) {
      const Eigen::Vector3d place = 1e4 * Eigen::Vector3d(i % 2 + i / 4, i % 3, -(i % 5));
      const std::vector<Aabb> heap = crowd(std::size_t(2000 / heaps), random, place);
      boxes.insert(boxes.end(), heap.begin(), heap.end());
    }
    HGrid grid = test::gridOf(boxes, GridScale{});
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    for (int frame = 0; frame < 3; ++frame) {
      stir(boxes, random);
      std::swap(boxes[std::size_t(random.below(2000))], boxes[std::size_t(random.below(2000))]);
      grid.update(allIds(boxes.size()), boxes);
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    }
  }
}

TEST(HGridWorlds, RodsAndPlatesAreRightWhileTheyMoveAndTurn) {
  for (const Isa isa : test::supportedIsas()) {
    SCOPED_TRACE(name(isa));
    Random random(7);
    std::vector<Aabb> boxes;
    for (int i = 0; i < 5000; ++i) boxes.push_back(test::thinBoxAround(randomVector(random, -18, 18), random));
    HGrid grid;
    grid.setIsa(isa);
    for (const double share : {0.0, 0.01, 0.2, 1.0, 1.0}) {
      for (Aabb& box : boxes) {
        // A box that turns has another shape, possibly one that no box had before.
        if (random.chance(share)) box = test::thinBoxAround(box.min.cast<double>(), random);
        if (share < 1.0 && random.chance(0.1 * share)) box = boxAround(box.min.cast<double>(), {2, 2, 2});
      }
      grid.update(allIds(boxes.size()), boxes);
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    }
    for (std::size_t i = 0; i < boxes.size(); i += 50) {
      const Segment segment{boxes[i].min.cast<double>(), randomVector(random, -18, 18), random.uniform(0, 0.2)};
      std::size_t met = 0;
      for (const Aabb& box : boxes) met += meet(segment, box).has_value();
      ASSERT_EQ(test::alongOf(grid, segment).size(), met);
    }
  }
}

TEST(HGridWorlds, UnevenWorldsAreRightWithAllThreadsAndWhileBoxesMove) {
  for (int kind = 0; kind < 5; ++kind) {
    for (const int threads : {1, 3}) {
      SCOPED_TRACE("kind " + std::to_string(kind) + ", threads " + std::to_string(threads));
      Random random(unsigned(kind) + 1u);
      std::vector<Aabb> boxes = test::unevenWorld(kind, threads == 1 ? 3000 : 40000, random);
      HGrid grid(GridScale::fitting(boxes));
      grid.setThreads(threads);
      std::vector<ProxyId> fixed;
      for (ProxyId id = 0; id < boxes.size(); id += 5) fixed.push_back(id);
      grid.setFixed(fixed);
      std::vector<bool> is_fixed(boxes.size());
      for (const ProxyId id : fixed) is_fixed[id] = true;
      grid.update(allIds(boxes.size()), boxes);
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, allIds(boxes.size()), is_fixed));
      // One in every `stride` boxes moves.
      for (const std::size_t stride : {std::size_t{1}, std::size_t{7}, std::size_t{101}}) {
        std::vector<ProxyId> ids;
        std::vector<Aabb> moved;
        for (std::size_t i = 1; i < boxes.size(); i += stride) {
          if (is_fixed[i]) continue;
          const Eigen::Vector3f way = randomVector(random, -0.3, 0.3).cast<float>();
          boxes[i] = {boxes[i].min + way, (boxes[i].max + way).cwiseMax(boxes[i].min + way)};
          ids.push_back(static_cast<ProxyId>(i));
          moved.push_back(boxes[i]);
        }
        grid.move(ids, moved);
        ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, allIds(boxes.size()), is_fixed));
      }
      for (int i = 0; i < 20; ++i) {
        const Aabb& box = boxes[std::size_t(random.below(int(boxes.size())))];
        const Segment segment{box.min.cast<double>(), randomVector(random, -1e4, 1e4), random.uniform(0, 2)};
        std::size_t met = 0;
        for (const Aabb& other : boxes) met += meet(segment, other).has_value();
        EXPECT_EQ(test::alongOf(grid, segment).size(), met);
        const Eigen::Vector3d point = randomVector(random, -1e4, 1e4);
        std::vector<NearHit> nearest;
        grid.nearest(i % 2 == 0 ? point : box.max.cast<double>(), 5, 1e9, nearest);
        ASSERT_EQ(nearest.size(), 5u);
        std::vector<double> distances;
        for (const Aabb& other : boxes)
          distances.push_back(distance(other, i % 2 == 0 ? point : box.max.cast<double>()));
        std::sort(distances.begin(), distances.end());
        for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(nearest[k].distance, distances[k]);
      }
    }
  }
}

/// Expects that queries near the boxes and far from them have the same answers as with brute force.
void expectQueriesLikeBruteForce(const HGrid& grid, const test::BruteForce& brute_force, Random& random) {
  for (int i = 0; i < 30; ++i) {
    const auto some = std::next(brute_force.boxes().begin(), random.below(int(brute_force.size())));
    const Eigen::Vector3d place =
        some->second.min.cast<double>() + randomVector(random, -1, 1) * random.logUniform(0.1, 1000.0);
    const Sphere sphere{place, random.logUniform(0.1, 50.0)};
    const Segment segment{place, place + randomVector(random, -1, 1) * random.logUniform(0.1, 1000.0), 0.1};
    const Aabb box = boxAround(place, randomVector(random, 0.1, 20.0));
    std::vector<ProxyId> found, expected;
    grid.overlapping(sphere, found);
    brute_force.overlapping(sphere, expected);
    ASSERT_EQ(found, expected);
    grid.overlapping(box, found);
    brute_force.overlapping(box, expected);
    ASSERT_EQ(found, expected);
    ASSERT_EQ(test::alongOf(grid, segment), test::alongOf(brute_force, segment));
    std::vector<NearHit> nearest, expected_nearest;
    grid.nearest(place, 40, std::numeric_limits<double>::infinity(), nearest);
    brute_force.nearest(place, 40, std::numeric_limits<double>::infinity(), expected_nearest);
    ASSERT_EQ(nearest.size(), expected_nearest.size());
    for (std::size_t k = 0; k < nearest.size(); ++k) {
      ASSERT_EQ(nearest[k].id, expected_nearest[k].id);
      ASSERT_EQ(nearest[k].distance, expected_nearest[k].distance);
    }
  }
}

TEST(HGridWorlds, PairsAndQueriesOfADiagonalOfBoxesAreRight) {
  for (const Isa isa : test::supportedIsas()) {
    for (const std::size_t count : {1, 2, 31, 32, 33, 64, 65, 520, 1500}) {
      SCOPED_TRACE(name(isa) + (", boxes: " + std::to_string(count)));
      Random random(static_cast<unsigned>(count));
      std::vector<Aabb> boxes;
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d place = 0.4 * double(i) * Eigen::Vector3d(1, -1, 1) + randomVector(random, -0.2, 0.2);
        boxes.push_back(boxAround(place, randomVector(random, 0.0, 1.2)));
      }
      HGrid grid(GridScale::fitting(boxes));
      grid.setIsa(isa);
      test::BruteForce brute_force;
      grid.update(allIds(count), boxes);
      brute_force.update(allIds(count), boxes);
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
      ASSERT_NO_FATAL_FAILURE(expectQueriesLikeBruteForce(grid, brute_force, random));
      for (std::size_t i = 0; i + 1 < count && i < 5; ++i) {  // these boxes are withdrawn from the row
        const auto gone = std::next(brute_force.boxes().begin(), random.below(int(brute_force.size())))->first;
        grid.remove(gone);
        brute_force.remove(gone);
      }
      grid.checkInvariants();
      ASSERT_NO_FATAL_FAILURE(expectQueriesLikeBruteForce(grid, brute_force, random));
    }
  }
}

TEST(HGridWorlds, QueriesOfARowAreRightWhileSingleBoxesComeAndMove) {
  Random random(1);
  const std::vector<Aabb> boxes = test::diagonalOfBoxes(600);
  HGrid grid;
  test::BruteForce brute_force;
  const std::vector<Aabb> first(boxes.begin(), boxes.begin() + 380);
  grid.update(allIds(380), first);
  brute_force.update(allIds(380), first);
  // When single boxes join the others, memory is reserved for layers that are not sorted then.
  for (ProxyId id = 380; id < 600; ++id) {
    grid.insert(id, boxes[id]);
    brute_force.insert(id, boxes[id]);
    if (id % 5 != 0) continue;
    ASSERT_NO_FATAL_FAILURE(expectQueriesLikeBruteForce(grid, brute_force, random));
  }
  for (ProxyId id = 300; id < 600; ++id) {
    const Aabb moved = boxes[(id * 7) % 600];
    grid.update(id, moved);
    brute_force.update(id, moved);
    if (id % 5 != 0) continue;
    ASSERT_NO_FATAL_FAILURE(expectQueriesLikeBruteForce(grid, brute_force, random));
  }
}

TEST(HGridWorlds, SegmentsNearTheLargestFloatMissNothing) {
  for (unsigned seed = 0; seed < 300; ++seed) {
    Random random(seed);
    std::vector<Aabb> boxes;
    const float far = float(random.logUniform(1e8, 3e38));
    const int count = 100 + random.below(400);
    for (int i = 0; i < count; ++i) {
      const float y = far * float(random.uniform(0.1, 1.0)) * (random.chance(0.5) ? 1.0f : 1e-3f);
      boxes.push_back({{far, y, far}, {far, y * 1.0001f, far}});
    }
    HGrid grid;
    test::BruteForce brute_force;
    grid.update(allIds(boxes.size()), boxes);
    brute_force.update(allIds(boxes.size()), boxes);
    for (int i = 0; i < 20; ++i) {
      const Segment segment{double(far) * Eigen::Vector3d(random.uniform(0.2, 1), random.uniform(0, 1), 0.5),
                            double(far) * Eigen::Vector3d(1.0, random.uniform(0.9, 1.1), 1.0), 0.0};
      ASSERT_EQ(test::alongOf(grid, segment), test::alongOf(brute_force, segment)) << seed;
    }
  }
}

TEST(HGridWorlds, SegmentsThatHardlyMoveAlongAnAxisMissNothing) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    Random random(seed);
    std::vector<Aabb> boxes;
    for (int i = random.below(20); i >= 0; --i) {
      boxes.push_back(boxAround(randomVector(random, -5, 5), randomVector(random, 0, 1)));
    }
    test::BruteForce brute_force;
    brute_force.update(allIds(boxes.size()), boxes);
    for (const Isa isa : test::supportedIsas()) {
      HGrid grid;
      grid.setIsa(isa);
      grid.update(allIds(boxes.size()), boxes);
      for (int i = 0; i < 40; ++i) {
        const Eigen::Vector3d from = randomVector(random, -5, 5);
        Segment segment{from, from, random.logUniform(0.1, 10.0)};
        for (int axis = 0; axis < 3; ++axis) {  // a step of 1e-60 is lost if it is added to another number
          if (random.chance(0.5)) segment.from[axis] = 0.0;
          segment.to[axis] = segment.from[axis] + random.logUniform(1e-60, 1e3) * (random.chance(0.5) ? 1.0 : -1.0);
        }
        ASSERT_EQ(test::idsAlong(grid, segment), test::idsAlong(brute_force, segment)) << seed << ", " << name(isa);
      }
    }
  }
}

TEST(HGridWorlds, BoxesThatAreAllEqualAllMeet) {
  const Aabb somewhere = {{-3.7f, 0, 12}, {-3.5f, 0.3f, 12.1f}}, point = {{5, 5, 5}, {5, 5, 5}};
  for (const Aabb& box : {somewhere, point}) {
    std::vector<Aabb> boxes(400, box);
    HGrid grid = test::gridOf(boxes, GridScale{});
    EXPECT_EQ(test::pairsOf(grid).size(), 400u * 399u / 2u);
    grid.insert(400, box);
    boxes.push_back(box);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    boxes.assign(401, {{1, 1, 1}, {2, 2, 2}});
    grid.update(allIds(401), boxes);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
  }
}

TEST(HGridWorlds, AHugeBoxAmongTinyOnesMeetsThemAll) {
  Random random(3);
  std::vector<Aabb> boxes;
  for (int i = 0; i < 3000; ++i)
    boxes.push_back(boxAround(randomVector(random, -2, 2), randomVector(random, 0.001, 0.1)));
  for (const double half : {1.5, 50.0, 1e4, 1e9}) {
    SCOPED_TRACE(std::to_string(half));
    boxes[1234] = boxAround({0, 0, 0}, Eigen::Vector3d::Constant(2 * half));
    HGrid grid = test::gridOf(boxes, GridScale::fitting(boxes));
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    for (const Aabb& now : {boxes[0], boxes[1234]}) {  // the huge box becomes small, then huge again
      boxes[1234] = now;
      grid.move({1234}, {now});
      ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    }
  }
}

TEST(HGridWorlds, BoxesWithoutSizeOnSomeAxesMeetWhereTheyTouch) {
  for (int axes = 0; axes < 8; ++axes) {  // bit k: the boxes have a size other than 0 on axis k
    SCOPED_TRACE("axes " + std::to_string(axes));
    Random random(unsigned(axes) + 1u);
    std::vector<Aabb> boxes(1000);
    for (Aabb& box : boxes) {
      for (int k = 0; k < 3; ++k) {
        box.min[k] = 0.25f * float(random.between(-16, 16));
        box.max[k] = box.min[k] + (axes >> k & 1 ? 0.25f * float(random.between(0, 3)) : 0.f);
      }
    }
    HGrid grid = test::gridOf(boxes, GridScale{});
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    for (Aabb& box : boxes) box = {box.min * -2, (box.max * -2).cwiseMax(box.min * -2)};
    grid.update(allIds(boxes.size()), boxes);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
  }
}

TEST(HGridWorlds, MoreThan65536BoxesAreRightWithThreads) {
  Random random(4);
  std::vector<Aabb> boxes = crowd(70000, random);
  for (Aabb& box : boxes) {  // stretches the world along x, because the reference is fastest in a long world
    const Eigen::Vector3f way(5 * box.min.x(), 0, 0);
    box = {box.min + way, box.max + way};
  }
  HGrid grid;
  grid.setThreads(3);
  grid.update(allIds(boxes.size()), boxes);
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
  for (std::size_t i = 0; i < boxes.size(); i += 9) boxes[i] = boxes[(i * 7919) % boxes.size()];
  grid.update(allIds(boxes.size()), boxes);
  grid.remove(69999);
  grid.insert(69999, boxes[69999]);
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
}

/// Claim: the results are correct even if the grid chose the cells for the boxes before their last move.
TEST(HGridWorlds, AllBoxesMayLeaveTheirPlaceAtOnce) {
  Random random(5);
  const std::vector<Aabb> home = crowd(1500, random);
  std::vector<Aabb> boxes = home;
  HGrid grid = test::gridOf(boxes, GridScale{});
  const auto expectRightAs = [&](const char* what, auto&& moved) {
    SCOPED_TRACE(what);
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = moved(home[i], float(i));
    grid.update(allIds(boxes.size()), boxes);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
    grid.move({3, 700}, {boxes[700], boxes[3]});
    std::swap(boxes[3], boxes[700]);
    ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes));
  };
  const auto shifted = [](const Aabb& box, const Eigen::Vector3f& way) { return Aabb{box.min + way, box.max + way}; };
  const auto scaled = [](const Aabb& box, float by) { return Aabb{box.min * by, box.max * by}; };
  expectRightAs("far away", [&](const Aabb& box, float) { return shifted(box, {1e5f, -1e5f, 1e5f}); });
  expectRightAs("back at the first positions", [&](const Aabb& box, float) { return box; });
  expectRightAs("a thousand times as large", [&](const Aabb& box, float) { return scaled(box, 1e3f); });
  expectRightAs("a thousandth as large", [&](const Aabb& box, float) { return scaled(box, 1e-3f); });
  expectRightAs("on a line", [&](const Aabb& box, float i) {
    return Aabb{{i, 0, 0}, {i + 1.5f * (box.max.x() - box.min.x()), 0, 0}};
  });
  expectRightAs("half of the boxes at the other side of the world", [&](const Aabb& box, float i) {
    return shifted(box, {i < 750 ? 0.f : -1e6f, 0, 0});
  });
  expectRightAs("within the same bounds, but most boxes in one corner", [&](const Aabb& box, float i) {
    return i < 20 ? box : scaled(shifted(box, {20, 20, 20}), 0.1f);
  });
}

TEST(HGridWorlds, IdsWithGapsUpToAMillion) {
  Random random(6);
  std::vector<Aabb> boxes(1000001);
  std::vector<ProxyId> ids;
  const std::vector<Aabb> some = crowd(300, random);
  std::vector<Aabb> chosen;
  for (ProxyId id = 0; id <= 1000000; id += 2500) ids.push_back(id);
  for (std::size_t i = 0; i < ids.size(); ++i) chosen.push_back(boxes[ids[i]] = some[i % some.size()]);
  HGrid grid;
  grid.update(ids, chosen);
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
  for (int i = 0; i < 100; ++i) {
    const ProxyId id = 2500 * ProxyId(i) + 17;
    boxes[id] = some[std::size_t(random.below(300))];
    grid.insert(id, boxes[id]);
    grid.remove(ids[std::size_t(3 * i)]);
    ids[std::size_t(3 * i)] = id;
  }
  std::sort(ids.begin(), ids.end());
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, ids));
  grid.clear();
  grid.insert(1000000, boxes[1000000]);
  ASSERT_NO_FATAL_FAILURE(expectRight(grid, boxes, {1000000}));
}

/// Claim: a query at the far end of a box finds the box, even if the length of the box was rounded down to a float.
TEST(HGridWorlds, ALengthThatWasRoundedDownReachesFarEnough) {
  const float length = 1024;     // neighboring floats of this size differ by 2^-13
  std::vector<Aabb> boxes(193);  // for 193 boxes on a line, the grid chooses cells of 1/8 m
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const float step = -16 + 0.125f * float(i * 256 / (boxes.size() - 1)), sliver = i % 192 == 0 ? 0.f : 5e-5f;
    boxes[i] = {{step - sliver, 0, 0}, {length + step, 0, 0}};  // the box begins a little before a cell border
    ASSERT_EQ(boxes[i].max.x() - boxes[i].min.x(), length);
  }
  HGrid grid = test::gridOf(boxes, GridScale{});
  for (std::size_t i = 0; i < boxes.size(); i += 4) {
    const Eigen::Vector3f end = boxes[i].max;
    const Aabb beyond = {end, end};
    std::vector<ProxyId> expected;
    for (ProxyId id = 0; id < boxes.size(); ++id) {
      if (test::oracleOverlap(beyond, boxes[id])) expected.push_back(id);
    }
    ASSERT_EQ(test::foundBy(grid, beyond), expected);
    grid.insert(300, beyond);
    std::vector<ProxyId> met;
    for (const auto& pair : test::pairsOf(grid)) {
      if (pair.second == 300) met.push_back(pair.first);
    }
    ASSERT_EQ(met, expected);
    grid.remove(300);
  }
}

}  // namespace
}  // namespace hgrid
