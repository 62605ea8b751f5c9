// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/audit/transform_record.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>
#include <cmath>

namespace hgrid {
namespace {

ReceivedTransforms messageOf(std::size_t bytes, double received, bool is_static = false,
                             const std::string& publisher = "/state") {
  const auto message = boost::make_shared<MessageBytes>();
  message->bytes.assign(bytes, 'x');
  Moment moment;
  moment.ros = Time(std::int64_t(1e9 * received));
  moment.steady = std::chrono::steady_clock::time_point(moment.ros);
  return {message, is_static, publisher, moment};
}

void read(TransformRecord& record, const ReceivedTransforms& message) {
  record.begins(message);
  record.ends(true);
}

TEST(TransformRecord, KeepsMessagesForTheWindowAndSaysWhereItBegins) {
  TransformRecord record(std::chrono::seconds(2), 1 << 20, 10);
  for (const double time : {10.0, 11.0, 12.0, 13.0}) read(record, messageOf(10, time));
  const auto content = record.content();
  EXPECT_EQ(content.moving.size(), 3u);
  EXPECT_EQ(content.begin, Time(std::chrono::seconds(10)));
}

TEST(TransformRecord, DropsTheOldestMessagesBeyondItsBytes) {
  TransformRecord record(std::chrono::seconds(2), 10000, 10);
  for (int i = 0; i < 100; ++i) read(record, messageOf(1000, 10.0 + 0.001 * i));
  const auto content = record.content();
  EXPECT_EQ(content.moving.size(), 10000u / (1000 + TfQueue::kOverhead));
  EXPECT_GT(content.begin, Time(std::chrono::seconds(10)));
}

ReceivedTransforms staticMessage(const std::string& child, double x, const std::string& publisher) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = "/base";
  message.transforms[0].child_frame_id = child;
  message.transforms[0].transform.translation.x = x;
  message.transforms[0].transform.rotation.w = 1.0;
  const auto bytes = boost::make_shared<MessageBytes>();
  std::vector<std::uint8_t> buffer(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(buffer.data(), static_cast<std::uint32_t>(buffer.size()));
  ros::serialization::serialize(stream, message);
  bytes->bytes.assign(buffer.begin(), buffer.end());
  return {bytes, true, publisher, Moment{}};
}

TEST(TransformRecord, KeepsTheNewestStaticTransformOfEachPublisherAndSaysWhenThereIsNoRoom) {
  TransformRecord record(std::chrono::seconds(2), 10000, 10);
  for (int i = 0; i < 1000; ++i) read(record, staticMessage("tool", i, "/calibration"));
  for (int i = 0; i < 9; ++i) read(record, staticMessage(std::to_string(i), i, "/state"));
  read(record, messageOf(10, 100.0));
  const auto content = record.content();
  EXPECT_TRUE(content.all_static);
  ASSERT_EQ(content.fixed->size(), 10u);
  EXPECT_EQ(content.fixed->at({"tool", "/calibration"}).numbers[0], 999.0);
  EXPECT_EQ(content.fixed->at({"tool", "/calibration"}).parent, "base");
  read(record, messageOf(100, 1.0, true));  // the bytes are not a valid message
  EXPECT_TRUE(record.content().all_static);
  read(record, staticMessage("tool", 0, "/rival"));
  EXPECT_FALSE(record.content().all_static);
  EXPECT_EQ(record.content().fixed->size(), 10u);
}

TEST(TransformRecord, KeepsAStaticTransformWhenThePublisherSendsOneThatTheNodeRefuses) {
  TransformRecord record(std::chrono::seconds(2), 10000, 10);
  read(record, staticMessage("tool", 1.0, "/calibration"));
  for (const double bad : {std::nan(""), 1e10}) read(record, staticMessage("tool", bad, "/calibration"));
  const auto content = record.content();
  ASSERT_EQ(content.fixed->size(), 1u);
  EXPECT_EQ(content.fixed->at({"tool", "/calibration"}).numbers[0], 1.0);
}

TEST(TransformRecord, TellsWhetherAMessageIsHalfRead) {
  TransformRecord record(std::chrono::seconds(2), 10000, 10);
  record.begins(messageOf(10, 1.0));
  EXPECT_TRUE(record.isReading());
  record.ends(true);
  EXPECT_FALSE(record.isReading());
  record.begins(messageOf(10, 1.5));
  record.ends(false);  // the node lost a part of the message, so the record begins after it
  EXPECT_TRUE(record.content().moving.empty());
  EXPECT_EQ(record.content().begin, Time(std::chrono::milliseconds(1500)));
}

}  // namespace
}  // namespace hgrid
