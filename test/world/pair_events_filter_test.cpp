// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "src/world/pair_events.h"
#include "test/support/events.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using Events = std::vector<std::string>;

/// Tests PairEvents without a Scene. The boxes of two bodies are `gap` [m] apart. Rules and margins change.
class PairEventsFilter : public ::testing::Test {
 protected:
  void setRules(double margin, bool allowed) {
    auto next = std::make_shared<Structure>();
    next->revision = structure_ ? structure_->revision + 1 : 1;
    next->bodies = std::vector<Body>{test::ball("a"), test::ball("b")};
    next->ids = {{0, 0}, {1, 0}};
    next->first_proxy = {0, 1, 2};
    next->body_of_proxy = {0, 1};
    next->margin = {0.0, margin};
    std::vector<PairRule> rules;
    if (allowed) rules.push_back({"*/a", "*/b", ""});
    next->filter = PairFilter(next->bodies, PairKinds(), rules);
    structure_ = next;
  }
  Events next(double gap) {
    const float edge = static_cast<float>(gap);
    const std::vector<Aabb> boxes = {{{-1, 0, 0}, {0, 1, 1}}, {{edge, 0, 0}, {edge + 1, 1, 1}}};
    std::vector<NearPair> pairs;
    if (gap <= structure_->margin[1] && !structure_->filter.allowed(0, 1)) {
      pairs.push_back({0, 1, gap, structure_->margin[1], Time{0}});
    }
    PairEventList list;
    events_.update({structure_, std::vector<BodyPose>(2), boxes, pairs, Freshness::fresh, 0.0, Time{++tick_}}, list);
    events_.accept();
    Events told;
    for (const PairEvent& event : list.events) {
      told.push_back(test::told(event, *structure_));
      EXPECT_EQ(event.gap, gap);
    }
    return told;
  }

  PairEvents events_{0.125};
  std::shared_ptr<const Structure> structure_;
  int tick_ = 0;
};

TEST_F(PairEventsFilter, APairThatIsAllowedEndsAndBeginsAgainWhenItIsNot) {
  setRules(0.5, false);
  EXPECT_EQ(next(0.25), Events({"1 BEGIN BODIES obstacle/a obstacle/b"}));
  setRules(0.5, true);
  EXPECT_EQ(next(0.25), Events({"2 END FILTER obstacle/a obstacle/b"}));
  EXPECT_EQ(next(0.25), Events());
  setRules(0.5, false);
  EXPECT_EQ(next(0.25), Events({"3 BEGIN FILTER obstacle/a obstacle/b"}));
}

TEST_F(PairEventsFilter, AMarginThatIsToldBeginsAndEndsPairs) {
  setRules(0.5, false);
  EXPECT_EQ(next(0.75), Events());
  setRules(1.0, false);
  EXPECT_EQ(next(0.75), Events({"1 BEGIN FILTER obstacle/a obstacle/b"}));
  setRules(0.6875, false);
  EXPECT_EQ(next(0.75), Events()) << "a gap within the hysteresis must not end the pair";
  setRules(0.5, false);
  EXPECT_EQ(next(0.75), Events({"2 END FILTER obstacle/a obstacle/b"}));
}

TEST_F(PairEventsFilter, WhoMovesFarEnoughByItselfHasMoved) {
  setRules(0.5, false);
  EXPECT_EQ(next(0.75), Events());
  setRules(1.0, false);
  EXPECT_EQ(next(0.5), Events({"1 BEGIN MOVED obstacle/a obstacle/b"}));
  setRules(0.5, false);
  EXPECT_EQ(next(1.25), Events({"2 END MOVED obstacle/a obstacle/b"}));
}

}  // namespace
}  // namespace hgrid
