// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/tf/frame_claims.h"

#include <gtest/gtest.h>

#include "test/node/support/moments.h"

namespace hgrid {
namespace test {
namespace {

TEST(FrameClaims, KeepARivalsFirstTransformUntilTheHolderHasCaughtUp) {
  FrameClaims claims;
  EXPECT_FALSE(claims.take(3, s(9)));
  claims.keep(3, {{"/b", "base"}, s(5), {}});
  claims.keep(3, {{"/b", "base"}, s(6), {}});
  EXPECT_FALSE(claims.take(3, s(4.9)));
  const auto rival = claims.take(3, s(5));
  ASSERT_TRUE(rival);
  EXPECT_EQ(rival->stamp, s(5));
  EXPECT_FALSE(claims.take(3, s(9)));
}

TEST(FrameClaims, NoticeThatTwoTakeTurns) {
  FrameClaims claims;
  const FrameClaim a{"/a", "base"}, b{"/b", "base"}, elsewhere{"/a", "map"};
  EXPECT_FALSE(claims.change(1, a, b, s(1))) << "a frame may be handed over to another publisher";
  EXPECT_TRUE(claims.change(1, b, a, s(2)));
  EXPECT_FALSE(claims.change(1, a, elsewhere, s(2.1)));
  EXPECT_FALSE(claims.change(1, elsewhere, a, s(9))) << "a change back after more than 3 s is another hand-over";
  EXPECT_FALSE(claims.change(2, b, a, s(9))) << "frame 2 had no earlier change";
}

TEST(FrameClaims, NameBothSidesForThreeSeconds) {
  FrameClaims claims;
  EXPECT_FALSE(claims.isContested(1, s(10)));
  claims.contradict(1, "b", {"/z", "base"}, {"/a", "island"}, s(10));
  EXPECT_TRUE(claims.isContested(1, s(12.9)));
  EXPECT_FALSE(claims.isContested(1, s(13)));
  const std::string sentence = claims.sentence(1);
  EXPECT_EQ(sentence,
            "frame 'b' comes from /a with parent 'island' and from /z with parent 'base'; only one publisher may place "
            "a frame");
  claims.contradict(1, "b", {"/a", "island"}, {"/z", "base"}, s(11));
  EXPECT_EQ(claims.sentence(1), sentence) << "the sentence does not depend on which publisher is the holder";
  claims.contradict(0, "a", {"/a", "base"}, {"/z", "base"}, s(12));
  ASSERT_EQ(claims.sentences(s(13)).size(), 2u);
  EXPECT_NE(claims.sentences(s(13))[0].find("'base' at different poses"), std::string::npos);
  EXPECT_EQ(claims.sentences(s(14)).size(), 1u);
  EXPECT_TRUE(claims.sentences(s(15)).empty());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
