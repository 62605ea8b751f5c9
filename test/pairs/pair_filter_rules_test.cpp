// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>

#include "hgrid_proximity/bodies/name.h"
#include "test/support/models.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::allow;
using test::enable;
using test::Random;

enum Index : std::uint32_t { base, shoulder, elbow, hand, box, crate, wall, floor_ };

/// Returns an arm with an SRDF, two moving obstacles and two fixed ones. The arm's first two links form a rigid group.
std::vector<Body> cell() {
  LinkRules srdf;
  srdf.disabled = {{"elbow", "base", "Never"}};
  srdf.disabled_default = {"hand"};
  srdf.enabled = {{"hand", "elbow", "it reaches back"}};
  std::vector<Body> bodies = test::armBodies("arm", srdf);
  for (const char* name : {"box", "crate"}) bodies.push_back(test::ball(name));
  for (const char* name : {"wall", "floor"}) bodies.push_back(test::ball(name, 0.5, Mobility::fixed));
  return bodies;
}

/// Returns the decision about a pair. Checks that the decision does not depend on the order of the two bodies.
PairDecision decided(const PairFilter& filter, std::uint32_t a, std::uint32_t b) {
  const PairDecision there = filter.decision(a, b), back = filter.decision(b, a);
  EXPECT_EQ(there.origin, back.origin);
  EXPECT_EQ(there.allowed, back.allowed);
  EXPECT_EQ(there.rule, back.rule);
  EXPECT_EQ(there.reason, back.reason);
  EXPECT_EQ(there.allowed, filter.allowed(a, b)) << "decision() and allowed() differ";
  EXPECT_EQ(filter.origin(a, b), there.allowed ? there.origin : Origin::none);
  return there;
}

TEST(PairRules, WithoutRulesTheModelDecides) {
  const PairFilter filter(cell(), {}, {});
  struct Row {
    Index first, second;
    Origin origin;
    bool allowed;
    const char* reason;
  };
  const Row rows[] = {{base, base, Origin::self, true, ""},
                      {wall, floor_, Origin::kind, true, ""},
                      {base, shoulder, Origin::rigid, true, "they move as one"},
                      {shoulder, elbow, Origin::adjacent, true, "joint 'elbow_joint' connects them"},
                      {base, elbow, Origin::srdf, true, "Never"},
                      {base, hand, Origin::srdf, true, "disable_default_collisions"},
                      {elbow, hand, Origin::srdf, false, "it reaches back"},
                      {hand, box, Origin::none, false, ""},
                      {box, crate, Origin::none, false, ""}};
  for (const Row& row : rows) {
    SCOPED_TRACE(std::to_string(row.first) + " " + std::to_string(row.second));
    const PairDecision decision = decided(filter, row.first, row.second);
    EXPECT_EQ(decision.origin, row.origin);
    EXPECT_EQ(decision.allowed, row.allowed);
    EXPECT_EQ(decision.reason, row.reason);
    EXPECT_EQ(decision.rule, PairDecision::kNoRule);
  }
}

TEST(PairRules, ARuleBeatsTheModelBothWays) {
  for (const auto& pair : {std::pair<Index, Index>{base, shoulder}, {shoulder, elbow}, {base, elbow}, {base, hand}}) {
    const std::vector<Body> bodies = cell();
    for (const bool swapped : {false, true}) {
      const std::string &a = bodies[swapped ? pair.second : pair.first].name,
                        &b = bodies[swapped ? pair.first : pair.second].name;
      const PairFilter enabling(bodies, {}, {enable(a, b, "test")});
      const PairDecision on = decided(enabling, pair.first, pair.second);
      EXPECT_FALSE(on.allowed) << a << " " << b;
      EXPECT_EQ(on.origin, Origin::service);
      EXPECT_EQ(on.reason, "test");
      const PairDecision off = decided(PairFilter(bodies, {}, {allow(a, b, "test")}), pair.first, pair.second);
      EXPECT_TRUE(off.allowed);
      EXPECT_EQ(off.origin, Origin::service);
    }
  }
  const PairFilter filter(cell(), {}, {allow("arm/hand", "arm/elbow", "")});
  EXPECT_TRUE(decided(filter, hand, elbow).allowed) << "a rule takes precedence over enable_collisions";
}

