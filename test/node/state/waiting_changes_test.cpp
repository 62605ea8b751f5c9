// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/state/waiting_changes.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace hgrid {
namespace {

using Kind = StateEdit::Kind;

WaitingChange changeOf(const StateEdit& edit) {
  return {edit.key, [edit] { return edit; }, edit.kind == Kind::erase_kind};
}

std::vector<StateEdit> editsOf(const WaitingChanges& changes) {
  std::vector<StateEdit> edits;
  changes.forEach([&](const StateEdit& edit) { edits.push_back(edit); });
  return edits;
}

TEST(WaitingChangesTest, GiveTheSameItemsAsAllChangesInTheirOrder) {
  std::mt19937 random(1);
  const auto below = [&](int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); };
  for (int round = 0; round < 500; ++round) {
    SCOPED_TRACE(round);
    StateItems expected{{"map hall", "old"}, {"obstacle a", "old"}, {"obstacle b", "old"}, {"rules", "old"}};
    StateItems items = expected;
    WaitingChanges waiting;
    for (int count = below(12); count > 0; --count) {
      static const char* const keys[] = {"map hall", "map yard", "obstacle a", "obstacle b", "obstacle c", "rules"};
      StateEdit edit{below(3) == 0 ? Kind::erase : Kind::set, keys[below(6)], std::to_string(count)};
      if (below(6) == 0) edit = {Kind::erase_kind, below(2) == 0 ? "map " : "obstacle ", ""};
      applyEdits({edit}, expected);
      waiting.add(changeOf(edit));
    }
    applyEdits(editsOf(waiting), items);
    EXPECT_EQ(items, expected);
  }
}

TEST(WaitingChangesTest, AreNoMoreThanThereAreItems) {
  WaitingChanges waiting;
  for (int i = 0; i < 1000; ++i) {
    for (const char* key : {"obstacle a", "obstacle b"}) waiting.add(changeOf({Kind::set, key, std::to_string(i)}));
  }
  ASSERT_EQ(editsOf(waiting).size(), 2u);
  EXPECT_EQ(editsOf(waiting)[0].text, "999");
  waiting.add(changeOf({Kind::erase_kind, "obstacle ", ""}));
  EXPECT_EQ(editsOf(waiting).size(), 1u);
  WaitingChanges taken;
  taken.swap(waiting);
  EXPECT_TRUE(waiting.empty());
  EXPECT_FALSE(taken.empty());
  taken.clear();
  EXPECT_TRUE(taken.empty());
}

}  // namespace
}  // namespace hgrid
