// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/explain/changed_pairs.h"

#include <gtest/gtest.h>

#include <chrono>

#include "hgrid_proximity/pairs/rule_book.h"
#include "test/support/refusals.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::allow;
using test::enable;
using test::Random;

/// Returns two arms, two moving obstacles and two fixed obstacles. One of the arms has an SRDF.
std::vector<Body> cell() {
  LinkRules srdf;
  srdf.disabled = {{"elbow", "base", ""}};
  std::vector<Body> bodies = test::armBodies("left", srdf);
  for (const Body& body : test::armBodies("right")) bodies.push_back(body);
  for (const char* name : {"box", "crate"}) bodies.push_back(test::ball(name));
  for (const char* name : {"wall", "floor"}) bodies.push_back(test::ball(name, 0.5, Mobility::fixed));
  return bodies;
}

std::uint64_t bruteForce(std::size_t bodies, const PairFilter& before, const PairFilter& after) {
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < bodies; ++i) {
    for (std::uint32_t j = i + 1; j < bodies; ++j) count += before.allowed(i, j) != after.allowed(i, j) ? 1 : 0;
  }
  return count;
}

std::uint64_t changed(const std::vector<Body>& bodies, const std::vector<PairRule>& before,
                      const std::vector<PairRule>& after) {
  return changedPairs(bodies, PairFilter(bodies, PairKinds{}, before), PairFilter(bodies, PairKinds{}, after));
}

TEST(ChangedPairs, AreThoseThatARuleSwitchesOffOrOn) {
  const std::vector<Body> bodies = cell();
  const PairRule off = allow("left/hand", "right/hand"), all_off = allow("left/*", "right/*");
  EXPECT_EQ(changed(bodies, {}, {off}), 1u);
  EXPECT_EQ(changed(bodies, {off}, {}), 1u);
  EXPECT_EQ(changed(bodies, {}, {all_off}), 16u);
  EXPECT_EQ(changed(bodies, {all_off}, {off}), 15u);
  EXPECT_EQ(changed(bodies, {off}, {off, all_off}), 15u) << "one of the 16 pairs was off before";
  EXPECT_EQ(changed(bodies, {all_off}, {all_off, enable("right/hand", "left/hand")}), 1u);
}

TEST(ChangedPairs, AreNoneWhereARuleDecidesAsWhatDecidedBefore) {
  const std::vector<Body> bodies = cell();
  EXPECT_EQ(changed(bodies, {}, {}), 0u);
  EXPECT_EQ(changed(bodies, {}, {allow("left/base", "left/shoulder")}), 0u)
      << "a pair within a rigid group was off before";
  EXPECT_EQ(changed(bodies, {}, {allow("obstacle/wall", "obstacle/floor")}), 0u) << "fixed bodies make no pair";
  EXPECT_EQ(changed(bodies, {}, {enable("left/hand", "right/hand")}), 0u) << "the pair was reported before too";
  EXPECT_EQ(changed(bodies, {}, {allow("nobody", "*")}), 0u);
}

TEST(ChangedPairs, DependOnTheOrderOfTheRules) {
  const std::vector<Body> bodies = cell();
  const PairRule off = allow("left/*", "right/*"), on = enable("*", "right/hand");
  EXPECT_EQ(changed(bodies, {off, on}, {on, off}), 4u);
}

TEST(ChangedPairs, AreAsManyAsAScanOfAllPairsFindsForAnyRules) {
  const std::vector<Body> bodies = cell();
  const std::vector<std::string> names = {"*",         "left/*",    "obstacle/*",    "*/elbow",
                                          "l*/h*",     "left/hand", "obstacle/box",  "right/base",
                                          "left/base", "nobody",    "obstacle/wall", "*/base"};
  std::uint64_t all = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto randomRules = [&](int most) {
      std::vector<PairRule> rules;
      for (int i = random.between(0, most); i > 0; --i) {
        const std::string first = names[std::size_t(random.below(12))], second = names[std::size_t(random.below(12))];
        rules.push_back(random.chance(0.6) ? allow(first, second) : enable(first, second));
      }
      return rules;
    };
    const std::vector<PairRule> old_rules = randomRules(6);
    RuleBook book(old_rules);
    book.add(randomRules(3));
    const std::vector<PairRule> new_rules = random.chance(0.3) ? randomRules(6) : book.rules();
    PairKinds kinds;
    kinds.self = random.chance(0.8);
    const PairFilter before(bodies, kinds, old_rules), after(bodies, kinds, new_rules);
    const std::uint64_t count = changedPairs(bodies, before, after);
    EXPECT_EQ(count, bruteForce(bodies.size(), before, after));
    all += count;
  }
  EXPECT_GT(all, 1000u);
}

TEST(ChangedPairs, OfTenThousandBodiesTakeLessThanASecond) {
  std::vector<Body> bodies;
  for (int i = 0; i < 10000; ++i) bodies.push_back(test::ball(std::to_string(i)));
  const PairFilter before(bodies, PairKinds{}, {}), after(bodies, PairKinds{}, {allow("*", "*")});
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(changedPairs(bodies, before, after), 10000u * 9999u / 2u);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

}  // namespace
}  // namespace hgrid
