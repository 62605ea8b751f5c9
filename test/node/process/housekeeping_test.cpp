// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/housekeeping.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace hgrid {
namespace test {
namespace {

using std::chrono::milliseconds;

TEST(ChoreList, DoesEachChoreWhenItsPauseIsOver) {
  Ledger ledger;
  std::string done;
  ChoreList chores({{"a.failed", milliseconds(0), [&](ChoreList::Time) { done += 'a'; }},
                    {"b.failed", milliseconds(1000), [&](ChoreList::Time) { done += 'b'; }}},
                   ledger);
  const ChoreList::Time start{std::chrono::hours(1)};
  for (const int passed : {0, 250, 999, 1000, 1100, 2500}) {
    chores.doDue(start + milliseconds(passed));
    done += ' ';
  }
  EXPECT_EQ(done, "ab a a ab a ab ");
}

TEST(ChoreList, AChoreThatThrowsDoesNotAffectTheOthers) {
  Ledger ledger;
  int done = 0;
  ChoreList chores({{"a.failed", milliseconds(0), [](ChoreList::Time) { throw std::runtime_error("a fault"); }},
                    {"b.failed", milliseconds(0), [&](ChoreList::Time) { ++done; }}},
                   ledger);
  for (int i = 0; i < 3; ++i) chores.doDue(ChoreList::Time{});
  EXPECT_EQ(done, 3);
  EXPECT_EQ(ledger.counters().at("a.failed.INTERNAL"), 3u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
