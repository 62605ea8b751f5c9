// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/explain/allowed_matrix.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/bodies/name.h"
#include "test/support/refusals.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::allow;
using test::enable;
using test::Random;

constexpr std::size_t kAll = 1000000;

/// Returns a snapshot of two arms and four obstacles with these rules. One of the arms has an SRDF.
std::shared_ptr<const Snapshot> cellWith(const std::vector<PairRule>& rules) {
  Scene scene{SceneOptions{}};
  LinkRules srdf;
  srdf.disabled = {{"elbow", "base", "Never <ever> & \"so\""}};
  srdf.enabled = {{"hand", "elbow", ""}};
  for (const Body& body : test::armBodies("left", srdf)) test::put(scene, body, test::at(0));
  for (const Body& body : test::armBodies("right")) test::put(scene, body, test::at(0));
  for (const char* name : {"box", "crate"}) test::put(scene, test::ball(name), test::at(0));
  for (const char* name : {"wall", "floor"}) test::put(scene, test::ball(name, 0.5, Mobility::fixed), test::at(0));
  scene.setRules(rules);
  return scene.commit(Time{1}, {});
}

/// Returns each entry as text: "first second origin +" if the pair is allowed, otherwise with "-" instead of "+".
std::vector<std::string> gist(const AllowedList& list) {
  std::vector<std::string> lines;
  for (const PairRule& entry : list.entries) {
    lines.push_back(entry.first + " " + entry.second + " " + std::to_string(int(entry.origin)) +
                    (entry.allowed ? " +" : " -"));
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(AllowedMatrix, ListsWhatTheModelsSay) {
  const auto snapshot = cellWith({});
  const AllowedList list = decidedPairs(snapshot->structure(), {"", "", kAll});
  EXPECT_EQ(gist(list), Lines({"left/base left/elbow 3 +", "left/base left/shoulder 1 +", "left/elbow left/hand 3 -",
                               "left/elbow left/shoulder 2 +", "right/base right/shoulder 1 +",
                               "right/elbow right/hand 2 +", "right/elbow right/shoulder 2 +"}));
  EXPECT_EQ(list.total, 7u);
  EXPECT_EQ(list.entries[0].reason, "Never <ever> & \"so\"");
}

TEST(AllowedMatrix, GlobsChooseInEitherOrder) {
  const auto snapshot = cellWith({allow("obstacle/box", "*/hand", "it grips it")});
  const Structure& structure = snapshot->structure();
  const Lines box = {"left/hand obstacle/box 5 +", "obstacle/box right/hand 5 +"};
  EXPECT_EQ(gist(decidedPairs(structure, {"obstacle/*", "", kAll})), box);
  EXPECT_EQ(gist(decidedPairs(structure, {"", "obstacle/*", kAll})), box);
  EXPECT_EQ(gist(decidedPairs(structure, {"right/*", "obstacle/box", kAll})), Lines({box[1]}));
  EXPECT_EQ(gist(decidedPairs(structure, {"obstacle/box", "right/*", kAll})), Lines({box[1]}));
  EXPECT_TRUE(gist(decidedPairs(structure, {"obstacle/wall", "", kAll})).empty());
  EXPECT_EQ(decidedPairs(structure, {"obstacle/*", "", kAll}).entries[1].reason, "it grips it");
}

TEST(AllowedMatrix, ALimitCutsAndTheTotalStays) {
  const auto snapshot = cellWith({allow("*", "*"), enable("right/hand", "obstacle/wall")});
  const AllowedList all = decidedPairs(snapshot->structure(), {"", "", kAll});
  EXPECT_EQ(all.total, 12u * 11 / 2 - 1) << "every pair except that of the two fixed bodies";
  const AllowedList few = decidedPairs(snapshot->structure(), {"", "", 5});
  EXPECT_EQ(few.total, all.total);
  ASSERT_EQ(few.entries.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(gist(few)[i], gist(all)[i]);
}

TEST(AllowedMatrix, RulesAreListedAsTheyWereGiven) {
  const auto end = PairRule::Clock::now() + std::chrono::hours(1);
  const auto snapshot = cellWith({allow("right/*", "obstacle/box"), test::until(enable("left/hand", "*"), end),
                                  allow("left/hand", "*", "again"), allow("nobody", "no one")});
  const Structure& structure = snapshot->structure();
  const AllowedList all = givenRules(structure, {"", "", kAll});
  EXPECT_EQ(gist(all), Lines({"right/* obstacle/box 5 +", "left/hand * 5 -", "left/hand * 5 +", "nobody no one 5 +"}))
      << "rules must be listed in the order in which they were given";
  EXPECT_EQ(all.entries[1].ends, end);
  EXPECT_EQ(gist(givenRules(structure, {"obstacle/*", "right/*", kAll})), Lines({"right/* obstacle/box 5 +"}));
  EXPECT_EQ(givenRules(structure, {"", "", 3}).entries.size(), 3u);
  EXPECT_EQ(givenRules(structure, {"", "", 3}).total, 4u);
}

TEST(AllowedMatrix, IsWhatAScanOfAllPairsFindsForAnyRules) {
  const std::vector<std::string> names = {"*", "left/*", "obstacle/*", "*/elbow", "left/hand", "obstacle/box", "l*/h*"};
  std::size_t found = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto name = [&] { return names[std::size_t(random.below(7))]; };
    std::vector<PairRule> rules;
    for (int i = random.between(0, 5); i > 0; --i) {
      rules.push_back(random.chance(0.7) ? allow(name(), name()) : enable(name(), name()));
    }
    const auto snapshot = cellWith(rules);
    const Structure& s = snapshot->structure();
    const std::string first = random.chance(0.3) ? "" : name(), second = random.chance(0.3) ? "" : name();
    const auto is = [](const std::string& glob, const Body& body) { return glob.empty() || matches(glob, body.name); };
    Lines expected;
    for (std::uint32_t i = 0; i < s.bodies.size(); ++i) {
      for (std::uint32_t j = i + 1; j < s.bodies.size(); ++j) {
        const Body &a = s.bodies[i], &b = s.bodies[j];
        const PairDecision decision = s.filter.decision(i, j);
        const bool asked = (is(first, a) && is(second, b)) || (is(first, b) && is(second, a));
        if (!asked || decision.origin == Origin::none || decision.origin == Origin::kind) continue;
        expected.push_back(a.name + " " + b.name + " " + std::to_string(int(decision.origin)) +
                           (decision.allowed ? " +" : " -"));
      }
    }
    const AllowedList list = decidedPairs(s, {first, second, kAll});
    ASSERT_EQ(gist(list), expected);
    ASSERT_EQ(list.total, expected.size());
    found += expected.size();
  }
  EXPECT_GT(found, 1000u);
}

TEST(AllowedMatrix, SrdfHasThePairsOfEachRobotInOrderUnderItsNameInTheUrdf) {
  const auto snapshot = cellWith({allow("right/hand", "obstacle/box"), allow("left/hand", "right/hand")});
  const Structure& structure = snapshot->structure();
  EXPECT_EQ(
      srdfOf(structure, decidedPairs(structure, {"", "", kAll}).entries),
      "<robot name=\"arm\">\n"
      "  <disable_collisions link1=\"base\" link2=\"elbow\" reason=\"Never &lt;ever&gt; &amp; &quot;so&quot;\"/>\n"
      "  <disable_collisions link1=\"base\" link2=\"shoulder\" reason=\"they move as one\"/>\n"
      "  <enable_collisions link1=\"elbow\" link2=\"hand\" reason=\"\"/>\n"
      "  <disable_collisions link1=\"elbow\" link2=\"shoulder\" reason=\"joint 'elbow_joint' connects them\"/>\n"
      "</robot>\n"
      "<robot name=\"arm\">\n"
      "  <disable_collisions link1=\"base\" link2=\"shoulder\" reason=\"they move as one\"/>\n"
      "  <disable_collisions link1=\"elbow\" link2=\"hand\" reason=\"joint 'hand_joint' connects them\"/>\n"
      "  <disable_collisions link1=\"elbow\" link2=\"shoulder\" reason=\"joint 'elbow_joint' connects them\"/>\n"
      "</robot>\n");
  EXPECT_EQ(srdfOf(structure, {allow("left/*", "left/hand"), allow("ghost/a", "left/hand")}), "");
}

TEST(AllowedMatrix, WhatWouldTakeTooManyLooksIsRefused) {
  std::vector<Body> bodies;
  for (int i = 0; i < 7000; ++i) bodies.push_back(test::ball(std::to_string(100000 + i)));
  Structure structure;
  structure.filter = PairFilter(bodies, {}, {allow("*", "*")});
  structure.bodies = std::move(bodies);
  std::string sentence;
  EXPECT_EQ(test::refusalOf([&] { decidedPairs(structure, {"", "", 1}); }, &sentence), Code::budget);
  EXPECT_TRUE(test::says(sentence, "use narrower globs, or ask for the rules"));
  EXPECT_EQ(decidedPairs(structure, {"obstacle/100000", "", 1}).total, 6999u);
}

}  // namespace
}  // namespace hgrid
