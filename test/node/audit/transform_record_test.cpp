// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/audit/transform_record.h"

#include <gtest/gtest.h>

#include <boost/make_shared.hpp>

namespace hgrid {
namespace {

ReceivedTransforms messageOf(std::size_t bytes, double received, bool is_static = false,
                             const std::string& publisher = "/state") {
  const auto message = boost::make_shared<TransformBytes>();
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
  TransformRecord record(std::chrono::seconds(2), 1 << 20);
  for (const double time : {10.0, 11.0, 12.0, 13.0}) read(record, messageOf(10, time));
  const auto content = record.content();
  EXPECT_EQ(content.messages.size(), 3u);
  EXPECT_EQ(content.begin, Time(std::chrono::seconds(10)));
}

TEST(TransformRecord, DropsTheOldestMessagesBeyondItsBytes) {
  TransformRecord record(std::chrono::seconds(2), 10000);
  for (int i = 0; i < 100; ++i) read(record, messageOf(1000, 10.0 + 0.001 * i));
  const auto content = record.content();
  EXPECT_EQ(content.messages.size(), 10000u / (1000 + TfQueue::kOverhead));
  EXPECT_GT(content.begin, Time(std::chrono::seconds(10)));
  EXPECT_FALSE(content.overflown);
}

TEST(TransformRecord, NeverDropsStaticTransformsAndSaysWhenThereIsNoRoom) {
  TransformRecord record(std::chrono::seconds(2), 10000);
  read(record, messageOf(100, 1.0, true));
  for (int i = 0; i < 1000; ++i) read(record, messageOf(100, 2.0, true, "/again"));  // equal messages count once
  read(record, messageOf(10, 100.0));
  EXPECT_EQ(record.content().messages.size(), 3u);
  EXPECT_FALSE(record.content().overflown);
  read(record, messageOf(9900, 101.0, true));
  EXPECT_TRUE(record.content().overflown);
}

TEST(TransformRecord, TellsWhetherAMessageIsHalfRead) {
  TransformRecord record(std::chrono::seconds(2), 10000);
  record.begins(messageOf(10, 1.0));
  EXPECT_TRUE(record.isReading());
  record.ends(true);
  EXPECT_FALSE(record.isReading());
  record.begins(messageOf(10, 1.5));
  record.ends(false);  // the node does not have all of it, so the record can explain nothing before
  EXPECT_TRUE(record.content().messages.empty());
  EXPECT_EQ(record.content().begin, Time(std::chrono::milliseconds(1500)));
}

}  // namespace
}  // namespace hgrid
