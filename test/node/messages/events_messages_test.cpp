// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/messages/events_messages.h"

#include <gtest/gtest.h>
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/EventCause.h>
#include <hgrid_proximity/EventKind.h>
#include <hgrid_proximity/RuleOrigin.h>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/node/support/readings.h"
#include "test/support/events.h"
#include "test/support/random.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

Body solidBall(NarrowPhase& narrow_phase, const std::string& name) {
  Body body = ball(name);
  for (BodyShape& shape : body.shapes) shape.solid = narrow_phase.solidOf(shape.shape);
  return body;
}

void expectWellFormed(const msg::Events& message, std::size_t most) {
  const std::size_t count = message.number.size();
  EXPECT_GT(count, 0u);
  EXPECT_LE(count, most);
  for (const std::size_t size :
       {message.kind.size(), message.cause.size(), message.first.size(), message.second.size(), message.since.size(),
        message.gap.size(), message.distance.size(), message.margin.size(), message.point_on_first.size(),
        message.point_on_second.size(), message.contact_point.size(), message.normal.size(), message.depth.size(),
        message.first_state.size(), message.second_state.size(), message.rule_origin.size(), message.rule.size()}) {
    EXPECT_EQ(size, count);
  }
  std::set<std::uint32_t> used;
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_LT(message.first[i], message.second[i]);
    used.insert({message.first[i], message.second[i]});
    EXPECT_EQ(std::isnan(message.distance[i]), std::isnan(message.gap[i])) << "NaN only if a body is gone";
    EXPECT_FALSE(message.distance[i] < message.gap[i] - 1e-6);
    const bool gone = std::isnan(message.gap[i]);
    EXPECT_EQ(std::isnan(message.margin[i]), gone);
    EXPECT_EQ(message.first_state[i], gone ? msg::BodyState::UNPLACED : msg::BodyState::FRESH);
    EXPECT_EQ(message.second_state[i], gone ? msg::BodyState::UNPLACED : msg::BodyState::FRESH);
    if (message.kind[i] == msg::EventKind::BEGIN) {
      EXPECT_LE(message.gap[i], message.margin[i]);
    }
    EXPECT_EQ(std::isnan(message.contact_point[i].x), message.distance[i] != 0.0) << "known exactly in contact";
    EXPECT_EQ(std::isnan(message.depth[i]), message.distance[i] != 0.0);
    if (message.distance[i] > 0.0) {
      EXPECT_NEAR(std::abs(message.point_on_first[i].x - message.point_on_second[i].x), message.distance[i], 1e-6);
    }
  }
  EXPECT_EQ(used.size(), message.names.size()) << "every name is used by an event";
  EXPECT_EQ(std::set<std::string>(message.names.begin(), message.names.end()).size(), message.names.size());
  EXPECT_TRUE(std::is_sorted(message.names.begin(), message.names.end()));
  EXPECT_EQ(message.world.last_event, message.number.back()) << "the number of the last event in the message";
}

TEST(EventsMessages, ContainAllEventsOfTheSnapshotInAsManyMessagesAsNeeded) {
  constexpr std::size_t kMost = 3;
  std::size_t split = 0, none = 0;
  const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Params params;
    params.max_events = kMost;
    params.distances_budget = 0.0;  // no time limit, because a busy machine would leave out distances
    Scene scene{SceneOptions{}};
    for (int tick = 1; tick <= 100; ++tick) {
      const std::string name = std::to_string(random.below(12));
      BodyId id;
      if (!scene.find("obstacle/" + name, id)) id = scene.add(solidBall(*narrow_phase, name));
      scene.place(id, at(random.uniform(-4.0, 4.0)), Time{tick});
      if (random.below(10) == 0) scene.remove(id);

      Tick made;
      made.world_frame = "world";
      made.snapshot = scene.commit(Time{tick}, {});
      const auto messages = eventsMessages(made, msg::WorldState(), params, *narrow_phase);
      std::vector<std::string> told, expected;
      std::vector<double> gaps;
      for (const auto& message : messages) {
        expectWellFormed(*message, kMost);
        EXPECT_EQ(message->header.frame_id, "world");
        for (std::string event : eventsOf(*message)) told.push_back(event.replace(event.find('|'), 1, " "));
        gaps.insert(gaps.end(), message->gap.begin(), message->gap.end());
      }
      EXPECT_EQ(told, eventsOf(*made.snapshot));
      ASSERT_EQ(gaps.size(), made.snapshot->events().size());
      for (std::size_t i = 0; i < gaps.size(); ++i) {
        const double gap = made.snapshot->events()[i].gap;
        EXPECT_TRUE(gaps[i] == gap || (std::isnan(gaps[i]) && std::isnan(gap)));
      }
      split += messages.size() > 1 ? 1 : 0;
      none += messages.empty() ? 1 : 0;
    }
    if (::testing::Test::HasFailure()) return;
  }
  EXPECT_GT(split, 100u);
  EXPECT_GT(none, 100u);
}

TEST(EventsMessages, SayWhichRuleDecidesAboutThePair) {
  const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  Scene scene{SceneOptions{}};
  scene.place(scene.add(solidBall(*narrow_phase, "a")), at(0.0), Time{1});
  scene.place(scene.add(solidBall(*narrow_phase, "b")), at(0.5), Time{1});
  Tick tick;
  tick.snapshot = scene.commit(Time{1}, {});
  auto messages = eventsMessages(tick, msg::WorldState(), Params(), *narrow_phase);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0]->rule_origin, std::vector<std::uint8_t>{msg::RuleOrigin::NONE});
  EXPECT_EQ(messages[0]->rule, std::vector<std::string>{""});

  PairRule rule;
  rule.first = "obstacle/*";
  rule.second = "obstacle/b";
  rule.reason = "they are glued";
  rule.allowed = true;
  rule.origin = Origin::service;
  scene.setRules({rule});
  tick.snapshot = scene.commit(Time{2}, {});
  messages = eventsMessages(tick, msg::WorldState(), Params(), *narrow_phase);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0]->cause, std::vector<std::uint8_t>{msg::EventCause::FILTER});
  EXPECT_EQ(messages[0]->rule_origin, std::vector<std::uint8_t>{msg::RuleOrigin::SERVICE});
  EXPECT_EQ(messages[0]->rule, std::vector<std::string>{"obstacle/* obstacle/b: they are glued"});
}

TEST(EventsMessages, AreNoneWhileThereIsNoWorld) {
  EXPECT_TRUE(eventsMessages(Tick(), msg::WorldState(), Params(), *makeCoreNarrowPhase()).empty());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
