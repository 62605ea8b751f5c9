// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/name.h"

#include <gtest/gtest.h>

#include "test/support/random.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace {

using test::refusalOf;
using test::says;

TEST(Name, TakesWhatPeopleCallThings) {
  for (const std::string& good :
       {std::string("table"), std::string("wrist_3_link"), std::string("größe 日本 🤖"), std::string("a/b/../c"),
        std::string(" "), std::string(128, 'a'), std::string("~*?")}) {
    EXPECT_EQ(refusalOf([&] { checkLocal(good, "name"); }), Code::ok) << good;
  }
  EXPECT_EQ(refusalOf([&] { checkSource("left_arm", "source"); }), Code::ok);
}

TEST(Name, RefusesWhatIsEmptyTooLongOrNoText) {
  const std::string bad[] = {"",
                             std::string(129, 'a'),
                             std::string(10000, 'b'),
                             std::string("a\0b", 3),
                             std::string(1, '\0'),
                             "a\nb",
                             "\t",
                             "\x7f",
                             "\xff",
                             "\xc0\xaf" /* overlong encoding */,
                             "\xe2\x82" /* incomplete character */,
                             "\xed\xa0\x80" /* surrogate */,
                             "\xf4\x90\x80\x80",
                             "\xc2\x85" /* C1 control character */,
                             "\x80",
                             "ok\xfe",
                             "\xf8\x88\x80\x80\x80"};
  for (const std::string& name : bad) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { checkLocal(name, "obstacle name"); }, &sentence), Code::bad_id) << name.size();
    EXPECT_TRUE(says(sentence, "obstacle name"));
    EXPECT_LT(sentence.size(), 400u) << "a long name must not flood the log";
    EXPECT_EQ(sentence.find('\n'), std::string::npos);
    EXPECT_EQ(refusalOf([&] { checkSource(name, "source"); }), Code::bad_id);
  }
}

TEST(Name, CountsBytesNotCharacters) {
  std::string name;
  for (int i = 0; i < 42; ++i) name += "€";  // this character takes three bytes
  EXPECT_EQ(refusalOf([&] { checkLocal(name + "ab", "name"); }), Code::ok);
  EXPECT_EQ(refusalOf([&] { checkLocal(name + "abc", "name"); }), Code::bad_id);
}

TEST(Name, TheFirstSlashSplitsSoASourceHasNone) {
  EXPECT_EQ(refusalOf([&] { checkSource("a/b", "source"); }), Code::bad_id);
  EXPECT_EQ(refusalOf([&] { checkSource("/", "source"); }), Code::bad_id);
  EXPECT_EQ(refusalOf([&] { checkLocal("a/b", "name"); }), Code::ok);
  EXPECT_EQ(joined("robot", "tool/0"), "robot/tool/0");
}

TEST(Glob, MatchesTheWholeName) {
  EXPECT_TRUE(matches("robot/tool0", "robot/tool0"));
  EXPECT_FALSE(matches("robot/tool", "robot/tool0"));
  EXPECT_FALSE(matches("tool0", "robot/tool0"));
  EXPECT_TRUE(matches("*", "robot/tool0"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("", ""));
  EXPECT_FALSE(matches("", "a"));
  EXPECT_TRUE(matches("*/*0", "robot/tool0"));
  EXPECT_TRUE(matches("rob*0", "robot/tool0")) << "a star must match slashes too";
  EXPECT_TRUE(matches("**a**", "xay"));
  EXPECT_FALSE(matches("*b", "abc"));
  EXPECT_TRUE(matches("*ab", "aab"));
  for (const std::string name : {"[a]", "what?", "a?c", "[?]"}) EXPECT_TRUE(matches(name, name)) << name;
  EXPECT_FALSE(matches("[a]", "a")) << "only a star has a special meaning";
  EXPECT_FALSE(matches("what?", "whatX"));
  EXPECT_FALSE(canMatchTogether("a?", "ab"));
  EXPECT_FALSE(coversGlob("a?", "ab"));
}

/// Implements the definition of a glob directly, letter by letter. Returns whether the glob matches the name.
bool matchesByDefinition(const std::string& glob, const std::string& name) {
  if (glob.empty()) return name.empty();
  if (glob[0] == '*') {
    for (std::size_t cut = 0; cut <= name.size(); ++cut) {
      if (matchesByDefinition(glob.substr(1), name.substr(cut))) return true;
    }
    return false;
  }
  return !name.empty() && glob[0] == name[0] && matchesByDefinition(glob.substr(1), name.substr(1));
}

TEST(Glob, AgreesWithItsDefinition) {
  int matched = 0;
  for (unsigned seed = 1; seed <= 50000; ++seed) {
    test::Random random(seed);
    std::string glob, name;
    for (int i = random.below(7); i > 0; --i) glob += "ab***/"[random.below(6)];
    for (int i = random.below(8); i > 0; --i) name += "aab/"[random.below(4)];
    const bool expected = matchesByDefinition(glob, name);
    ASSERT_EQ(matches(glob, name), expected) << glob << " and " << name;
    matched += expected;
  }
  EXPECT_GT(matched, 5000);
}

TEST(Glob, APatternOfManyStarsIsNoTrap) {
  std::string glob, name(100000, 'a');
  for (int i = 0; i < 60; ++i) glob += "*a";
  EXPECT_TRUE(matches(glob, name));
  EXPECT_FALSE(matches(glob + "*b", name));  // a simple implementation takes exponential time
}

TEST(Glob, AnyOfNoneIsNone) {
  EXPECT_FALSE(matchesAny({}, "a"));
  EXPECT_TRUE(matchesAny({"b", "a*"}, "a"));
  EXPECT_FALSE(matchesAny({"b", "c"}, "a"));
}

/// Returns every word of at most `longest` letters of the alphabet.
std::vector<std::string> wordsOf(const std::string& alphabet, std::size_t longest) {
  std::vector<std::string> words{""};
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].size() == longest) break;
    for (const char letter : alphabet) words.push_back(words[i] + letter);
  }
  return words;
}

TEST(Name, TwoGlobsMatchTogetherExactlyIfSomeNameMatchesBoth) {
  const std::vector<std::string> names = wordsOf("ab", 6);  // long enough for all cases of two globs with 3 letters
  const std::vector<std::string> globs = wordsOf("ab*", 3);
  for (const std::string& first : globs) {
    for (const std::string& second : globs) {
      bool together = false;
      for (const std::string& name : names) together = together || (matches(first, name) && matches(second, name));
      ASSERT_EQ(canMatchTogether(first, second), together) << first << " and " << second;
    }
  }
}

TEST(Name, AGlobThatCoversAnotherMatchesAllThatTheOtherMatches) {
  const std::vector<std::string> names = wordsOf("ab", 5);
  const std::vector<std::string> globs = wordsOf("ab*", 4);
  int covered = 0;
  for (const std::string& wide : globs) {
    for (const std::string& narrow : globs) {
      if (!coversGlob(wide, narrow)) continue;
      ++covered;
      for (const std::string& name : names) {
        ASSERT_TRUE(!matches(narrow, name) || matches(wide, name)) << wide << " and " << narrow << ": " << name;
      }
    }
  }
  EXPECT_GT(covered, 500);
  EXPECT_TRUE(coversGlob("robot/*", "robot/*") && coversGlob("*", "robot/*") && coversGlob("r*", "robot/*"));
  EXPECT_FALSE(coversGlob("robot/*a", "robot/*") || coversGlob("robot/a", "robot/*"));
}

}  // namespace
}  // namespace hgrid
