// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/world/link_paddings.h"

#include <gtest/gtest.h>

#include "test/support/bodies.h"

namespace hgrid {
namespace {

/// Returns the paddings of the two shapes of the link "left/hand", whose own paddings are 0.01 and 0.05 m.
std::vector<double> paddingsWith(const LinkPaddings& paddings) {
  Body link;
  link.name = "left/hand";
  for (const double own : {0.01, 0.05}) {
    link.shapes.push_back(test::shapeOf(Shape::sphere(1.0)));
    link.shapes.back().padding = own;
  }
  const Body result = padded(link, paddings);
  return {result.shapes[0].padding, result.shapes[1].padding};
}
using Numbers = std::vector<double>;

TEST(LinkPaddings, RaiseThePaddingOfAShapeButNeverLowerIt) {
  EXPECT_EQ(paddingsWith({}), (Numbers{0.01, 0.05}));
  EXPECT_EQ(paddingsWith({{"left/hand", 0.02}}), (Numbers{0.02, 0.05}));
  EXPECT_EQ(paddingsWith({{"left/hand", 0.07}}), (Numbers{0.07, 0.07}));
}

TEST(LinkPaddings, HaveNamesWithOrWithoutTheRobotAndTheLargestCounts) {
  EXPECT_EQ(paddingsWith({{"hand", 0.02}}), (Numbers{0.02, 0.05}));
  EXPECT_EQ(paddingsWith({{"hand", 0.02}, {"left/hand", 0.03}}), (Numbers{0.03, 0.05}));
  EXPECT_EQ(paddingsWith({{"hand", 0.04}, {"left/hand", 0.03}}), (Numbers{0.04, 0.05}));
  EXPECT_EQ(paddingsWith({{"right/hand", 0.07}, {"left", 0.07}}), (Numbers{0.01, 0.05}));
}

}  // namespace
}  // namespace hgrid
