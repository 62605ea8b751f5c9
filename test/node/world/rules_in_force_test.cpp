// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/world/rules_in_force.h"

#include <gtest/gtest.h>

#include "test/support/rules.h"

namespace hgrid {
namespace {

using test::allow;
using test::enable;
using test::until;

/// Returns "first second" of each rule of the scene.
std::vector<std::string> rulesOf(const Scene& scene) {
  std::vector<std::string> lines;
  for (const PairRule& rule : scene.rules()) lines.push_back(rule.first + " " + rule.second);
  return lines;
}

TEST(RulesInForce, EachRuleEndsAtItsTime) {
  using Lines = std::vector<std::string>;
  const PairRule::Clock::time_point begin{std::chrono::hours(1)};
  const auto after = [&](int time) { return Moment{Time{0}, begin + std::chrono::seconds(time)}; };
  Scene scene{SceneOptions{}};
  RulesInForce rules;
  scene.setRules({allow("configured", "*")});
  rules.set({PairFilter({}, {},
                        {allow("configured", "*"), until(allow("a", "b"), begin + std::chrono::seconds(3)),
                         until(enable("c", "d"), begin + std::chrono::seconds(1)), allow("e", "f")}),
             0});
  rules.apply(after(0), {}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "a b", "c d", "e f"}));
  rules.apply(after(1), {}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "a b", "e f"}));
  scene.commit(Time{1}, {});
  rules.apply(after(2), {}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "a b", "e f"}));
  rules.apply(after(9), {}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "e f"}));
  EXPECT_EQ(scene.commit(Time{2}, {})->structure().filter.rules().size(), 2u);
}

TEST(RulesInForce, ARuleThatEndedBeforeItWasPassedOnNeverDecides) {
  const PairRule::Clock::time_point begin{std::chrono::hours(1)};
  Scene scene{SceneOptions{}};
  RulesInForce rules;
  rules.set({PairFilter({}, {}, {until(allow("a", "b"), begin)}), 0});
  rules.apply(Moment{Time{0}, begin + std::chrono::seconds(1)}, {}, {}, scene);
  EXPECT_TRUE(scene.rules().empty());
}

/// Returns a rule for what may touch an attached obstacle.
PairRule touching(const std::string& first, const std::string& second) {
  PairRule rule = allow(first, second);
  rule.origin = Origin::attached;
  return rule;
}

/// A scene with one configured rule. Nothing depends on the time.
class RulesBesideAConfiguredOne : public ::testing::Test {
 protected:
  using Lines = std::vector<std::string>;

  static PairRule configuredRule() {
    PairRule rule = allow("configured", "*");
    rule.origin = Origin::parameter;
    return rule;
  }
  static SceneOptions options() {
    SceneOptions options;
    options.allowed_pairs = {configuredRule()};
    return options;
  }

  const Moment now{Time{0}, PairRule::Clock::time_point{std::chrono::hours(1)}};
  Scene scene{options()};
  RulesInForce rules;
};

TEST_F(RulesBesideAConfiguredOne, ThoseOfAttachedObstaclesComeBetweenItAndTheAddedOnes) {
  rules.apply(now, {{touching("part", "hand")}, 1}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "part hand"}));
  const PairFilter added({}, {}, {configuredRule(), touching("part", "hand"), allow("a", "b")});
  rules.set({added, 0});
  rules.apply(now, {{touching("part", "hand")}, 1}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "part hand", "a b"}));
  rules.apply(now, {{touching("lid", "hand"), touching("part", "hand")}, 2}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "lid hand", "part hand", "a b"}));
  rules.set({added, 0});  // it was prepared before "lid" was attached
  rules.apply(now, {{touching("lid", "hand"), touching("part", "hand")}, 2}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "lid hand", "part hand", "a b"}));
  rules.apply(now, {{}, 3}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "a b"}));
  rules.set({added, 0});  // it was prepared before "part" was detached
  rules.apply(now, {{}, 3}, {}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "a b"}));
}

TEST_F(RulesBesideAConfiguredOne, ThoseOfMoveItComeFirstAndAreReplacedAsAWhole) {
  PairRule one = allow("hand", "part"), other = allow("hand", "lid");
  one.origin = other.origin = Origin::moveit;
  rules.apply(now, {{touching("part", "hand")}, 1}, {{one, other}, 1}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"hand part", "hand lid", "configured *", "part hand"}));
  rules.set({PairFilter({}, {}, {configuredRule(), allow("a", "b")}), 0});  // prepared before the matrix came
  rules.apply(now, {{touching("part", "hand")}, 1}, {{one, other}, 1}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"hand part", "hand lid", "configured *", "part hand", "a b"}));
  one.allowed = false;
  rules.apply(now, {{touching("part", "hand")}, 1}, {{one}, 2}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"hand part", "configured *", "part hand", "a b"}));
  EXPECT_FALSE(scene.rules().front().allowed);
  rules.apply(now, {{}, 2}, {{}, 3}, scene);
  EXPECT_EQ(rulesOf(scene), Lines({"configured *", "a b"}));
}

}  // namespace
}  // namespace hgrid
