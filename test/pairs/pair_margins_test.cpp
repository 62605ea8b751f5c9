// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/pair_margins.h"

#include <gtest/gtest.h>

#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::at;
using test::put;

SceneOptions optionsWith(double margin, std::vector<PairMargin> pairs) {
  SceneOptions options;
  options.margin = margin;
  options.pair_margins = std::move(pairs);
  return options;
}

TEST(PairMargins, TheLastEntryThatMatchesCountsInEitherOrder) {
  const std::vector<Body> bodies{test::ball("a"), test::ball("b"), test::ball("c")};
  const PairMargins margins(bodies, {{"*/a", "*", 0.5}, {"*/b", "*/a", 0.2}});
  for (const bool turned : {false, true}) {
    const auto of = [&](std::uint32_t i, std::uint32_t j) { return turned ? margins.of(j, i) : margins.of(i, j); };
    EXPECT_EQ(of(0, 1), 0.2);
    EXPECT_EQ(of(0, 2), 0.5);
    EXPECT_EQ(of(1, 2), std::nullopt);
  }
  EXPECT_EQ(margins.largestOf(0), 0.5);
  EXPECT_EQ(margins.largestOf(2), 0.5);
  EXPECT_EQ(PairMargins().of(0, 1), std::nullopt);
}

/// Claim: a snapshot lists a pair exactly if its gap is at most the margin that is configured for this pair. This
/// margin may be larger or smaller than the margins of the two bodies.
TEST(PairMargins, SelectPairsInPlaceOfTheBodiesMargins) {
  for (const double told : {0.05, 0.3, 2.0}) {
    for (const double gap : {0.02, 0.08, 0.2, 0.5, 1.9, 2.1}) {
      SCOPED_TRACE(std::to_string(told) + ", " + std::to_string(gap));
      Scene scene(optionsWith(0.1, {{"obstacle/a", "obstacle/b", told}}));
      Body wide = test::ball("b");
      wide.margin = 0.4;  // still holds for pairs of this body with other bodies
      put(scene, test::ball("a"), at(0.0));
      put(scene, wide, at(1.0 + gap));
      put(scene, test::ball("c"), at(1.0 + gap, 1.35));
      const auto snapshot = scene.commit(Time{1}, {});
      const test::NamePairs pairs = test::namedPairs(*snapshot);
      EXPECT_EQ(pairs.count({"obstacle/a", "obstacle/b"}) == 1, gap <= told);
      EXPECT_EQ(pairs.count({"obstacle/b", "obstacle/c"}), 1u);
    }
  }
}

TEST(PairMargins, AreCheckedAtTheDoor) {
  for (const double wrong : {-0.1, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(test::refusalOf([&] { Scene scene(optionsWith(0.1, {{"a", "b", wrong}})); }), Code::out_of_range);
  }
}

}  // namespace
}  // namespace hgrid
