// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/tick_history.h"

#include <gtest/gtest.h>

#include <thread>

#include "hgrid_proximity/refusal.h"
#include "node/messages/world_state_message.h"
#include "test/node/support/settings.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

/// Makes ticks of one moving sphere, 20 ms apart, and lets a history see them. The first tick has the stamp 100 s.
class Ticks {
 public:
  explicit Ticks(const Params& params)
      : history(params, ledger), settings_(settingsOf(params)), body_(scene.add(ball("b"))) {
    begin(1);
  }
  void begin(std::uint64_t epoch) {
    epoch_ = epoch;
    scene.beginEpoch(epoch);
  }
  /// Makes the next tick. @param sees  whether the history sees it
  std::shared_ptr<const Tick> next(bool sees = true) {
    stamp_ += std::chrono::milliseconds(20);
    scene.place(body_, at(seconds(stamp_)), stamp_);
    const auto tick = std::make_shared<Tick>();
    tick->settings = settings_;
    tick->snapshot = scene.commit(stamp_, {});
    tick->epoch = epoch_;
    tick->world_frame = "hall";
    tick->made.ros = stamp_ + std::chrono::milliseconds(5);
    tick->unplaced = {"UNPLACED for the test"};
    tick->models = std::make_shared<ModelReport>();
    tick->history = history.extent();
    newest = tick;
    if (sees) history.see(*tick);
    return tick;
  }
  std::string refusal(double stamp) const {
    try {
      history.at(ros::Time(stamp), newest);
      return "none";
    } catch (const Refusal& why) {
      return std::string(name(why.code())) + ": " + why.what();
    }
  }
  double xAt(double stamp) const {
    return history.at(ros::Time(stamp), newest)->snapshot->poses()[0].world_from_body.translation().x();
  }
  /// Waits until the counter has at least this value.
  void awaitCount(const std::string& counter, std::uint64_t value) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (ledger.counters()[counter] < value && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    EXPECT_GE(ledger.counters()[counter], value) << counter;
  }

  /// Waits until the history has at most this many bytes. The newest tick counts in full until it is compacted.
  void awaitBytes(std::size_t most) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (history.extent().bytes > most && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    EXPECT_LE(history.extent().bytes, most);
  }

  Ledger ledger;
  Scene scene{SceneOptions{}};
  TickHistory history;
  std::shared_ptr<const Tick> newest;

 private:
  std::shared_ptr<const Settings> settings_;
  BodyId body_;
  std::uint64_t epoch_ = 1;
  Time stamp_{std::chrono::milliseconds(99980)};
};

TEST(TickHistory, TheStampSelectsTheLastTickThatIsNotLater) {
  Ticks ticks{Params{}};
  for (int i = 0; i < 4; ++i) ticks.next();  // more would wait for the other thread
  EXPECT_EQ(ticks.history.at(ros::Time(), ticks.newest), ticks.newest);
  EXPECT_EQ(ticks.history.at(ros::Time(100.06), ticks.newest), ticks.newest);
  EXPECT_DOUBLE_EQ(ticks.xAt(100.04), 100.04);
  EXPECT_DOUBLE_EQ(ticks.xAt(100.039), 100.02);
  EXPECT_DOUBLE_EQ(ticks.xAt(100.0), 100.0);
}

TEST(TickHistory, APastTickHasWhatItsAnswersNeed) {
  Ticks ticks{Params{}};
  const auto first = ticks.next();
  ticks.next();
  const auto past = ticks.history.at(ros::Time(100.0), ticks.newest);
  EXPECT_NE(past, first);
  EXPECT_EQ(past->world_frame, "hall");
  EXPECT_EQ(past->made.ros, first->made.ros);
  EXPECT_EQ(past->epoch, 1u);
  EXPECT_EQ(past->unplaced, first->unplaced);
  EXPECT_EQ(past->models, first->models);
  const msg::WorldState world = worldState(*past, 0.0);
  EXPECT_DOUBLE_EQ(world.stamp.toSec(), 100.0);
  EXPECT_EQ(world.sequence, 1u);
  EXPECT_DOUBLE_EQ(world.history_begin.toSec(), 100.0);
  EXPECT_EQ(world.valid_until, ros::Time(100.005) + ros::Duration(Params{}.valid_for));
}

