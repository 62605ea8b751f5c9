// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/health/node_health.h"

#include <gtest/gtest.h>

namespace hgrid {
namespace test {
namespace {

TEST(NodeHealth, CountsFailedTicksAndForgetsAFaultAfterATickThatSucceeds) {
  NodeHealth health;
  health.noteTick(Refusal(Code::internal, "a fault"));
  health.noteTick(Refusal(Code::limit, "no memory"));
  ASSERT_TRUE(health.report().failed_tick);
  EXPECT_EQ(health.report().failed_tick->code(), Code::limit);
  health.noteTick(std::nullopt);
  EXPECT_FALSE(health.report().failed_tick);
  EXPECT_EQ(health.report().failed_ticks, 2u);
}

TEST(NodeHealth, KnowsTheThreadsThatCouldNotBeCreated) {
  NodeHealth health;
  health.noteThreads("~threads", 4, 4);
  EXPECT_TRUE(health.report().missing_threads.empty());
  health.noteThreads("~threads", 4, 2);
  ASSERT_EQ(health.report().missing_threads.count("~threads"), 1u);
  EXPECT_EQ(health.report()
                .missing_threads.at("~threads")
                .rfind("the system could create only 2 of the 4 threads of ~threads; ", 0),
            0u);
  health.noteThreads("~threads", 4, 4);
  EXPECT_TRUE(health.report().missing_threads.empty());
}

TEST(NodeHealth, CountsLateTicksInARow) {
  NodeHealth health;
  for (const bool late : {true, false, true, true}) health.noteLateness(late);
  EXPECT_EQ(health.report().late_ticks_in_a_row, 2u);
  health.noteLateness(false);
  EXPECT_EQ(health.report().late_ticks_in_a_row, 0u);
}

TEST(NodeHealth, SaysWhetherALoadFailsForAnotherReasonThanBefore) {
  NodeHealth health;
  EXPECT_TRUE(health.noteFailedLoad("arm", "PARSE"));
  EXPECT_FALSE(health.noteFailedLoad("arm", "PARSE"));
  EXPECT_TRUE(health.noteFailedLoad("leg", "PARSE")) << "another robot than before";
  EXPECT_TRUE(health.noteFailedLoad("arm", "LIMIT"));
  health.noteLoaded("arm");
  EXPECT_EQ(health.report().failed_loads, (std::map<std::string, std::string>{{"leg", "PARSE"}}));
  EXPECT_TRUE(health.noteFailedLoad("arm", "LIMIT")) << "reported again, because it was loaded meanwhile";
}

TEST(NodeHealth, KeepsTheFramesThatConflict) {
  NodeHealth health;
  health.noteConflicts({"base"});
  health.noteConflicts({"base", "tool"});
  EXPECT_EQ(health.report().conflicts, (std::vector<std::string>{"base", "tool"}));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