TEST(PairRules, NoRuleBeatsSelfOrKind) {
  PairKinds kinds;
  kinds.robot_obstacle = false;
  const PairFilter filter(cell(), kinds,
                          {enable("*", "*", ""), enable("obstacle/wall", "obstacle/floor", ""),
                           enable("arm/hand", "obstacle/box", ""), enable("arm/hand", "arm/hand", "")});
  EXPECT_EQ(decided(filter, wall, floor_).origin, Origin::kind);
  EXPECT_EQ(decided(filter, hand, box).origin, Origin::kind);
  EXPECT_EQ(decided(filter, hand, hand).origin, Origin::self);
  EXPECT_FALSE(decided(filter, base, shoulder).allowed);
}

TEST(PairRules, NamesBeatGlobsAndLaterBeatsEarlier) {
  struct Row {
    std::vector<PairRule> rules;
    std::uint32_t decides;
  };
  const PairRule off_names = allow("arm/hand", "obstacle/box", ""), on_names = enable("obstacle/box", "arm/hand", ""),
                 off_glob = allow("arm/*", "obstacle/b*x", ""), on_glob = enable("obstacle/*", "*", ""),
                 half_glob = enable("arm/hand", "obstacle/*", ""), other = allow("arm/elbow", "obstacle/box", "");
  PairRule configured = allow("arm/hand", "obstacle/box", "");
  configured.origin = Origin::parameter;
  const Row rows[] = {{{off_names}, 0},
                      {{off_names, on_names}, 1},
                      {{on_names, off_names}, 1},
                      {{off_names, on_glob}, 0},
                      {{on_glob, off_names}, 1},
                      {{off_names, half_glob}, 0},
                      {{off_glob, on_glob}, 1},
                      {{on_glob, off_glob}, 1},
                      {{half_glob, on_glob, off_glob, other}, 2},
                      {{off_glob, off_names, on_names, on_glob, other}, 2},
                      {{configured, on_glob}, 0},
                      {{configured, on_names}, 1}};
  int number = 0;
  for (const Row& row : rows) {
    SCOPED_TRACE("row " + std::to_string(number++));
    const PairFilter filter(cell(), {}, row.rules);
    const PairDecision decision = decided(filter, hand, box);
    EXPECT_EQ(decision.rule, row.decides);
    EXPECT_EQ(decision.allowed, row.rules[row.decides].allowed);
    EXPECT_EQ(decision.origin, row.rules[row.decides].origin);
  }
}

TEST(PairRules, OfBodiesThatAreNotThereDoNothing) {
  const PairFilter filter(cell(), {}, {allow("arm/hand", "obstacle/ghost", ""), allow("ghost/*", "*", "")});
  const PairFilter plain(cell(), {}, {});
  for (std::uint32_t i = 0; i <= floor_; ++i) {
    for (std::uint32_t j = 0; j <= floor_; ++j) EXPECT_EQ(decided(filter, i, j).origin, plain.decision(i, j).origin);
  }
}

/// Returns the index of the rule that takes precedence. Compares all rules, as the comment of PairRule defines it.
std::uint32_t strongest(const std::vector<PairRule>& rules, const std::string& a, const std::string& b) {
  std::uint32_t best = PairDecision::kNoRule;
  for (std::uint32_t k = 0; k < rules.size(); ++k) {
    const PairRule& rule = rules[k];
    const bool here =
        (matches(rule.first, a) && matches(rule.second, b)) || (matches(rule.first, b) && matches(rule.second, a));
    const bool named = !isGlob(rule.first) && !isGlob(rule.second);
    const bool best_named = best != PairDecision::kNoRule && !isGlob(rules[best].first) && !isGlob(rules[best].second);
    if (here && (named || !best_named)) best = k;
  }
  return best;
}

/// Returns random rules about names, some of which match no body.
std::vector<PairRule> randomRules(Random& random) {
  const std::vector<std::string> names = {"*",        "arm/*",        "obstacle/*",     "*rm/elbow",
                                          "arm/hand", "obstacle/box", "obstacle/crate", "*/*a*",
                                          "arm/base", "nobody"};
  std::vector<PairRule> rules;
  for (int i = random.chance(0.1) ? 150 : random.between(0, 8); i > 0; --i) {
    const std::string &a = names[std::size_t(random.below(10))], &b = names[std::size_t(random.below(10))];
    rules.push_back(random.chance(0.7) ? allow(a, b, "") : enable(a, b, ""));
  }
  return rules;
}

