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
  EXPECT_EQ(snapshot.pairs().size(), expected->pairs().size());
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

TEST(SceneReuse, ASnapshotThatWasUsedBeforeSaysWhatANewOneWould) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Scene scene{SceneOptions{}};
    std::map<std::string, BodyPose> told;
    std::vector<std::shared_ptr<const Snapshot>> held;
    for (int tick = 1; tick <= 60; ++tick) {
      const int changes = random.below(4);  // so few that most bodies rest for many ticks
      for (int change = 0; change < changes; ++change) {
        const std::string name = std::to_string(random.below(12));
        BodyId id;
        if (!scene.find("obstacle/" + name, id)) {
          scene.add(test::ball(name));
          told[name] = BodyPose{};
        } else if (random.below(10) == 0) {
          scene.remove(id);
          told.erase(name);
        } else {
          BodyPose& pose = told[name];
          pose.world_from_body = test::at(random.uniform(-5.0, 5.0));
          pose.stamp = Time{tick};
          pose.state = static_cast<Freshness>(random.below(4));
          pose.age = random.uniform(0.0, 2.0);
          pose.cohort = static_cast<std::uint32_t>(random.below(3));
          scene.place(id, pose.world_from_body, pose.stamp);
          scene.setState(id, pose.state, pose.age, pose.cohort);
        }
      }
      held.push_back(scene.commit(Time{tick}, {}));
      expectAsFromANewScene(*held.back(), told);
      // Releases snapshots in random order. Then the scene also reuses old ones.
      while (static_cast<int>(held.size()) > random.below(5)) {
        held.erase(held.begin() + random.below(static_cast<int>(held.size())));
      }
    }
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
