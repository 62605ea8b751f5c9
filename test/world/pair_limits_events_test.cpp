// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests events and NearPair::since of pairs that are not listed because there are too many pairs.
#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "test/support/events.h"
#include "test/support/maps.h"

namespace hgrid {
namespace {

using test::at;
using test::eventsOf;
using Events = std::vector<std::string>;

/// Spheres of radius 0.5 m: "a" and "b" near x = 0 m, "c" and "d" near x = 10 m. A snapshot lists only one pair.
class PairLimitsEvents : public ::testing::Test {
 protected:
  static SceneOptions options(std::size_t max_pairs = 1, double horizon = 0.0) {
    SceneOptions options;
    options.margin = 0.125;
    options.event_hysteresis = 0.0625;
    options.max_pairs = max_pairs;
    options.horizon = horizon;
    return options;
  }
  BodyId put(const std::string& name, double x) { return test::put(*scene_, test::ball(name), at(x), Time{tick_ + 1}); }
  void place(BodyId id, double x) { scene_->place(id, at(x), Time{tick_ + 1}); }
  Events next() {
    snapshot_ = scene_->commit(Time{++tick_}, {});
    return eventsOf(*snapshot_);
  }
  /// Returns the listed pair as text, such as "obstacle/a obstacle/b since 1".
  std::string listed() const {
    if (snapshot_->pairs().size() != 1) return std::to_string(snapshot_->pairs().size()) + " pairs";
    const NearPair& pair = snapshot_->pairs()[0];
    const BodyList& bodies = snapshot_->structure().bodies;
    return bodies[pair.first].name + " " + bodies[pair.second].name + " since " + std::to_string(pair.since.count());
  }

