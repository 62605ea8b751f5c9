// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/wire/poses_message.h"

#include <gtest/gtest.h>
#include <hgrid_proximity/Poses.h>
#include <ros/serialization.h>

#include <optional>

#include "hgrid_proximity/refusal.h"
#include "src/node/wire/transform_slices.h"

namespace hgrid {
namespace {

namespace msg = ::hgrid_proximity;
using Frames = std::vector<std::pair<std::string, double>>;

msg::Poses poses(const std::vector<double>& x) {
  msg::Poses message;
  message.header.frame_id = "map";
  message.header.stamp = ros::Time(7, 8);
  for (const double each : x) {
    message.position.emplace_back();
    message.position.back().x = each;
    message.orientation.emplace_back();
    message.orientation.back().w = 1.0;
  }
  return message;
}

std::string bytesOf(const msg::Poses& message) {
  std::string bytes(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes[0]),
                                     static_cast<std::uint32_t>(bytes.size()));
  stream.next(message);
  return bytes;
}

class Poses : public ::testing::Test {
 protected:
  /// Returns the frames of the transforms, with their x.
  Frames framesOf(const msg::Poses& message, const std::string& publisher = "/cell") {
    const std::string bytes = converter_.toTransforms(bytesOf(message), publisher);
    TransformSlices slices(bytes);
    Frames frames;
    std::vector<TransformView> slice;
    while (slices.left()) {
      slices.next(slice);
      for (const TransformView& transform : slice) {
        EXPECT_EQ(transform.parent, "map");
        EXPECT_EQ(transform.stamp, Time(7000000008));
        EXPECT_EQ(transform.rotation[3], 1.0);
        frames.emplace_back(transform.child, transform.translation[0]);
      }
    }
    return frames;
  }
  std::optional<Code> refused(const msg::Poses& message, const std::string& publisher = "/cell") {
    try {
      framesOf(message, publisher);
    } catch (const Refusal& refusal) {
      return refusal.code();
    }
    return std::nullopt;
  }

  PosesConverter converter_{3, 100000};
};

TEST_F(Poses, BecomeTransformsOfTheFramesOfTheirObstacles) {
  EXPECT_EQ(posesFrameOf("obstacle/part"), "~poses/part");
  msg::Poses message = poses({1, 2});
  message.names = {"part", "b/c", "lid"};
  message.index = {2, 1};
  EXPECT_EQ(framesOf(message), (Frames{{"~poses/lid", 1}, {"~poses/b/c", 2}}));
}

TEST_F(Poses, UseTheNamesOfAnEarlierMessageOfTheSameVersion) {
  msg::Poses first = poses({1, 2});
  first.names = {"a", "b"};
  first.names_version = 5;
  framesOf(first);
  msg::Poses next = poses({3, 4});
  next.names_version = 5;
  EXPECT_EQ(framesOf(next), (Frames{{"~poses/a", 3}, {"~poses/b", 4}}));
  EXPECT_EQ(refused(next, "/other"), Code::unknown_id) << "each publisher has its own names";
  next.names_version = 6;
  EXPECT_EQ(refused(next), Code::unknown_id);
  next.names = {"c", "d"};
  EXPECT_EQ(framesOf(next), (Frames{{"~poses/c", 3}, {"~poses/d", 4}}));
  EXPECT_EQ(refused(first), std::nullopt) << "with its names";
  next.names.clear();
  EXPECT_EQ(framesOf(next), (Frames{{"~poses/c", 3}, {"~poses/d", 4}})) << "the names of version 6";
}

TEST_F(Poses, ThatAreCutOffAreRefused) {
  msg::Poses message = poses({1, 2});
  message.names = {"a", "b"};
  message.linear_velocity.resize(2);
  message.covariance.resize(72);
  const std::string whole = bytesOf(message);
  std::size_t refused = 0;
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    try {
      converter_.toTransforms(whole.substr(0, size), "/cell");
    } catch (const Refusal& refusal) {
      EXPECT_EQ(refusal.code(), Code::truncated);
      ++refused;
    }
  }
  EXPECT_EQ(refused, whole.size()) << "all but the whole message";
}

