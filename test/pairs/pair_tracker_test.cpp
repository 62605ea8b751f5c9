// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/pairs/pair_tracker.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "test/support/random.h"

namespace hgrid {
namespace {

using Ids = std::vector<BodyId>;

std::vector<Time> sinceOf(PairTracker& tracker, const Ids& ids, int stamp, std::vector<NearPair> pairs) {
  for (NearPair& pair : pairs) pair.since = Time{-1};  // update() must replace this value
  tracker.update(ids, Time{stamp}, pairs);
  tracker.accept();
  std::vector<Time> since;
  for (const NearPair& pair : pairs) since.push_back(pair.since);
  return since;
}

std::vector<Time> times(std::initializer_list<int> values) {
  std::vector<Time> result;
  for (const int value : values) result.push_back(Time{value});
  return result;
}

const Ids kThree = {{0, 0}, {1, 0}, {2, 0}};

TEST(PairTracker, KeepsTheFirstStampWhileAPairStays) {
  PairTracker tracker;
  EXPECT_EQ(sinceOf(tracker, kThree, 10, {{0, 1}}), times({10}));
  EXPECT_EQ(sinceOf(tracker, kThree, 20, {{0, 1}, {1, 2}}), times({10, 20}));
  EXPECT_EQ(sinceOf(tracker, kThree, 30, {{0, 1}, {1, 2}}), times({10, 20}));
}

TEST(PairTracker, BeginsAgainAfterAnInterruption) {
  PairTracker tracker;
  sinceOf(tracker, kThree, 10, {{0, 1}});
  EXPECT_EQ(sinceOf(tracker, kThree, 20, {}), times({}));
  EXPECT_EQ(sinceOf(tracker, kThree, 30, {{0, 1}}), times({30}));
}

TEST(PairTracker, NamesThePairsThatEnded) {
  using Ended = std::vector<std::pair<BodyId, BodyId>>;
  PairTracker tracker;
  sinceOf(tracker, kThree, 10, {{0, 1}, {0, 2}, {1, 2}});
  EXPECT_EQ(tracker.ended(), Ended());
  sinceOf(tracker, kThree, 20, {{0, 2}});
  EXPECT_EQ(tracker.ended(), (Ended{{{0, 0}, {1, 0}}, {{1, 0}, {2, 0}}}));
  sinceOf(tracker, {{0, 0}, {1, 0}}, 30, {});  // body 2 was removed, so its pair ends
  EXPECT_EQ(tracker.ended(), (Ended{{{0, 0}, {2, 0}}}));
  sinceOf(tracker, kThree, 40, {{0, 1}});
  EXPECT_EQ(tracker.ended(), Ended());
}

TEST(PairTracker, ANewNumberingOfTheBodiesDoesNotInterrupt) {
  PairTracker tracker;
  sinceOf(tracker, kThree, 10, {{0, 1}, {1, 2}});
  const Ids turned = {{2, 0}, {7, 0}, {1, 0}, {0, 0}};  // a body was added, and the order of the bodies changed
  EXPECT_EQ(sinceOf(tracker, turned, 20, {{0, 1}, {0, 2}, {2, 3}}), times({20, 10, 10}));
}

TEST(PairTracker, AReusedSlotIsAnotherBody) {
  PairTracker tracker;
  sinceOf(tracker, kThree, 10, {{0, 1}});
  EXPECT_EQ(sinceOf(tracker, {{0, 0}, {1, 1}}, 20, {{0, 1}}), times({20}));
}

TEST(PairTracker, ClearForgetsAll) {
  PairTracker tracker;
  sinceOf(tracker, kThree, 10, {{0, 1}});
  tracker.clear();
  EXPECT_EQ(sinceOf(tracker, kThree, 20, {{0, 1}}), times({20}));
}

TEST(PairTracker, AgreesWithASimpleModelOverManyTicks) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    PairTracker tracker;
    std::map<std::set<std::uint32_t>, int> model;
    for (int stamp = 1; stamp <= 100; ++stamp) {
      Ids ids;  // the bodies 0 .. 9 in random order
      for (std::uint32_t slot = 0; slot < 10; ++slot) ids.insert(ids.begin() + random.between(0, int(slot)), {slot, 3});
      std::vector<NearPair> pairs;
      std::map<std::set<std::uint32_t>, int> next;
      std::vector<Time> expected;
      for (std::uint32_t i = 0; i < 10; ++i) {
        for (std::uint32_t j = i + 1; j < 10; ++j) {
          const std::set<std::uint32_t> key = {ids[i].slot, ids[j].slot};
          if (random.chance(model.count(key) != 0 ? 0.2 : 0.7)) continue;
          next[key] = model.count(key) != 0 ? model[key] : stamp;
          pairs.push_back({i, j});
          expected.push_back(Time{next[key]});
        }
      }
      ASSERT_EQ(sinceOf(tracker, ids, stamp, pairs), expected) << "tick " << stamp;
      model.swap(next);
    }
  }
}

}  // namespace
}  // namespace hgrid
