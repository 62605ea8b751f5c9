// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests how the node writes success, a refusal or a fault into the different kinds of service responses.
#include "src/node/services/envelope/reply.h"

#include <gtest/gtest.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/SetAllowed.h>

#include "test/node/support/settings.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

const Refusal kRefusal(Code::bad_id, "no name");

std::shared_ptr<Tick> tickOf(std::shared_ptr<const Snapshot> snapshot) {
  auto tick = std::make_shared<Tick>();
  tick->settings = settingsOf(Params{});
  tick->world_frame = "world";
  tick->models = std::make_shared<ModelReport>();
  tick->epoch = 7;
  tick->not_ready = {"NOT_READY: no frame"};
  tick->snapshot = std::move(snapshot);
  tick->made.steady = std::chrono::steady_clock::now() - std::chrono::seconds(3);
  return tick;
}

TEST(Reply, OfAChangeHasSuccessCodeAndWorld) {
  msg::SetAllowed::Response response;
  writeRefusal(kRefusal, false, response);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.code.name, "BAD_ID");
  EXPECT_EQ(response.code.text, "no name");
  writeSuccess(response);
  EXPECT_TRUE(response.success);
  EXPECT_EQ(response.code.name, "OK");
}

TEST(Reply, OfAQueryForgetsWhatWasFoundBeforeItWasRefused) {
  msg::QueryBox::Response response;
  writeSuccess(response);
  EXPECT_TRUE(response.answer.success);
  response.answer.hits.resize(2);
  response.answer.verdict = 2;
  writeRefusal(kRefusal, false, response);
  EXPECT_FALSE(response.answer.success);
  EXPECT_TRUE(response.answer.hits.empty());
  EXPECT_EQ(response.answer.verdict, 0) << "the verdict must be UNKNOWN";
  EXPECT_EQ(response.answer.unknown_because, msg::UnknownReason::REFUSED);
  EXPECT_EQ(response.answer.summary, "UNKNOWN, because the query was refused: no name");
  writeRefusal(kRefusal, true, response);
  EXPECT_EQ(response.answer.code.name, "BAD_ID");
  EXPECT_EQ(response.answer.summary, "") << "a fault adds no summary";
}

TEST(Reply, OfAnExplanationIsTheReasonOfARefusal) {
  msg::ExplainPair::Response response;
  writeRefusal(kRefusal, false, response);
  EXPECT_EQ(response.explanation, "no name");
  EXPECT_EQ(response.code.text, "no name");
}

TEST(Reply, OfATriggerHasTheCodeInItsMessage) {
  std_srvs::Trigger::Response response;
  writeRefusal(kRefusal, false, response);
  EXPECT_FALSE(response.success);
  EXPECT_EQ(response.message, "BAD_ID: no name");
  writeSuccess(response);
  EXPECT_TRUE(response.success);
}

TEST(Reply, SaysWhichTickItIsMadeFromAndHowOldItIs) {
  Scene scene{SceneOptions{}};
  const BodyId body = put(scene, ball("a"), at(0), Time{5});
  scene.setState(body, Freshness::fresh, 0.5);
  const AnswerTick tick(tickOf(scene.commit(Time{5}, {})));
  msg::QueryBox::Response response;
  writeTick(tick, response);
  EXPECT_EQ(response.header.frame_id, "world");
  EXPECT_EQ(response.header.stamp.toNSec(), 5u);
  EXPECT_EQ(response.world.epoch, 7u);
  EXPECT_GE(response.world.max_age, 3.5);
  EXPECT_LT(response.world.max_age, 10.0);
  EXPECT_EQ(&tick.snapshot(), tick.get()->snapshot.get());
}

TEST(Reply, BeforeTheFirstTickAndBeforeAWorldSaysThatNothingIsPlaced) {
  msg::QueryBox::Response response;
  writeTick(AnswerTick(nullptr), response);
  EXPECT_EQ(response.world.worst_state, msg::BodyState::UNPLACED);
  EXPECT_EQ(response.header.frame_id, "");
  writeTick(AnswerTick(tickOf(nullptr)), response);
  EXPECT_EQ(response.world.worst_state, msg::BodyState::UNPLACED);
  EXPECT_EQ(response.header.frame_id, "world");
}

TEST(AnswerTick, RefusesToGiveASnapshotThatDoesNotExist) {
  const auto refusal = [](const AnswerTick& tick) -> std::string {
    try {
      tick.snapshot();
    } catch (const Refusal& refused) {
      return std::string(name(refused.code())) + " " + refused.what();
    }
    return "OK";
  };
  EXPECT_EQ(refusal(AnswerTick(nullptr)),
            "NOT_READY there is no world yet: the node has not computed its first tick; ask again");
  EXPECT_EQ(refusal(AnswerTick(tickOf(nullptr))), "NOT_READY there is no world yet: NOT_READY: no frame");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