TEST(PairRules, TheStrongestDecidesAndWhetherAnythingIsReportedIsKnownForAnyRules) {
  int silent = 0, loud = 0;
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Body> bodies = cell();
    for (Body& body : test::armBodies("leg")) bodies.push_back(body);
    bodies.resize(std::size_t(random.between(1, int(bodies.size()))));
    const std::vector<PairRule> rules = randomRules(random);
    const PairFilter filter(bodies, {}, rules), plain(bodies, {}, {});
    bool any = false, any_plain = false;
    for (std::uint32_t i = 0; i < bodies.size(); ++i) {
      for (std::uint32_t j = 0; j < bodies.size(); ++j) {
        const PairDecision decision = filter.decision(i, j), without = plain.decision(i, j);
        any = any || !decision.allowed;
        any_plain = any_plain || !without.allowed;
        if (without.origin == Origin::self || without.origin == Origin::kind) {
          ASSERT_EQ(decision.origin, without.origin);
          continue;
        }
        const std::uint32_t rule = strongest(rules, bodies[i].name, bodies[j].name);
        ASSERT_EQ(decision.rule, rule) << bodies[i].name << " " << bodies[j].name;
        ASSERT_EQ(filter.allowed(i, j), rule == PairDecision::kNoRule ? without.allowed : rules[rule].allowed);
      }
    }
    ASSERT_EQ(filter.reportsAny(), any);
    ASSERT_EQ(silencesAll(bodies, {}, filter), any_plain && !any);
    (any_plain && !any ? silent : loud)++;
  }
  EXPECT_GT(silent, 50);
  EXPECT_GT(loud, 500);
}

/// Expects that two filters for the same bodies decide alike. @returns how many pairs a rule decided
std::size_t expectAlike(const PairFilter& filter, const PairFilter& fresh, std::uint32_t bodies) {
  std::size_t decided_by_rule = 0;
  EXPECT_EQ(filter.reportsAny(), fresh.reportsAny());
  for (std::uint32_t i = 0; i < bodies; ++i) {
    EXPECT_EQ(filter.isRuled(i), fresh.isRuled(i));
    for (std::uint32_t j = 0; j < bodies; ++j) {
      const PairDecision one = decided(filter, i, j), other = decided(fresh, i, j);
      EXPECT_EQ(one.origin, other.origin);
      EXPECT_EQ(one.rule, other.rule);
      EXPECT_EQ(one.allowed, other.allowed);
      decided_by_rule += one.rule != PairDecision::kNoRule;
    }
  }
  return decided_by_rule;
}

/// Claim: a filter from which rules were removed, also in several steps, decides as a new filter with the other rules
/// does.
TEST(PairRules, WithoutSomeRulesTheOthersDecideAsInANewFilter) {
  std::size_t left_out = 0, decided_by_rule = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::vector<Body> bodies = cell();
    PairFilter filter(bodies, {}, randomRules(random));
    for (int step = 0; step < 3; ++step) {
      std::vector<bool> gone;
      std::vector<PairRule> staying;
      for (const PairRule& rule : filter.rules()) {
        gone.push_back(random.chance(0.3));
        if (!gone.back()) staying.push_back(rule);
        left_out += gone.back();
      }
      filter = filter.without(gone);
      const PairFilter fresh(bodies, {}, staying);
      ASSERT_EQ(filter.rules().size(), staying.size());
      decided_by_rule += expectAlike(filter, fresh, static_cast<std::uint32_t>(bodies.size()));
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(left_out, 1000u);
  EXPECT_GT(decided_by_rule, 1000u);
}

/// Claim: a filter for other bodies, of which it knew some, decides as a new filter does. So does one without some of
/// its rules.
TEST(PairRules, ForOtherBodiesTheRulesDecideAsInANewFilter) {
  std::size_t stayed = 0, joined = 0, decided_by_rule = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Body> all = cell();
    for (Body& body : test::armBodies("leg")) all.push_back(body);
    std::vector<PairRule> rules = randomRules(random);
    std::vector<std::uint32_t> present;  // indices in `all`
    PairFilter filter({}, {}, rules);
    for (int step = 0; step < 4; ++step) {
      std::vector<std::uint32_t> next, known;
      std::vector<Body> bodies;
      for (std::uint32_t i = 0; i < all.size(); ++i) {
        if (random.chance(0.3)) continue;
        const auto before = std::find(present.begin(), present.end(), i);
        known.push_back(before == present.end() ? PairFilter::kUnknown
                                                : static_cast<std::uint32_t>(before - present.begin()));
        (known.back() == PairFilter::kUnknown ? joined : stayed)++;
        next.push_back(i);
        bodies.push_back(all[i]);
      }
      filter = filter.forBodies(bodies, known);
      present = next;
      decided_by_rule += expectAlike(filter, PairFilter(bodies, {}, rules), static_cast<std::uint32_t>(bodies.size()));
      if (HasFailure() || rules.empty()) break;
      std::vector<bool> gone(rules.size());
      gone[std::size_t(random.below(int(rules.size())))] = true;
      filter = filter.without(gone);
      rules = filter.rules();
    }
    if (HasFailure()) return;
  }
  EXPECT_GT(stayed, 1000u);
  EXPECT_GT(joined, 1000u);
  EXPECT_GT(decided_by_rule, 1000u);
}

