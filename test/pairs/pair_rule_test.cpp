// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/pair_rule.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hgrid_proximity/bodies/name.h"
#include "src/bodies/name_index.h"
#include "src/bodies/nearest_names.h"
#include "test/support/random.h"
#include "test/support/refusals.h"
#include "test/support/rules.h"

namespace hgrid {
namespace {

using test::allow;
using test::Random;
using test::refusalOf;
using test::says;

std::vector<Body> named(const std::vector<std::string>& names) {
  std::vector<Body> bodies(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) bodies[i].name = names[i];
  return bodies;
}

TEST(PairRule, OnlyStarAndQuestionMarkMakeAGlob) {
  for (const char* glob : {"*", "robot/*", "robot/l*nk", "**"}) EXPECT_TRUE(isGlob(glob)) << glob;
  for (const char* name : {"robot/link", "", "robot/[ab]", "a/b.c+", "what?", "robot/l?nk"})
    EXPECT_FALSE(isGlob(name)) << name;
}

TEST(PairRule, NamesMustBeThoseOfBodiesAndGlobsMustMatchOne) {
  const std::vector<Body> bodies = named({"arm/elbow", "arm/hand", "obstacle/table"});
  EXPECT_NO_THROW(checkKnown({allow("arm/hand", "obstacle/*"), allow("*", "*rm/*")}, bodies));
  EXPECT_NO_THROW(checkKnown({}, bodies));
  std::string sentence;
  EXPECT_EQ(refusalOf(
                [&] {
                  checkKnown({allow("arm/hand", "arm/elbow"), allow("obstacle/table", "arm/hnad")}, bodies);
                },
                &sentence),
            Code::unknown_id);
  EXPECT_EQ(sentence, "there is no body 'arm/hnad'; similar names are 'arm/hand'");
  EXPECT_EQ(refusalOf([&] { checkKnown({allow("leg/*", "arm/hand")}, bodies); }, &sentence), Code::unknown_id);
  EXPECT_EQ(sentence, "no body matches the glob 'leg/*'; a rule needs at least one matching body");
  EXPECT_EQ(refusalOf([&] { checkKnown({allow("arm/hand", "arm/h*x")}, bodies); }), Code::unknown_id);
  EXPECT_EQ(refusalOf([&] { checkKnown({allow("*", "*")}, {}); }), Code::unknown_id);
}

TEST(NearestNames, AreThoseWithFewLettersOtherwiseTheNearestFirst) {
  const std::vector<std::string> known = {"arm/elbow", "arm/hand",       "arm/hand_2",
                                          "left/hand", "obstacle/table", "obstacle/tables"};
  NameList names;
  for (const std::string& name : known) names.push_back(&name);
  using Names = std::vector<std::string>;
  EXPECT_EQ(nearestNames("obstacle/tabel", names), Names({"obstacle/table", "obstacle/tables"}));
  EXPECT_EQ(nearestNames("hand", names), Names({"arm/hand", "left/hand"}))
      << "a name without its source finds no similar names";
  EXPECT_EQ(nearestNames("arm/hand_1", names), Names({"arm/hand_2", "arm/hand"}));
  EXPECT_EQ(nearestNames("nothing/like_it", names), Names());
  EXPECT_EQ(nearestNames("", names), Names());
  EXPECT_EQ(nearestNames(std::string(100000, 'x'), names), Names());
}

TEST(NameIndex, FindsWhatAScanOfAllNamesFinds) {
  Random random(7);
  const auto word = [&](const char* letters, int count, int longest) {
    std::string result;
    for (int i = random.between(0, longest); i > 0; --i) result += letters[random.below(count)];
    return result;
  };
  std::size_t matched = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<std::string> names;
    for (int i = random.between(0, 40); i > 0; --i) names.push_back(word("ab/", 3, 6));
    if (random.chance(0.5)) std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const BodyList bodies = named(names);
    const NameIndex index(bodies);
    for (int k = 0; k < 50; ++k) {
      const std::string glob = word("ab/**", 5, 5);
      std::vector<std::string> expected, told;
      for (const std::string& name : names) {
        if (matches(glob, name)) expected.push_back(name);
      }
      std::sort(expected.begin(), expected.end());
      std::vector<std::uint32_t> found = {99};
      index.matching(glob, found);
      for (const std::uint32_t i : found) told.push_back(names[i]);
      ASSERT_EQ(told, expected) << glob;
      ASSERT_EQ(index.matchesNone(glob), expected.empty());
      matched += expected.size();
    }
    for (const std::string& name : names) ASSERT_EQ(names[index.find(name)], name);
    ASSERT_EQ(index.find("c"), NameIndex::kNone);
  }
  EXPECT_GT(matched, 1000u);
}

}  // namespace
}  // namespace hgrid
