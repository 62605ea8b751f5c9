// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include "test/support/grids.h"

namespace hgrid {
namespace {

using test::Random;

/// Whether a sanitizer, with which fewer worlds are tried, makes everything slow.
const bool kTakesItsTime = test::countFromEnvironment("HGRID_TEST_WORLDS", 10000) < 10000;

/// A test that leaves out all pairs but those whose ids add up to a multiple of `divisor`, and counts what it is asked.
struct Divisible {
  ProxyId divisor = 1;
  mutable std::atomic<std::size_t> asked{0};

  static bool isKept(const void* context, ProxyId first, ProxyId second) {
    const auto& test = *static_cast<const Divisible*>(context);
    ++test.asked;
    return (first + second) % test.divisor == 0;
  }
  OverlapFilter filter() const { return OverlapFilter::of<isKept>(this); }
};

/// Boxes by id, those that are fixed, and what of their pairs is wanted and how many.
struct Task {
  std::vector<Aabb> boxes;
  std::vector<ProxyId> fixed;
  ProxyId divisor = 1;
  PairBound bound;
};

struct Found {
  test::Pairs pairs;  // sorted
  bool all = true;
  bool operator==(const Found& other) const { return pairs == other.pairs && all == other.all; }
};

/// The rule of PairBound, told once more.
Found ruleOf(const Task& task) {
  Found found;
  std::vector<bool> fixed(task.boxes.size());
  for (const ProxyId id : task.fixed) fixed[id] = true;
  std::size_t overlaps = 0;
  const auto collect = [&](ProxyId asker, ProxyId other) {
    if (++overlaps > task.bound.overlaps) return false;
    if ((asker + other) % task.divisor != 0) return true;
    if (found.pairs.size() == task.bound.pairs) return false;
    found.pairs.emplace_back(std::min(asker, other), std::max(asker, other));
    return true;
  };
  for (ProxyId asker = 0; asker < task.boxes.size() && found.all; ++asker) {
    if (fixed[asker]) continue;
    for (ProxyId other = 0; other < task.boxes.size() && found.all; ++other) {
      if (other == asker || !(fixed[other] || other > asker)) continue;
      if (overlap(task.boxes[asker], task.boxes[other])) found.all = collect(asker, other);
    }
  }
  std::sort(found.pairs.begin(), found.pairs.end());
  return found;
}

Found foundBy(const HGrid& grid) {
  std::vector<ProxyPair> pairs = {{7, 7}};  // what the buffer held before must go
  Found found;
  found.all = grid.boundedPairs(pairs);
  for (const ProxyPair& pair : pairs) found.pairs.emplace_back(pair.first, pair.second);
  std::sort(found.pairs.begin(), found.pairs.end());
  return found;
}

std::vector<ProxyId> idsOf(const std::vector<Aabb>& boxes) {
  std::vector<ProxyId> ids(boxes.size());
  std::iota(ids.begin(), ids.end(), 0u);
  return ids;
}

void setUp(HGrid& grid, const Task& task, const Divisible& divisible) {
  grid.setFixed(task.fixed);
  grid.setOverlapFilter(divisible.filter());
  grid.setPairBound(task.bound);
}

/// The grid of a task, come to in one of several ways.
HGrid gridComeTo(const Task& task, const Divisible& divisible, Random& random) {
  HGrid grid(test::scaleFor(task.boxes, random));
  const std::vector<Isa> isas = test::supportedIsas();
  grid.setIsa(isas[std::size_t(random.below(int(isas.size())))]);
  setUp(grid, task, divisible);
  std::vector<ProxyId> ids = idsOf(task.boxes);
  if (random.chance(0.3)) {  // one by one, in any order
    for (std::size_t i = ids.size(); i > 1; --i) std::swap(ids[i - 1], ids[std::size_t(random.below(int(i)))]);
    for (const ProxyId id : ids) grid.insert(id, task.boxes[id]);
    return grid;
  }
  std::vector<Aabb> before = task.boxes;
  const double share = random.chance(0.5) ? 0.1 : 0.8;  // few move, many move
  for (Aabb& box : before) {
    if (random.chance(share)) box = task.boxes[std::size_t(random.below(int(task.boxes.size())))];
  }
  std::vector<ProxyPair> pairs;
  grid.update(ids, before);
  if (random.chance(0.7)) grid.boundedPairs(pairs);  // from now on the grid keeps pairs of boxes that rest
  grid.update(ids, task.boxes);
  for (int i = random.below(4); i > 0; --i) {  // some move and come back
    const ProxyId id = ProxyId(random.below(int(ids.size())));
    grid.move({id}, {before[id]});
    if (random.chance(0.5)) grid.boundedPairs(pairs);
    grid.move({id}, {task.boxes[id]});
  }
  return grid;
}

/// Boxes of which many lie in a pile, and some anywhere.
Task randomTask(unsigned seed, Random& random) {
  Task task;
  task.boxes = test::worldOf(static_cast<test::Family>(seed % test::kFamilies), seed);
  if (task.boxes.empty()) task.boxes.push_back(test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  const Aabb pile = task.boxes.front();
  for (Aabb& box : task.boxes) {
    if (random.chance(0.5)) box = pile;
  }
  for (const ProxyId id : idsOf(task.boxes)) {
    if (random.chance(0.3)) task.fixed.push_back(id);
  }
  task.divisor = ProxyId(random.between(1, 3));
  const Found all = ruleOf(task);
  const auto part = [&](std::size_t whole) {
    return random.chance(0.3) ? PairBound::kNone : std::size_t(random.below(int(whole + whole / 4 + 2)));
  };
  task.bound.pairs = part(all.pairs.size());
  task.bound.overlaps = part(all.pairs.size() * task.divisor);
  return task;
}

/// Claim: the bounded search finds what the rule says, whatever the boxes, the bound, the instruction set and the way
/// to the world.
TEST(HGridBound, FindsWhatTheRuleSays) {
  int cut = 0, whole = 0;
  const unsigned seeds = kTakesItsTime ? 60 : 220;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Task task = randomTask(seed, random);
    const Found expected = ruleOf(task);
    (expected.all ? whole : cut) += 1;
    Divisible divisible;
    divisible.divisor = task.divisor;
    for (int way = 0; way < 5; ++way) {
      const HGrid grid = gridComeTo(task, divisible, random);
      const Found found = foundBy(grid);
      ASSERT_EQ(found.all, expected.all) << "way " << way;
      ASSERT_TRUE(found == expected) << "way " << way << ", " << found.pairs.size() << " pairs instead of "
                                     << expected.pairs.size();
      ASSERT_TRUE(foundBy(grid) == expected) << "a second search";
    }
  }
  EXPECT_GT(cut, 15);
  EXPECT_GT(whole, 15);
}

TEST(HGridBound, ExactlyAsManyPairsAsTheBoundAreAllPairs) {
  const std::vector<Aabb> boxes(40, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  HGrid grid = test::gridOf(boxes, GridScale{});
  constexpr std::size_t kPairs = 40 * 39 / 2;
  for (const bool by_overlaps : {false, true}) {
    for (const std::size_t bound : {std::size_t{0}, std::size_t{1}, kPairs - 1, kPairs, kPairs + 1}) {
      SCOPED_TRACE(bound);
      grid.setPairBound(by_overlaps ? PairBound{PairBound::kNone, bound} : PairBound{bound, PairBound::kNone});
      const Found found = foundBy(grid);
      EXPECT_EQ(found.pairs.size(), std::min(bound, kPairs));
      EXPECT_EQ(found.all, bound >= kPairs);
    }
  }
}

TEST(HGridBound, DoesNotApplyToTheSearchForAllPairs) {
  const std::vector<Aabb> boxes(40, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  HGrid grid = test::gridOf(boxes, GridScale{});
  grid.setPairBound({3, 3});
  EXPECT_EQ(test::pairsOf(grid).size(), 40u * 39u / 2u);
}

/// 40,000 boxes: a pile of `piled` in a hall where few overlap.
std::vector<Aabb> hallWithPile(std::size_t piled, Random& random) {
  std::vector<Aabb> boxes;
  while (boxes.size() < 40000) {
    const bool in_pile = boxes.size() % (40000 / piled) == 0;
    const Eigen::Vector3d center = in_pile ? Eigen::Vector3d(0.1, 0.2, 0.3) : test::randomVector(random, -25, 25);
    boxes.push_back(test::boxAround(center, Eigen::Vector3d::Constant(0.6)));
  }
  return boxes;
}

/// Claim: threads and instruction sets do not show, in a search that is cut and in one that is not, in a pile that
/// moves and in one that rests.
TEST(HGridBound, ThreadsAndInstructionSetsDoNotShow) {
  Random random(4);
  Task task;
  task.boxes = hallWithPile(500, random);
  task.divisor = 2;
  Divisible divisible;
  divisible.divisor = task.divisor;
  const std::vector<ProxyId> ids = idsOf(task.boxes);
  const std::vector<Isa> isas = kTakesItsTime ? std::vector<Isa>{bestIsa()} : test::supportedIsas();
  const std::vector<int> thread_counts = kTakesItsTime ? std::vector<int>{3} : std::vector<int>{1, 2, 4};
  for (const PairBound& bound :
       {PairBound{20000, PairBound::kNone}, PairBound{PairBound::kNone, 30000}, PairBound{1000000, 2000000}}) {
    task.bound = bound;
    const HGrid reference = gridComeTo(task, divisible, random);
    const Found expected = foundBy(reference);
    EXPECT_EQ(expected.all, bound.pairs == 1000000u);
    for (const Isa isa : isas) {
      for (const int threads : thread_counts) {
        for (const double share : {0.0, 0.05, 1.0}) {  // boxes that move
          SCOPED_TRACE(std::string(name(isa)) + ", threads " + std::to_string(threads) + ", share " +
                       std::to_string(share));
          HGrid grid;
          grid.setIsa(isa);
          grid.setThreads(threads);
          setUp(grid, task, divisible);
          std::vector<Aabb> before = task.boxes;
          for (Aabb& box : before) {
            if (random.chance(share)) box.max.x() += 0.1f;
          }
          grid.update(ids, before);
          foundBy(grid);  // from now on the grid keeps pairs of boxes that rest
          grid.update(ids, task.boxes);
          ASSERT_TRUE(foundBy(grid) == expected);
        }
      }
    }
  }
}

/// Claim: what one search asks of the filter is bounded, also where the filter leaves out every pair. The grid may look
/// at twice the bound, at one box's overlaps, and for each thread at the pairs that a buffer has room for.
TEST(HGridBound, BoundsTheWorkOfPilesWhosePairsAreAllLeftOut) {
  constexpr std::size_t kBoxes = 40000, kOverlaps = 100000, kBuffer = 2 * 65536;
  const std::vector<Aabb> boxes(kBoxes, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  std::vector<Aabb> moved = boxes;
  for (std::size_t i = 0; i < kBoxes; i += 100) moved[i].max.x() += 0.1f;
  for (const int threads : {1, 4}) {
    Divisible divisible;
    divisible.divisor = 1u << 30;
    HGrid grid;
    grid.setThreads(threads);
    grid.setOverlapFilter(divisible.filter());
    grid.setPairBound({1000, kOverlaps});
    for (int tick = 0; tick < 4; ++tick) {
      divisible.asked = 0;
      grid.update(idsOf(boxes), tick % 2 == 0 ? boxes : moved);
      const Found found = foundBy(grid);
      EXPECT_FALSE(found.all);
      EXPECT_TRUE(found.pairs.empty());
      EXPECT_LE(divisible.asked, 2 * (2 * kOverlaps + kBoxes) + 2 * std::size_t(threads) * kBuffer);
    }
  }
}

/// Claim: fixed boxes cost nothing among themselves.
TEST(HGridBound, FixedPilesAreNotCut) {
  const std::vector<Aabb> boxes(20000, test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  std::vector<ProxyId> fixed = idsOf(boxes);
  fixed.pop_back();
  HGrid grid;
  grid.setFixed(fixed);
  grid.setPairBound({20000, 20000});
  grid.update(idsOf(boxes), boxes);
  const Found found = foundBy(grid);
  EXPECT_TRUE(found.all);
  EXPECT_EQ(found.pairs.size(), 19999u);
}

/// Claim: when the pile is gone, so is the cut, and the search counts only what overlaps now.
TEST(HGridBound, EndsWithThePile) {
  std::vector<Aabb> boxes, pile;
  for (int i = 0; i < 1000; ++i) {
    boxes.push_back(test::boxAround(Eigen::Vector3d(2.0 * i, 0, 0), Eigen::Vector3d::Constant(0.6)));
    pile.push_back(i % 10 == 0 ? test::boxAround(Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.6))
                               : boxes.back());
  }
  HGrid grid;
  grid.setPairBound({100, 1000});
  for (int tick = 0; tick < 6; ++tick) {
    const bool piled = tick % 2 == 0;
    grid.update(idsOf(boxes), piled ? pile : boxes);
    EXPECT_EQ(foundBy(grid).all, !piled) << "tick " << tick;
  }
}

}  // namespace
}  // namespace hgrid
