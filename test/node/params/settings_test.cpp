// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests of parameters that change while the node runs, and of their messages.
#include "src/node/params/settings.h"

#include <gtest/gtest.h>

#include <limits>

#include "src/node/reconfigure/reconfigure_messages.h"
#include "test/node/support/settings.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

TEST(ChangedSettings, HaveTheNewValuesAndTheHashOfANodeThatStartsWithThem) {
  const Settings first = *settingsOf(Params{});
  const Settings wide = changedSettings(first, {{"margin", 0.5}, {"distances/max", 0.25}, {"query_threads", 3}});
  EXPECT_EQ(wide.params.margin, 0.5);
  EXPECT_EQ(wide.params.distances_max, 0.25);
  EXPECT_EQ(wide.params.query_threads, 3);
  EXPECT_EQ(wide.params.horizon, first.params.horizon);
  XmlRpc::XmlRpcValue stored = wide.values;
  EXPECT_EQ(static_cast<double>(stored["distances"]["max"]), 0.25) << "as the parameter server has it";
  const Settings narrow = changedSettings(wide, {{"margin", 0.25}});
  EXPECT_NE(narrow.config_hash, wide.config_hash);
  EXPECT_EQ(changedSettings(narrow, {{"margin", 0.5}}).config_hash, wide.config_hash);
}

TEST(ChangedSettings, FollowTheMarginIfNoReportDistanceIsSet) {
  const Settings first = *settingsOf(Params{});
  EXPECT_EQ(first.params.reportDistance(), first.params.margin);
  EXPECT_EQ(changedSettings(first, {{"margin", 0.75}}).params.reportDistance(), 0.75);
  const Settings set = changedSettings(first, {{"margin", 0.75}, {"distances/max", 0.5}});
  EXPECT_EQ(set.params.reportDistance(), 0.5);
}

TEST(ChangedSettings, RefuseValuesWithWhichANodeDoesNotStart) {
  const Settings first = *settingsOf(Params{});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<ParamChange, const char*> wrong[] = {
      {{{"margin", -0.5}}, "~margin is -0.5 m; it must be within 0 .. 1000 m"},
      {{{"margin", nan}}, "~margin is nan m; it must be within 0 .. 1000 m"},
      {{{"margin", true}}, "~margin is a boolean; it must be a number"},
      {{{"query_threads", 2.5}}, "~query_threads is a number; it must be an integer"},
      {{{"query_threads", 65}}, "~query_threads is 65; it must be within 1 .. 64"},
      {{{"distances/max", 0.2}}, "~distances/max is 0.2 m; it must be at most ~margin, 0.1 m"},
      {{{"valid_for", 0.01}}, "~valid_for is 0.01 s; it must be at least one period of ~heartbeat, 0.05 s"},
      {{{"horizon", -1.0}, {"marker_rate", 0.0}, {"margin", 0.2}}, "; 1 other rule is broken, too"}};
  for (const auto& [change, words] : wrong) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&, &values = change] { changedSettings(first, values); }, &sentence), Code::out_of_range);
    EXPECT_TRUE(says(sentence, words));
  }
}

TEST(DifferencesOf, AreTheValuesThatChangeAndRefuseOtherParameters) {
  const Settings first = *settingsOf(Params{});
  EXPECT_EQ(differencesOf({{"margin", first.params.margin}, {"query_threads", first.params.query_threads}}, first),
            ParamChange{});
  EXPECT_EQ(differencesOf({{"margin", 2}, {"horizon", 0}}, first), (ParamChange{{"margin", 2.0}}))
      << "integers are numbers, too";
  for (const char* name : {"origin", "rate", "state_folder", "max", "distances", "", "a\nb"}) {
    std::string sentence;
    EXPECT_EQ(refusalOf([&] { differencesOf({{name, 1.0}}, first); }, &sentence), Code::unsupported);
    EXPECT_TRUE(says(sentence, "cannot change while the node runs"));
  }
}

TEST(ReconfigureMessages, DescribeTheRangesAndDefaultsOfTheTable) {
  const auto description = descriptionMessage();
  ASSERT_EQ(description.groups.size(), 1u);
  EXPECT_EQ(description.groups[0].id, 0) << "clients look for the group 0";
  const auto& rows = description.groups[0].parameters;
  const auto known = changeableParams(Params{});
  ASSERT_EQ(rows.size(), known.size());
  EXPECT_EQ(description.dflt.doubles.size() + description.dflt.ints.size(), known.size());
  EXPECT_EQ(rows[0].name, "margin");
  EXPECT_EQ(rows[0].type, "double");
  EXPECT_EQ(rows[0].description, "[m] bodies whose boxes are at most this far apart are pairs");
  EXPECT_EQ(description.dflt.doubles[0].value, 0.1);
  EXPECT_EQ(description.min.doubles[0].value, 0.0);
  EXPECT_EQ(description.max.doubles[0].value, 1000.0);
  ASSERT_EQ(description.max.ints.size(), 1u);
  EXPECT_EQ(description.max.ints[0].name, "query_threads");
  EXPECT_EQ(description.max.ints[0].value, 64);
  for (const auto* config : {&description.dflt, &description.min, &description.max}) {
    ASSERT_EQ(config->groups.size(), 1u);
    EXPECT_EQ(config->groups[0].name, description.groups[0].name);
  }
}

TEST(ReconfigureMessages, HoldTheValuesInForceAndAreReadBack) {
  const Settings first = *settingsOf(Params{});
  const ParamChange change{{"margin", 0.5}, {"distances/max", 0.25}, {"query_threads", 3}};
  const Settings settings = changedSettings(first, change);
  EXPECT_EQ(differencesOf(changeOf(configMessage(settings.params)), first), change);
}

TEST(ReconfigureMessages, RefuseRequestsThatAreNoChange) {
  dynamic_reconfigure::Config twice, text, many;
  twice.doubles.resize(1);
  twice.doubles[0].name = "margin";
  twice.ints.resize(1);
  twice.ints[0].name = "margin";
  text.strs.resize(1);
  text.strs[0].name = "margin";
  many.bools.resize(1000000);
  const std::pair<const dynamic_reconfigure::Config*, Code> wrong[] = {
      {&twice, Code::dup_id}, {&text, Code::unsupported}, {&many, Code::limit}};
  for (const auto& [config, code] : wrong) {
    EXPECT_EQ(refusalOf([&, message = config] { changeOf(*message); }), code);
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
