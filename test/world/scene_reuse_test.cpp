// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <map>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/maps.h"
#include "test/support/random.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::Random;

/// Compares a snapshot with a snapshot of a new scene that has the same bodies.
void expectAsFromANewScene(const Snapshot& snapshot, const std::map<std::string, BodyPose>& told) {
  Scene fresh{SceneOptions{}};
  for (const auto& named : told) {
    const BodyId id = fresh.add(test::ball(named.first));
    if (named.second.state == Freshness::unplaced) continue;
    fresh.place(id, named.second.world_from_body, named.second.stamp);
    fresh.setState(id, named.second.state, named.second.age, named.second.cohort);
  }
  const auto expected = fresh.commit(snapshot.stamp(), {});
  EXPECT_EQ(snapshot.boxes(), expected->boxes());
  EXPECT_EQ(snapshot.worstState(), expected->worstState());
  EXPECT_EQ(snapshot.maxAge(), expected->maxAge());
  EXPECT_EQ(snapshot.reasons(), expected->reasons());
  ASSERT_EQ(snapshot.pairs().size(), expected->pairs().size());
  for (std::size_t i = 0; i < snapshot.pairs().size(); ++i) {
    const NearPair &a = snapshot.pairs()[i], &b = expected->pairs()[i];
    EXPECT_TRUE(a.first == b.first && a.second == b.second && a.gap == b.gap && a.margin == b.margin) << i;
  }
  ASSERT_EQ(snapshot.poses().size(), expected->poses().size());
  for (std::size_t i = 0; i < snapshot.poses().size(); ++i) {
    const BodyPose &a = snapshot.poses()[i], &b = expected->poses()[i];
    EXPECT_EQ(a.world_from_body.matrix(), b.world_from_body.matrix());
    EXPECT_EQ(a.stamp, b.stamp);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.age, b.age);
    EXPECT_EQ(a.growth, b.growth);
    EXPECT_EQ(a.cohort, b.cohort);
  }
}

/// Changes a few random bodies in each tick, and holds snapshots for a random time. So a commit fills new snapshot
/// objects as well as objects that were used recently or long ago.
/// @param bodies  number of different names
/// @param leave   whether bodies are also removed, which changes the structure
void expectReuse(std::uint64_t seed, int bodies, bool leave) {
  Random random(seed);
  Scene scene{SceneOptions{}};
  std::map<std::string, BodyPose> told;
  std::vector<std::shared_ptr<const Snapshot>> held;
  for (int body = 0; !leave && body < bodies; ++body) {
    scene.add(test::ball(std::to_string(body)));
    told[std::to_string(body)] = BodyPose{};
  }
  int most_held = 5;
  for (int tick = 1; tick <= 120; ++tick) {
    const int changes = random.below(4);  // so few that most bodies rest for many ticks
    for (int change = 0; change < changes; ++change) {
      const std::string name = std::to_string(random.below(bodies));
      BodyId id;
      if (!scene.find("obstacle/" + name, id)) {
        scene.add(test::ball(name));
        told[name] = BodyPose{};
      } else if (leave && random.below(10) == 0) {
        scene.remove(id);
        told.erase(name);
      } else {
        BodyPose& pose = told[name];
        if (random.below(4) > 0) pose.world_from_body = test::at(random.uniform(-5.0, 5.0));
        pose.stamp = Time{tick};
        pose.state = random.below(2) == 0 ? Freshness::fresh : static_cast<Freshness>(random.below(4));
        pose.age = random.below(2) == 0 ? 0.0 : random.uniform(0.0, 2.0);
        pose.cohort = static_cast<std::uint32_t>(random.below(3));
        scene.place(id, pose.world_from_body, pose.stamp);
        scene.setState(id, pose.state, pose.age, pose.cohort);
      }
    }
    held.push_back(scene.commit(Time{tick}, {}));
    expectAsFromANewScene(*held.back(), told);
    // Releases snapshots in random order. Now and then, all are held for more ticks than the scene remembers.
    if (tick % 20 == 0) most_held = random.below(2) == 0 ? 14 : 5;
    while (static_cast<int>(held.size()) > random.below(most_held)) {
      held.erase(held.begin() + random.below(static_cast<int>(held.size())));
    }
  }
}

TEST(SceneReuse, ASnapshotThatWasUsedBeforeSaysWhatANewOneWould) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expectReuse(seed, 12, true);
    expectReuse(seed, 40, false);
    if (seed <= 5) expectReuse(seed, 200, false);  // so many that a tick visits only the changed ones
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(SceneReuse, SnapshotsThatNobodyReadsKeepNeitherOldMapsNorOldBodies) {
  const auto narrow_phase = makeCoreNarrowPhase();
  Scene scene{SceneOptions{}};
  Body tool = test::ball("tool");
  tool.shapes[0].solid = narrow_phase->solidOf(tool.shapes[0].shape);
  const std::weak_ptr<const Solid> solid = tool.shapes[0].solid;
  const BodyId tool_id = test::put(scene, tool, test::at(0));
  tool = Body{};
  test::put(scene, test::ball("part"), test::at(0));
  const BodyId room = test::put(scene, test::mapBody("room"), test::at(0));
  std::vector<std::shared_ptr<const Snapshot>> held;
  std::weak_ptr<const MapCells> cells;
  const auto tick = [&] { held.push_back(scene.commit(Time{1}, {})); };
  const auto setCells = [&] {
    const auto next = test::cellsOf(0.1, {{32768, 32768, 32768, 0}});
    cells = next;
    scene.setCells(room, next);
  };
  setCells();
  for (int i = 0; i < 4; ++i) tick();
  const std::weak_ptr<const MapCells> old_cells = cells;
  setCells();
  for (int i = 0; i < 2; ++i) tick();
  held.clear();
  EXPECT_TRUE(old_cells.expired()) << "the pool must release cells that were replaced";
  EXPECT_FALSE(cells.expired());
  for (int i = 0; i < 4; ++i) tick();
  scene.remove(tool_id);
  for (int i = 0; i < 2; ++i) tick();  // the first of these snapshots has an event of the body that was removed
  EXPECT_FALSE(solid.expired()) << "snapshots that are in use must keep their bodies";
  held.clear();
  EXPECT_TRUE(solid.expired()) << "the pool must release bodies that were removed";
}

}  // namespace
}  // namespace hgrid