/// Returns the numbers with which a filter describes its bodies: kinds, groups and all bits of the globs.
std::vector<std::uint64_t> keysOf(const PairFilter& filter, std::uint32_t bodies) {
  std::vector<std::uint64_t> keys;
  for (std::uint32_t body = 0; body < bodies; ++body) filter.appendKey(body, keys);
  return keys;
}

/// Returns random names of `bodies` in random order, some of them twice, and names of other bodies.
std::vector<std::string> someNames(const std::vector<Body>& bodies, Random& random) {
  std::vector<std::string> names{"obstacle/ghost", "leg/ghost"};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    names.push_back(bodies[std::size_t(random.below(int(bodies.size())))].name);
  return names;
}

/// Claim: names that were matched before make the same filter as names that are matched by forBodies(). Matches of
/// other globs are ignored, also if only the globs differ or if a rule was removed.
TEST(PairRules, NamesThatWereMatchedBeforeMakeTheSameFilter) {
  std::size_t same_globs = 0, other_globs = 0, removed = 0, decided_by_rule = 0;
  for (unsigned seed = 1; seed <= 600; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Body> bodies = cell();
    for (Body& body : test::armBodies("leg")) bodies.push_back(body);
    const auto count = static_cast<std::uint32_t>(bodies.size());
    const std::vector<Body> first{bodies[0]};
    const PairFilter before(first, {}, randomRules(random));
    std::vector<NameMatches> matches;
    for (int i = random.between(1, 3); i > 0; --i) matches.push_back(before.match(someNames(bodies, random)));
    PairFilter filter = before;
    if (random.chance(0.3)) {
      filter = PairFilter(first, {}, randomRules(random));
      if (random.chance(0.5)) matches.push_back(filter.match(someNames(bodies, random)));
    } else if (!before.rules().empty() && random.chance(0.3)) {
      std::vector<bool> gone(before.rules().size());
      gone[std::size_t(random.below(int(gone.size())))] = true;
      filter = before.without(gone);
      if (random.chance(0.5)) matches.push_back(filter.match(someNames(bodies, random)));
      ++removed;
    }
    for (const NameMatches& one : matches) (one.globs == filter.match({}).globs ? same_globs : other_globs)++;
    std::vector<std::uint32_t> known(count, PairFilter::kUnknown);
    if (random.chance(0.5)) known[0] = 0;
    const PairFilter with = filter.forBodies(bodies, known, matches), without = filter.forBodies(bodies, known);
    ASSERT_EQ(keysOf(with, count), keysOf(without, count));
    decided_by_rule += expectAlike(with, without, count);
    if (HasFailure()) return;
  }
  EXPECT_GT(same_globs, 300u);
  EXPECT_GT(other_globs, 100u);
  EXPECT_GT(removed, 50u);
  EXPECT_GT(decided_by_rule, 1000u);
}

/// Claim: the bits of matched names are used. A wrong bit shows that the name was not matched again.
TEST(PairRules, NamesThatWereMatchedBeforeAreNotMatchedAgain) {
  const std::vector<Body> bodies = cell();
  const PairFilter filter({}, {}, {allow("arm/*", "obstacle/*", "")});
  NameMatches matches = filter.match({"obstacle/crate", "obstacle/box", "obstacle/crate"});
  EXPECT_EQ(matches.names, (std::vector<std::string>{"obstacle/box", "obstacle/crate"}));
  EXPECT_EQ(matches.globs, (NameMatches::Globs{{"arm/*", "obstacle/*"}}));
  EXPECT_EQ(matches.as_first, (std::vector<std::uint64_t>{0, 0}));
  EXPECT_EQ(matches.as_second, (std::vector<std::uint64_t>{1, 1}));
  matches.as_second[0] = 0;
  const std::vector<std::uint32_t> unknown(bodies.size(), PairFilter::kUnknown);
  const PairFilter next = filter.forBodies(bodies, unknown, {matches});
  EXPECT_FALSE(next.allowed(hand, box));
  EXPECT_TRUE(next.allowed(hand, crate));
  matches.globs[0].second = "obstacle/c*";
  EXPECT_TRUE(filter.forBodies(bodies, unknown, {matches}).allowed(hand, box)) << "the globs differ";
}

}  // namespace
}  // namespace hgrid
