// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/rule_book.h"

#include <gtest/gtest.h>

#include "test/support/refusals.h"
#include "test/support/rules.h"

namespace hgrid {
namespace {

using std::chrono::seconds;
using test::allow;
using test::enable;
using test::refusalOf;
using test::says;
using test::until;

const PairRule::Clock::time_point kNow{std::chrono::hours(1)};

std::vector<PairRule> configured() {
  PairRule rule = allow("arm/*", "obstacle/table", "bolted to it");
  rule.origin = Origin::parameter;
  return {rule};
}

/// Returns each rule as text: "first second +" if it allows the pair, otherwise "first second -".
std::vector<std::string> gist(const RuleBook& book) {
  std::vector<std::string> lines;
  for (const PairRule& rule : book.rules()) {
    lines.push_back(rule.first + " " + rule.second + (rule.allowed ? " +" : " -"));
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST(RuleBook, KeepsRulesInTheOrderInWhichTheyCame) {
  RuleBook book(configured());
  book.add({allow("c", "d"), allow("a", "b")});
  book.add({enable("b*", "a")});
  EXPECT_EQ(gist(book), Lines({"arm/* obstacle/table +", "c d +", "a b +", "b* a -"}));
  EXPECT_EQ(book.rules()[0].origin, Origin::parameter);
  for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(book.rules()[i].origin, Origin::service);
}

TEST(RuleBook, WhatCanNeverDecideAgainIsDropped) {
  RuleBook book(configured());
  book.add({allow("a", "b"), allow("c", "d")});
  book.add({enable("b", "a")});
  EXPECT_EQ(gist(book), Lines({"arm/* obstacle/table +", "c d +", "b a -"}))
      << "the rule for b and a did not replace the rule for a and b";
  book.add({enable("arm/*", "obstacle/table")});
  EXPECT_EQ(book.rules().size(), 4u) << "a configured rule was dropped";
  for (int i = 1; i <= 100; ++i) book.add({until(allow("e", "f"), kNow + seconds(i))});
  EXPECT_EQ(book.rules().size(), 5u) << "a renewed rule was added instead of replaced";
  EXPECT_EQ(book.rules().back().ends, kNow + seconds(100));
}

TEST(RuleBook, KeepsWhatOutlivesALaterRule) {
  RuleBook book;
  book.add({allow("a", "b")});
  book.add({until(enable("a", "b"), kNow + seconds(2))});
  EXPECT_EQ(gist(book), Lines({"a b +", "a b -"}));
}

TEST(RuleBook, RemovesByTheTwoNamesInEitherOrder) {
  RuleBook book(configured());
  book.add({allow("a", "b*"), enable("c", "d"), until(allow("c", "d"), kNow)});
  book.remove({allow("b*", "a"), allow("d", "c")});
  EXPECT_EQ(gist(book), Lines({"arm/* obstacle/table +"})) << "not all rules for c and d were removed";
}

TEST(RuleBook, RemovesAllOrNone) {
  RuleBook book(configured());
  book.add({allow("a", "b")});
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { book.remove({allow("a", "b"), allow("a", "c\n")}); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "there is no rule 'a', 'c\\x0a'"));
  EXPECT_EQ(refusalOf([&] { book.remove({allow("arm/*", "obstacle/table")}); }, &sentence), Code::unknown_id);
  EXPECT_TRUE(says(sentence, "was configured and cannot be removed; add the same rule with allowed = false"));
  EXPECT_EQ(gist(book), Lines({"arm/* obstacle/table +", "a b +"}));
}

TEST(RuleBook, HoldsNoMoreThanItMay) {
  RuleBook book(configured(), 3);
  book.add({allow("a", "b"), allow("c", "d")});
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { book.add({enable("a", "b"), allow("e", "f")}); }, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "there would be 4 rules"));
  EXPECT_TRUE(says(sentence, "at most 3"));
  EXPECT_EQ(gist(book), Lines({"arm/* obstacle/table +", "a b +", "c d +"}))
      << "a refused call has added some of its rules";
  book.add({enable("a", "b")});
  EXPECT_EQ(book.rules().size(), 3u);
}

TEST(RuleBook, RefusesWhatIsNoRuleAndKeepsTheOthersOut) {
  RuleBook book;
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { book.add({allow("a", "b"), allow("", "b")}); }, &sentence), Code::bad_id);
  EXPECT_TRUE(says(sentence, "first name of a rule is ''; it must not be empty"));
  EXPECT_EQ(refusalOf([&] { book.add({allow("a", "b\x01")}); }, &sentence), Code::bad_id);
  EXPECT_TRUE(says(sentence, "second name of a rule is 'b\\x01'"));
  EXPECT_EQ(refusalOf([&] { book.add({allow(std::string(513, 'x'), "b")}); }), Code::bad_id);
  EXPECT_EQ(refusalOf([&] { book.add({allow("a", "b", std::string(513, 'x'))}); }), Code::out_of_range);
  EXPECT_EQ(refusalOf([&] { book.add({allow("a", "b", "\xff")}); }), Code::out_of_range);
  EXPECT_TRUE(book.rules().empty());
}

TEST(RuleBook, LeavesTheRulesOfAttachedObstaclesAlone) {
  PairRule held = allow("part", "hand");
  held.origin = Origin::attached;
  RuleBook book({held}, 1);
  book.add({allow("a", "b")});  // the rule of the attached obstacle does not count
  EXPECT_EQ(book.rules().size(), 2u);
  EXPECT_EQ(refusalOf([&] { book.add({allow("c", "d")}); }), Code::limit);
  EXPECT_EQ(refusalOf([&] { book.remove({held}); }), Code::unknown_id);
  book.remove({allow("a", "b")});
  ASSERT_EQ(book.rules().size(), 1u);
  EXPECT_EQ(book.rules()[0].origin, Origin::attached);
}

}  // namespace
}  // namespace hgrid
