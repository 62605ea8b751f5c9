// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the text that says whether the world is complete, and the list of the nearest pairs below it.
#include "src/node/markers/verdict_markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "src/node/markers/marker_colors.h"
#include "test/node/support/marker_ticks.h"

namespace hgrid {
namespace test {
namespace {

using visualization_msgs::Marker;

std::vector<Marker> verdictOf(const Tick& tick) {
  return verdictMarkers(tick, nearPairs(tick, nullptr), scaleOf(tick));
}

std::string withoutEmptyLines(const std::string& text) {
  const std::size_t first = text.find_first_not_of('\n'), last = text.find_last_not_of('\n');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char letter : text) {
    if (letter == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += letter;
    }
  }
  return lines;
}

/// Returns a tick of a number of pairs at one place.
Tick tickWithPairs(int pairs) {
  Scene scene{SceneOptions()};
  put(scene, ball("hub", 0.5), at(0));
  for (int i = 0; i < pairs; ++i) put(scene, ball(std::to_string(i), 0.01, Mobility::fixed), at(0.5));
  return tickOf(scene);
}

bool isRed(const Marker& marker) { return rgbOf(marker) == std::vector<float>{red().r, red().g, red().b}; }

TEST(Verdict, IsCompleteWithTheNumberOfNearPairs) {
  for (const auto& [pairs, words] : {std::pair<int, const char*>{0, "COMPLETE: 0 near pairs"},
                                     {1, "COMPLETE: 1 near pair"},
                                     {20, "COMPLETE: 20 near pairs"}}) {
    const std::vector<Marker> texts = verdictOf(tickWithPairs(pairs));
    EXPECT_EQ(withoutEmptyLines(texts[0].text), words);
    EXPECT_FALSE(isRed(texts[0]));
    EXPECT_EQ(shownOf(texts, "verdict").size(), pairs == 0 ? 1u : 2u);
  }
}

TEST(Verdict, IsNotCompleteInRedWithTheFirstReason) {
  Scene scene{SceneOptions()};
  put(scene, ball("a"), at(0));
  const BodyId lost = put(scene, ball("b"), at(0.5));
  scene.setState(lost, Freshness::lost, 3.0);
  const Tick tick = tickOf(scene);
  const std::vector<Marker> texts = verdictOf(tick);
  EXPECT_TRUE(isRed(texts[0]));
  const std::string verdict = withoutEmptyLines(texts[0].text);
  EXPECT_EQ(verdict.compare(0, 24, "NOT COMPLETE: LOST obsta"), 0) << verdict;
  ASSERT_EQ(texts[1].action, Marker::ADD) << "near pairs are shown all the same";
  EXPECT_FALSE(isRed(texts[1]));
}

TEST(Verdict, IsNotCompleteWhileThereIsNoWorld) {
  Tick tick = tickWith(nullptr);
  tick.models = std::make_shared<const ModelReport>();
  tick.not_ready = {"NOT_READY robot 'robot': its description is missing", "another reason"};
  const std::vector<Marker> texts = verdictOf(tick);
  EXPECT_TRUE(isRed(texts[0]));
  EXPECT_EQ(withoutEmptyLines(texts[0].text), "NOT COMPLETE: NOT_READY robot 'robot': its description is\nmissing");
  EXPECT_EQ(texts[1].action, Marker::DELETE);
}

TEST(Verdict, BreaksLongReasonsIntoThreeLinesAtMost) {
  Tick tick = tickWith(nullptr);
  tick.models = std::make_shared<const ModelReport>();
  std::string words;
  for (int i = 0; i < 100; ++i) words += "word" + std::to_string(i) + " ";
  tick.not_ready = {words};
  const std::vector<std::string> lines = linesOf(withoutEmptyLines(verdictOf(tick)[0].text));
  ASSERT_EQ(lines.size(), 3u);
  for (const std::string& line : lines) EXPECT_LE(line.size(), 64u) << line;
  EXPECT_EQ(lines[2].substr(lines[2].size() - 4), " ...");
}

/// Claim: the verdict and the list never cover each other, for any number of pairs and from any point of view. RViz
/// centers a text at its place, so two texts of equal height and number of lines have their lines at the same places.
TEST(Verdict, AndTheListNeverCoverEachOther) {
  for (int pairs = 2; pairs <= 20; ++pairs) {
    SCOPED_TRACE(pairs);
    const std::vector<Marker> texts = verdictOf(tickWithPairs(pairs));
    EXPECT_EQ(placeOf(texts[0]), placeOf(texts[1]));
    EXPECT_EQ(texts[0].scale.z, texts[1].scale.z);
    const std::vector<std::string> verdict = linesOf(texts[0].text), list = linesOf(texts[1].text);
    ASSERT_EQ(verdict.size(), list.size());
    int listed = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
      EXPECT_TRUE(verdict[i].empty() || list[i].empty()) << verdict[i] << list[i];
      listed += list[i].empty() ? 0 : 1;
    }
    EXPECT_EQ(listed, std::min(pairs, 6));
  }
}

TEST(Verdict, StandsAboveTheWorldAndIsAsLargeAsTheWorldNeeds) {
  for (const double size : {0.2, 3.0, 50.0}) {
    SCOPED_TRACE(size);
    Scene scene{SceneOptions()};
    put(scene, planeBody("floor"), at(0));  // has no end, so it does not count
    put(scene, ball("low", 0.1 * size), at(0));
    put(scene, ball("high", 0.1 * size), at(size, size, size));
    const Tick tick = tickOf(scene);
    const Marker verdict = verdictOf(tick)[0];
    const double lines = static_cast<double>(linesOf(verdict.text).size());
    EXPECT_GT(verdict.pose.position.z - 0.5 * lines * verdict.scale.z, 1.1 * size) << "nothing stands in the text";
    EXPECT_LT(verdict.pose.position.z, 2.5 * size);
    EXPECT_NEAR(verdict.pose.position.x, 0.5 * size, 0.3 * size);
    EXPECT_NEAR(verdict.scale.z * 50.0, 2.2 * size, 1.3 * size) << "20 to 40 lines of text are as high as the world";
  }
}

TEST(Verdict, StaysWhereItIsWhileABodyMovesALittle) {
  std::set<double> heights, places;
  for (const double x : {1.01, 1.02, 1.03}) {
    Scene scene{SceneOptions()};
    put(scene, ball("a"), at(0));
    put(scene, ball("b"), at(x + 1.0));
    const Marker verdict = verdictOf(tickOf(scene))[0];
    heights.insert(verdict.scale.z);
    places.insert(verdict.pose.position.x);
  }
  EXPECT_EQ(heights.size(), 1u);
  EXPECT_EQ(places.size(), 1u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