TEST(TickHistory, EveryTickSaysHowFarBackOneCanAsk) {
  Ticks ticks{Params{}};
  EXPECT_DOUBLE_EQ(worldState(*ticks.next(), 0.0).history_begin.toSec(), 100.0) << "only itself";
  ticks.next();
  EXPECT_DOUBLE_EQ(worldState(*ticks.next(), 0.0).history_begin.toSec(), 100.0);
  ticks.begin(2);
  EXPECT_DOUBLE_EQ(worldState(*ticks.next(), 0.0).history_begin.toSec(), 100.06) << "another epoch";
}

TEST(TickHistory, OtherTimesAreRefusedWithTheRange) {
  Ticks ticks{Params{}};
  ticks.next();
  EXPECT_EQ(ticks.refusal(99.0),
            "EXTRAPOLATION: the query asks for time 99 s, 1 s before the newest tick; the node stores only the tick of "
            "100 s (~history is 2 s); ask with such a stamp, or with 0 for now");
  ticks.next();
  EXPECT_EQ(
      ticks.refusal(99.0),
      "EXTRAPOLATION: the query asks for time 99 s, 1.02 s before the newest tick; the node can answer about 100 s "
      "to 100.02 s (~history is 2 s); ask with such a stamp, or with 0 for now");
  EXPECT_EQ(
      ticks.refusal(100.021),
      "EXTRAPOLATION: the query asks for time 100.021 s, 0.001 s after the newest tick; the node can answer about "
      "100 s to 100.02 s (~history is 2 s); ask with such a stamp, or with 0 for now");
}

TEST(TickHistory, ANewEpochDropsThePastAndSaysSo) {
  Ticks ticks{Params{}};
  for (int i = 0; i < 3; ++i) ticks.next();
  ticks.begin(2);
  ticks.next(false);
  EXPECT_NE(ticks.refusal(100.02), "none") << "the history did not see the new epoch yet, and must not mix the two";
  ticks.history.see(*ticks.newest);
  EXPECT_EQ(ticks.ledger.counters()["history.dropped.EPOCH"], 3u);
  EXPECT_NE(ticks.refusal(100.02), "none");
  ticks.next();
  EXPECT_DOUBLE_EQ(ticks.xAt(100.06), 100.06);
}

TEST(TickHistory, AWorldThatIsNotReadyEndsAnEpochToo) {
  Ticks ticks{Params{}};
  ticks.next();
  Tick none;
  none.epoch = 2;
  ticks.history.see(none);
  EXPECT_EQ(ticks.history.extent().ticks, 0u);
}

TEST(TickHistory, ThePastThatDoesNotFitIsCountedAndNotAnswered) {
  Params params;
  params.history_bytes = 3000;
  Ticks ticks{params};
  for (std::uint64_t i = 1; i <= 10; ++i) {
    ticks.next();
    ticks.awaitCount("history.dropped.LIMIT", i > 2 ? i - 2 : 0);
  }
  ticks.awaitBytes(3000);
  EXPECT_NE(ticks.refusal(100.0), "none");
}

TEST(TickHistory, WithoutAHistoryOnlyTheNewestTickAnswers) {
  Params params;
  params.history = 0.0;
  Ticks ticks{params};
  ticks.next();
  ticks.next();
  EXPECT_EQ(ticks.history.extent().ticks, 0u);
  EXPECT_EQ(ticks.history.at(ros::Time(100.02), ticks.newest), ticks.newest);
  EXPECT_EQ(ticks.refusal(100.0).rfind("EXTRAPOLATION", 0), 0u);
}

TEST(TickHistory, AnAnswerAboutThePastSaysHowOldItIs) {
  Ticks ticks{Params{}};
  const auto first = ticks.next();
  ticks.next();
  EXPECT_EQ(agoText(*first->snapshot, *ticks.newest->snapshot), "at the tick of 100 s, 0.02 s before the newest tick");
  EXPECT_EQ(agoText(*ticks.newest->snapshot, *ticks.newest->snapshot), "");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
