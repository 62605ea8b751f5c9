// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::allow;
using test::enable;
using test::NamePairs;

/// An arm and a sphere, all at the origin.
class SceneRules : public ::testing::Test {
 protected:
  SceneRules() : scene_(SceneOptions{}) {
    for (const Body& body : test::armBodies("arm")) test::put(scene_, body, test::at(0));
    test::put(scene_, test::ball("box"), test::at(0));
  }
  const Snapshot& now() {
    snapshot_ = scene_.commit(Time{++tick_}, {});
    return *snapshot_;
  }

  Scene scene_;
  std::shared_ptr<const Snapshot> snapshot_;
  int tick_ = 0;
};

TEST_F(SceneRules, AreInForceFromTheNextTick) {
  const NamePairs before = test::namedPairs(now());
  const std::pair<std::string, std::string> grip{"arm/hand", "obstacle/box"}, rigid{"arm/base", "arm/shoulder"};
  EXPECT_EQ(before.count(grip), 1u);
  EXPECT_EQ(before.count(rigid), 0u);
  const auto old = snapshot_;
  const std::uint64_t revision = scene_.revision();
  scene_.setRules({allow("obstacle/box", "arm/h*"), enable("arm/shoulder", "arm/base")});
  NamePairs after = test::namedPairs(now());
  EXPECT_GT(scene_.revision(), revision);
  EXPECT_EQ(after.count(grip), 0u);
  EXPECT_EQ(after.count(rigid), 1u);
  EXPECT_EQ(test::namedPairs(*old), before) << "the new rules have changed an old snapshot";
  after.erase(rigid);
  after.insert(grip);
  EXPECT_EQ(after, before) << "the rules have changed other pairs as well";
  scene_.setRules({});
  EXPECT_EQ(test::namedPairs(now()), before);
}

TEST_F(SceneRules, HoldForBodiesThatComeLaterAndLeaveSinceAlone) {
  scene_.setRules({allow("obstacle/late*", "*"), enable("arm/base", "arm/shoulder")});
  EXPECT_EQ(now().pairs().front().since, Time{1});
  test::put(scene_, test::ball("late"), test::at(0));
  for (const auto& pair : test::namedPairs(now())) {
    EXPECT_NE(pair.first, "obstacle/late");
    EXPECT_NE(pair.second, "obstacle/late");
  }
  scene_.setRules({enable("arm/base", "arm/shoulder")});
  EXPECT_EQ(test::namedPairs(now()).count({"obstacle/box", "obstacle/late"}), 1u);
  for (const NearPair& pair : snapshot_->pairs()) {
    const bool is_late = snapshot_->structure().bodies[pair.second].name == "obstacle/late";
    EXPECT_EQ(pair.since, is_late ? Time{3} : Time{1});
  }
}

TEST_F(SceneRules, ThatWerePreparedCountLikeOthersEvenIfBodiesChangedSince) {
  const std::vector<PairRule> rules{allow("obstacle/*", "arm/h*"), enable("arm/shoulder", "arm/base")};
  const auto prepared = [&] {
    const Structure& structure = now().structure();
    return PreparedRules{PairFilter(structure.bodies, {}, rules), structure.revision};
  };
  scene_.setRules(rules);
  const NamePairs wanted = test::namedPairs(now());
  scene_.setRules({});
  scene_.setPreparedRules(prepared());
  EXPECT_EQ(test::namedPairs(now()), wanted);
  for (const bool before : {true, false}) {  // whether the body was added before the rules were set, or after
    scene_.setRules({});
    const PreparedRules old = prepared();
    if (!before) scene_.setPreparedRules(old);
    const BodyId late = test::put(scene_, test::ball("a"), test::at(0));  // the indices of all other obstacles change
    if (before) scene_.setPreparedRules(old);
    EXPECT_EQ(test::namedPairs(now()).count({"arm/hand", "obstacle/a"}), 0u);
    EXPECT_EQ(test::namedPairs(*snapshot_).count({"obstacle/a", "obstacle/box"}), 1u);
    scene_.remove(late);
    EXPECT_EQ(test::namedPairs(now()), wanted);
  }
}

TEST_F(SceneRules, ThatAreRemovedDecideNoLonger) {
  const PairRule grip = allow("obstacle/*", "arm/h*"), rigid = enable("arm/shoulder", "arm/base");
  scene_.setRules({grip});
  const NamePairs wanted = test::namedPairs(now());
  for (const bool committed : {true, false}) {
    scene_.setRules({rigid, grip});
    if (committed) now();
    scene_.removeRules({true, false});
    EXPECT_EQ(scene_.rules().size(), 1u);
    EXPECT_EQ(test::namedPairs(now()), wanted) << committed;
  }
}

TEST_F(SceneRules, ThatSwitchOffEveryPairAreNoted) {
  EXPECT_FALSE(now().structure().silenced);
  scene_.setRules({allow("arm/*", "*")});
  EXPECT_TRUE(now().structure().silenced) << "the only body that is no link is the box";
  EXPECT_TRUE(snapshot_->pairs().empty());
  const BodyId crate = test::put(scene_, test::ball("crate"), test::at(0));
  EXPECT_FALSE(now().structure().silenced);
  scene_.remove(crate);
  EXPECT_TRUE(now().structure().silenced);
  scene_.setRules({allow("arm/*", "*"), enable("arm/base", "arm/hand")});
  EXPECT_FALSE(now().structure().silenced);
}

}  // namespace
}  // namespace hgrid
