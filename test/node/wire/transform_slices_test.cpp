// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// These tests need no ROS master.
#include "src/node/wire/transform_slices.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/refusal.h"
#include "test/node/support/random_message.h"
#include "test/node/support/raw_message.h"
#include "test/node/support/transform_views.h"

namespace hgrid {
namespace test {
namespace {

tf2_msgs::TFMessage messageOf(std::size_t count) {
  RandomMessage random(static_cast<unsigned>(count));
  tf2_msgs::TFMessage message;
  while (message.transforms.size() < count) {
    message.transforms.push_back(random.make<geometry_msgs::TransformStamped>());
  }
  return message;
}

TEST(TransformSlices, AreTogetherTheMessage) {
  constexpr std::size_t kSlice = TransformSlices::kSlice;
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, kSlice - 1, kSlice, kSlice + 1, 5 * kSlice}) {
    SCOPED_TRACE(count);
    const tf2_msgs::TFMessage message = messageOf(count);
    const std::string bytes = serialized(message);
    TransformSlices slices(bytes);
    std::vector<TransformView> slice;
    std::size_t read = 0;
    while (slices.left()) {
      slices.next(slice);
      ASSERT_FALSE(slice.empty());
      ASSERT_LE(slice.size(), kSlice);
      for (const TransformView& transform : slice) {
        ASSERT_LT(read, count);
        const TransformView expected = viewOf(message.transforms[read++]);
        EXPECT_EQ(transform.parent, expected.parent);
        EXPECT_EQ(transform.child, expected.child);
        EXPECT_EQ(transform.stamp, expected.stamp);
        EXPECT_EQ(bytesOf(transform.translation),
                  bytesOf(expected.translation));  // not a number is not equal to itself
        EXPECT_EQ(bytesOf(transform.rotation), bytesOf(expected.rotation));
      }
    }
    EXPECT_EQ(read, count);
    slices.next(slice);
    EXPECT_TRUE(slice.empty());
  }
}

TEST(TransformSlices, OfBytesThatAreNoMessageAreRefused) {
  const std::string bytes = serialized(messageOf(3));
  for (const std::string& flawed :
       {std::string(), bytes.substr(0, bytes.size() - 1), bytes + "x", bytesOf(8388608u) + std::string(16, '\0')}) {
    try {
      TransformSlices slices(flawed);
      ADD_FAILURE() << "accepted " << flawed.size() << " bytes";
    } catch (const Refusal& refusal) {
      EXPECT_EQ(refusal.code(), Code::truncated);
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