TEST_F(Poses, WithWrongListsAreRefusedAndTheNamesStay) {
  msg::Poses good = poses({1, 2});
  good.names = {"a", "b"};
  framesOf(good);
  good.names.clear();
  msg::Poses index = good, range = good, orientation = good, linear = good, angular = good, covariance = good,
             longer = poses({1, 2, 3}), names = good, many = good;
  index.index = {0};
  range.index = {0, 2};
  orientation.orientation.pop_back();
  linear.linear_velocity.resize(1);
  angular.angular_velocity.resize(3);
  covariance.covariance.resize(36);
  names.names = {"a", "b\n"};
  msg::Poses other = longer;
  other.names = {"x", "y"};
  many.names = {"a", "b", "c", "d"};
  const std::vector<std::pair<Code, msg::Poses>> wrong = {
      {Code::bad_geometry, index},  {Code::out_of_range, range},   {Code::bad_geometry, orientation},
      {Code::bad_geometry, linear}, {Code::bad_geometry, angular}, {Code::bad_geometry, covariance},
      {Code::out_of_range, longer}, {Code::bad_id, names},         {Code::limit, many},
      {Code::out_of_range, other}};
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(refused(wrong[i].second), wrong[i].first);
    EXPECT_EQ(framesOf(good), (Frames{{"~poses/a", 1}, {"~poses/b", 2}}));
  }
}

TEST_F(Poses, ThatWouldNeedTooManyBytesAreRefused) {
  msg::Poses message = poses(std::vector<double>(2000, 1.0));
  message.names = {"a"};
  message.index.assign(2000, 0);
  EXPECT_EQ(refused(message), Code::limit) << "2000 transforms of more than 50 bytes";
  message = poses({1});
  message.names = {"a"};
  message.header.frame_id.assign(257, 'f');
  EXPECT_EQ(refused(message), Code::limit);
}

TEST_F(Poses, OfTwoListsOfOnePublisherUseTheListOfTheirVersion) {
  msg::Poses first = poses({1}), second = poses({2});
  first.names = {"a"};
  second.names = {"b"};
  second.names_version = 1;
  framesOf(first);
  framesOf(second);
  first.names.clear();
  second.names.clear();
  EXPECT_EQ(framesOf(first), (Frames{{"~poses/a", 1}}));
  EXPECT_EQ(framesOf(second), (Frames{{"~poses/b", 2}}));
}

TEST(PosesLists, ThatWereNotUsedForLongestAreForgotten) {
  PosesConverter converter(100, 100000);
  msg::Poses message = poses({1});
  const auto is_known = [&](const std::string& publisher) {
    msg::Poses unnamed = message;
    unnamed.names.clear();
    try {
      converter.toTransforms(bytesOf(unnamed), publisher);
    } catch (const Refusal& refusal) {
      EXPECT_EQ(refusal.code(), Code::unknown_id);
      return false;
    }
    return true;
  };
  message.names = {"a"};
  for (std::size_t i = 0; i < PosesConverter::kMostLists; ++i) {
    converter.toTransforms(bytesOf(message), "/" + std::to_string(i));
  }
  EXPECT_TRUE(is_known("/0"));
  converter.toTransforms(bytesOf(message), "/one more");
  EXPECT_TRUE(is_known("/0"));
  EXPECT_FALSE(is_known("/1"));
  message.names.assign(100, "b");
  for (const char* publisher : {"/w", "/x", "/y", "/z"}) converter.toTransforms(bytesOf(message), publisher);
  EXPECT_FALSE(is_known("/0")) << "four lists of 100 names leave no room";
  EXPECT_TRUE(is_known("/w"));
}

}  // namespace
}  // namespace hgrid