  std::optional<Scene> scene_{options()};
  std::shared_ptr<const Snapshot> snapshot_;
  int tick_ = 0;
};

TEST_F(PairLimitsEvents, APairThatOnlyTruncationRemovesDoesNotEndAndDoesNotBeginAgain) {
  put("a", 0);
  const BodyId b = put("b", 1.1);
  put("c", 10);
  const BodyId d = put("d", 13);
  EXPECT_EQ(next(), Events({"1 BEGIN BODIES obstacle/a obstacle/b"}));
  place(d, 11);  // in contact with c
  EXPECT_EQ(next(), Events({"2 BEGIN MOVED obstacle/c obstacle/d"}));
  EXPECT_TRUE(snapshot_->truncated());
  EXPECT_EQ(listed(), "obstacle/c obstacle/d since 2");
  EXPECT_EQ(next(), Events());
  place(d, 13);
  EXPECT_EQ(next(), Events({"3 END MOVED obstacle/c obstacle/d"}));
  EXPECT_FALSE(snapshot_->truncated());
  EXPECT_EQ(listed(), "obstacle/a obstacle/b since 1") << "truncation has interrupted the pair";
  place(d, 11);
  next();
  place(b, 1.15);
  EXPECT_EQ(next(), Events()) << "a gap within the hysteresis must not end the pair";
  place(b, 1.1);
  EXPECT_EQ(next(), Events());
  place(b, 1.3);
  EXPECT_EQ(next(), Events({"5 END MOVED obstacle/a obstacle/b"}))
      << "bodies that move apart must end their pair, even if it was truncated";
}

TEST_F(PairLimitsEvents, OfABodyThatIsRemovedEnd) {
  const BodyId a = put("a", 0);
  put("b", 1.1);
  put("c", 10);
  const BodyId d = put("d", 13);
  next();
  place(d, 11);
  next();
  scene_->remove(a);
  EXPECT_EQ(next(), Events({"3 END BODIES obstacle/a obstacle/b"}));
}

TEST_F(PairLimitsEvents, APairOfTheHorizonThatIsCutDoesNotEnd) {
  scene_.emplace(options(1, 0.5));
  Body fast = test::ball("b");
  fast.max_speed = 2.0;
  test::put(*scene_, test::ball("a", 0.5, Mobility::fixed), at(0));
  const BodyId b = test::put(*scene_, fast, at(1.5));  // beyond the margin, but within the horizon
  test::put(*scene_, test::ball("c", 0.5, Mobility::fixed), at(10));
  Body slow = test::ball("d");
  slow.max_speed = 0.0;
  const BodyId d = test::put(*scene_, slow, at(13));
  next();
  EXPECT_EQ(listed(), "obstacle/a obstacle/b since 1");
  EXPECT_EQ(snapshot_->pairs()[0].flags, kHorizonFlag);
  place(d, 11);
  EXPECT_EQ(next(), Events({"2 BEGIN MOVED obstacle/c obstacle/d"}));
  EXPECT_EQ(listed(), "obstacle/c obstacle/d since 2");
  place(d, 13);
  EXPECT_EQ(next(), Events()) << "c and d passed each other in this tick";
  EXPECT_EQ(next(), Events({"3 END MOVED obstacle/c obstacle/d"}));
  EXPECT_EQ(listed(), "obstacle/a obstacle/b since 1");
  place(d, 11);
  next();
  place(b, 5.0);
  EXPECT_EQ(next(), Events({"5 END MOVED obstacle/a obstacle/b"}));
}

TEST_F(PairLimitsEvents, APairWithAMapThatIsCutDoesNotEnd) {
  const BodyId map = test::put(*scene_, test::mapBody("room"), at(0));
  scene_->setCells(map, test::cellsOf(0.1, {{Voxel::kOriginKey, Voxel::kOriginKey, Voxel::kOriginKey, 0}}));
  const BodyId b = put("b", 0.7);
  put("c", 10);
  const BodyId d = put("d", 13);
  EXPECT_EQ(next(), Events({"1 BEGIN BODIES map/room obstacle/b"}));
  place(d, 11);
  EXPECT_EQ(next(), Events({"2 BEGIN MOVED obstacle/c obstacle/d"}));
  place(d, 13);
  EXPECT_EQ(next(), Events({"3 END MOVED obstacle/c obstacle/d"}));
  EXPECT_EQ(listed(), "map/room obstacle/b since 1");
  place(d, 11);
  next();
  place(b, 5.0);
  EXPECT_EQ(next(), Events({"5 END MOVED map/room obstacle/b"}));
}

/// Claims about bodies that move at random:
/// - A pair ends before it begins again.
/// - A pair does not end while its gap exceeds the margin by at most the hysteresis.
/// - At most four times as many pairs as the limit have begun and not ended.
/// - If there are fewer such pairs, all listed pairs are among them.
TEST(PairLimitsEventsModel, EventsAreConsistentWhateverIsTruncated) {
  std::size_t cut = 0, full = 0, ends = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    SceneOptions options;
    options.margin = 0.125;
    options.event_hysteresis = 0.0625;
    options.max_pairs = std::size_t(random.between(1, 8));
    Scene scene(options);
    std::vector<BodyId> bodies;
    for (int i = 0; i < 14; ++i) bodies.push_back(test::put(scene, test::ball(std::to_string(10 + i), 0.1), at(0)));
    std::map<std::pair<std::uint32_t, std::uint32_t>, Time> on;
    for (int tick = 1; tick <= 60; ++tick) {
      // While the bodies are crowded, most pairs stay near. But the pairs with the smallest gaps change.
      const double far = (tick / 15) % 2 == 0 ? 0.3 : 3.0;
      for (const BodyId id : bodies) {
        if (random.chance(0.5)) scene.place(id, at(random.uniform(-far, far), random.uniform(-far, far)), Time{tick});
      }
      const auto snapshot = scene.commit(Time{tick}, {});
      std::size_t ended = 0;
      for (const PairEvent& event : snapshot->events()) {
        const auto key = std::make_pair(event.first, event.second);
        if (event.kind == EventKind::begin) {
          EXPECT_TRUE(on.emplace(key, event.since).second) << "the pair begins twice";
          continue;
        }
        ++ended;
        ASSERT_EQ(on.count(key), 1u) << "the pair ends, but it never began";
        EXPECT_EQ(on[key], event.since);
        EXPECT_GT(event.gap, options.margin + options.event_hysteresis);
        on.erase(key);
      }
      const std::size_t most = 4 * options.max_pairs;
      ASSERT_LE(on.size(), most);
      for (const NearPair& pair : snapshot->pairs()) {
        const auto found = on.find({pair.first, pair.second});
        EXPECT_TRUE(found != on.end() || on.size() + ended >= most);
      }
      for (const auto& pair : on) {
        EXPECT_LE(distance(snapshot->boxes()[pair.first.first], snapshot->boxes()[pair.first.second]),
                  options.margin + options.event_hysteresis + 1e-6);
      }
      ends += ended;
      cut += snapshot->truncated();
      full += on.size() == most;
    }
  }
  EXPECT_GT(cut, 300u);
  EXPECT_GT(full, 20u);
  EXPECT_GT(ends, 1000u);
}

}  // namespace
}  // namespace hgrid
