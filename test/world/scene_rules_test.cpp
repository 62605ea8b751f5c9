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

/// Returns the result of PairFilter::match() of the filter of a snapshot.
NameMatches matched(const Snapshot& snapshot, std::vector<std::string> names) {
  return snapshot.structure().filter.match(std::move(names));
}

TEST_F(SceneRules, AllowTheSamePairsIfNamesWerePrepared) {
  const PairRule grip = allow("obstacle/l*", "arm/h*"), rigid = enable("arm/s*", "arm/base"), box = allow("*", "*/box");
  const std::vector<PairRule> other{allow("obstacle/m*", "arm/h*"), rigid, box};
  enum class Change { none, set, set_prepared, removed };
  for (const Change change : {Change::none, Change::set, Change::set_prepared, Change::removed}) {
    for (const bool added_first : {false, true}) {  // whether the bodies were added before the rules changed
      NamePairs pairs[2];
      for (const bool prepares : {false, true}) {
        scene_.setRules({grip, rigid, box});
        const NameMatches matches = matched(now(), {"obstacle/late", "obstacle/more", "obstacle/never"});
        if (prepares) scene_.prepareNames(matches);
        std::vector<BodyId> ids;
        const auto add = [&] {
          for (const char* name : {"late", "more"}) ids.push_back(test::put(scene_, test::ball(name), test::at(0)));
        };
        if (added_first) add();
        if (change == Change::set) scene_.setRules(other);
        if (change == Change::set_prepared) {
          const Structure& structure = snapshot_->structure();
          scene_.setPreparedRules({PairFilter(structure.bodies, {}, other), structure.revision});
        }
        if (change == Change::removed) scene_.removeRules({true, false, false});
        if (!added_first) add();
        pairs[prepares] = test::namedPairs(now());
        for (const BodyId id : ids) scene_.remove(id);
      }
      EXPECT_EQ(pairs[0], pairs[1]);
      EXPECT_EQ(pairs[1].count({"arm/hand", "obstacle/late"}), change == Change::none ? 0u : 1u);
      const bool sets_other = change == Change::set || change == Change::set_prepared;
      EXPECT_EQ(pairs[1].count({"arm/hand", "obstacle/more"}), sets_other ? 0u : 1u);
    }
  }
}

/// Claim: only the next commit with a new structure uses the prepared names. The test sets wrong bits to detect the
/// use.
TEST_F(SceneRules, UsePreparedNamesOnce) {
  scene_.setRules({allow("arm/*", "obstacle/*")});
  NameMatches matches = matched(now(), {"obstacle/late"});
  ASSERT_EQ(matches.as_second.size(), 1u);
  matches.as_second[0] = 0;
  scene_.prepareNames(matches);
  now();  // no new structure
  const std::pair<std::string, std::string> late{"arm/hand", "obstacle/late"};
  BodyId id = test::put(scene_, test::ball("late"), test::at(0));
  EXPECT_EQ(test::namedPairs(now()).count(late), 1u);
  scene_.remove(id);
  now();
  id = test::put(scene_, test::ball("late"), test::at(0));
  EXPECT_EQ(test::namedPairs(now()).count(late), 0u);
}

/// Claim: the scene keeps matches of at most SceneOptions::max_bodies names, and of at most 64 calls. The oldest are
/// dropped.
TEST(ScenePreparedNames, AreLimited) {
  SceneOptions options;
  options.max_bodies = 100;
  options.allowed_pairs = {allow("obstacle/*", "obstacle/*")};
  struct Row {
    std::size_t calls, names;  // the number of later calls, and how many names each of them has
    bool keeps;                // whether the matches of the first call are kept
  };
  for (const Row& row :
       {Row{63, 1, true}, Row{64, 1, false}, Row{1, 99, true}, Row{1, 100, false}, Row{2, 50, false}}) {
    SCOPED_TRACE(std::to_string(row.calls) + " calls");
    Scene scene(options);
    test::put(scene, test::ball("box"), test::at(0));
    const auto snapshot = scene.commit(Time{1}, {});
    NameMatches wrong = matched(*snapshot, {"obstacle/late"});
    wrong.as_first[0] = wrong.as_second[0] = 0;  // shows whether the scene keeps it
    scene.prepareNames(wrong);
    std::vector<std::string> others;
    for (std::size_t i = 0; i < row.names; ++i) others.push_back("obstacle/other" + std::to_string(i));
    for (std::size_t i = 0; i < row.calls; ++i) scene.prepareNames(matched(*snapshot, others));
    test::put(scene, test::ball("late"), test::at(0));
    EXPECT_EQ(scene.commit(Time{2}, {})->pairs().size(), row.keeps ? 1u : 0u);
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
