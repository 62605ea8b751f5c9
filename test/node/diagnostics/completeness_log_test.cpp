// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/diagnostics/completeness_log.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "test/support/scenes.h"

namespace hgrid {
namespace test {
namespace {

const CompletenessLog::Time kStart{std::chrono::hours(1)};

SourceGap gapOf(const std::string& source, const std::string& sentence) { return {source, source + "/*", sentence}; }

/// A world of two spheres that touch. Its functions make a tick and return the line that the node logs about the tick:
/// the reason if the world is not complete, otherwise "+" and the text.
class CompletenessLogs : public ::testing::Test {
 protected:
  CompletenessLogs() {
    put(scene_, ball("a"), at(0));
    ball_ = put(scene_, ball("b"), at(0.5));
  }
  /// @param seconds  [s] time of the tick since the end of the grace after the start
  /// @param gaps     sources that are not complete, with their reasons
  std::string logged(double seconds, const std::vector<SourceGap>& gaps) {
    Tick tick = tickAt(seconds);
    tick.snapshot = scene_.commit(Time{++stamp_}, gaps);
    return textOf(tick);
  }
  std::string loggedWithoutWorld(double seconds, const std::vector<std::string>& not_ready) {
    Tick tick = tickAt(seconds);
    tick.not_ready = not_ready;
    return textOf(tick);
  }
  Tick tickAt(double seconds) const {
    Tick tick;
    tick.world_frame = "world";
    tick.made.steady = kStart + StartGrace::kLength + std::chrono::milliseconds(static_cast<int>(1000 * seconds));
    return tick;
  }
  std::string textOf(const Tick& tick) {
    const auto line = log_.next(tick);
    if (!line) return "";
    const std::string begin = line->complete ? "The world is complete: " : "The world is not complete: ";
    EXPECT_EQ(line->text.substr(0, begin.size()), begin);
    return (line->complete ? "+" : "") + line->text.substr(begin.size());
  }

  Scene scene_{SceneOptions{}};
  BodyId ball_;
  int stamp_ = 0;
  CompletenessLog log_{kStart};
};

TEST_F(CompletenessLogs, SayOnceThatTheWorldIsComplete) {
  EXPECT_EQ(logged(-4.9, {}), "+2 bodies in frame 'world'.");
  EXPECT_EQ(logged(-4.8, {}), "");
}

TEST_F(CompletenessLogs, DoNotSayWhatIsMissingWhileSourcesMayBeStarting) {
  EXPECT_EQ(loggedWithoutWorld(-4.5, {"NOT_READY robot 'arm': no description"}), "");
  EXPECT_EQ(logged(-0.1, {gapOf("map/hall", "NOT_READY map 'hall': nothing came")}), "");
  EXPECT_EQ(logged(0.1, {gapOf("map/hall", "NOT_READY map 'hall': nothing came")}),
            "NOT_READY map 'hall': nothing came");
}

TEST_F(CompletenessLogs, AreSilentWhileOnlyTheAgeInTheSentenceChanges) {
  EXPECT_EQ(logged(2.0, {gapOf("map/hall", "LOST map/hall: 1 s old")}), "LOST map/hall: 1 s old");
  EXPECT_EQ(logged(2.1, {gapOf("map/hall", "LOST map/hall: 1.1 s old")}), "");
}

TEST_F(CompletenessLogs, SayThatAnotherSourceIsIncomplete) {
  const SourceGap hall = gapOf("map/hall", "LOST map/hall: 1 s old"), eye = gapOf("cloud/eye", "LOST cloud/eye");
  EXPECT_NE(logged(2.0, {hall}), "");
  EXPECT_EQ(logged(3.1, {hall, eye}), "LOST map/hall: 1 s old (and 1 more in ~status)");
  EXPECT_EQ(logged(4.2, {eye}), "LOST cloud/eye");
  EXPECT_EQ(logged(4.3, {}), "+2 bodies in frame 'world'.");
  EXPECT_EQ(logged(5.3, {eye}), "LOST cloud/eye") << "logged again, because the world was complete meanwhile";
}

TEST_F(CompletenessLogs, SayLaterWhatCameSoonAfterAnotherWarning) {
  const SourceGap robot = gapOf("robot", "NOT_READY robot 'robot'"), tool = gapOf("robot", "UNPLACED robot/tool");
  const SourceGap hall = gapOf("map/hall", "NOT_READY map 'hall'");
  EXPECT_EQ(logged(2.0, {hall}), "NOT_READY map 'hall'");
  EXPECT_EQ(logged(2.1, {robot}), "") << "the last warning is younger than a second";
  EXPECT_EQ(logged(2.2, {tool}), "");
  EXPECT_EQ(logged(3.1, {tool}), "UNPLACED robot/tool") << "the cause that lasts must not be lost";
  EXPECT_EQ(logged(4.2, {tool}), "");
  EXPECT_EQ(logged(4.3, {hall}), "NOT_READY map 'hall'") << "no pause without a warning";
}

TEST_F(CompletenessLogs, SayThatABodyGotAWorseStateButNotThatOneIsLate) {
  const SourceGap hall = gapOf("map/hall", "LOST map/hall");
  EXPECT_NE(logged(2.0, {hall}), "");
  scene_.setState(ball_, Freshness::late, 0.2);
  EXPECT_EQ(logged(2.1, {hall}), "");
  scene_.setState(ball_, Freshness::lost, 20.0);
  EXPECT_NE(logged(3.2, {hall}), "");
  EXPECT_EQ(logged(4.3, {hall}), "");
}

TEST_F(CompletenessLogs, SayWhatAWorldThatDoesNotExistLacks) {
  const std::string worst = "NOT_READY: no time (and 1 more in ~status)";
  EXPECT_EQ(loggedWithoutWorld(2.0, {"NOT_READY: no time", "NOT_READY: no frame"}), worst);
  EXPECT_EQ(loggedWithoutWorld(3.1, {"NOT_READY: no time", "NOT_READY: no frame"}), "");
  EXPECT_EQ(loggedWithoutWorld(3.2, {"NOT_READY: no frame"}), "NOT_READY: no frame");
  EXPECT_EQ(logged(3.3, {}), "+2 bodies in frame 'world'.");
}

TEST(CompletenessLog, SaysThatTheListOfPairsIsTruncated) {
  SceneOptions options;
  options.max_pairs = 1;
  Scene scene{options};
  for (const char* name : {"a", "b", "c"}) put(scene, ball(name), at(0));
  Tick tick;
  tick.made.steady = kStart + StartGrace::kLength;
  tick.snapshot = scene.commit(Time{1}, {});
  CompletenessLog log(kStart);
  const auto line = log.next(tick);
  ASSERT_TRUE(line);
  EXPECT_FALSE(line->complete);
  EXPECT_NE(line->text.find("TRUNCATED"), std::string::npos) << line->text;
  EXPECT_FALSE(log.next(tick));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
