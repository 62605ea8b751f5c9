// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests all types of messages and requests that the node reads with a generated deserializer. This program counts
// the allocated bytes. It needs no ROS master.
#include "src/node/wire/checked.h"

#include <gtest/gtest.h>
#include <hgrid_proximity/ApplyObstacles.h>
#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <hgrid_proximity/QueryBatch.h>
#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/ReloadRobot.h>
#include <hgrid_proximity/SetAllowed.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include "test/fuzz/seeds.h"
#include "test/node/support/random_message.h"
#include "test/node/support/raw_message.h"
#include "test/support/counted_allocations.h"

namespace hgrid {
namespace test {
namespace {

namespace msg = ::hgrid_proximity;

constexpr unsigned kMessages = 50;
constexpr std::size_t kSentence = 2048;  // [bytes] memory that an error sentence may allocate

/// Deserializes the bytes as roscpp does. Checks that the allocated memory is at most proportional to the number of
/// bytes.
template <class Message>
Checked<Message> received(std::string bytes) {
  Checked<Message> message;
  ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(&bytes[0]),
                                     static_cast<std::uint32_t>(bytes.size()));
  const std::size_t before = allocatedBytes();
  EXPECT_NO_THROW(ros::serialization::deserialize(stream, message));
  EXPECT_LE(allocatedBytes() - before, 64 * bytes.size() + kSentence) << "allocated for " << bytes.size() << " bytes";
  EXPECT_EQ(stream.getLength(), 0u) << "roscpp's stream is at its end";
  return message;
}

template <class Message>
::testing::AssertionResult refused(const std::string& bytes) {
  try {
    received<Message>(bytes).value();
  } catch (const Refusal& refusal) {
    if (refusal.code() == Code::truncated) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << "refused with " << name(refusal.code());
  }
  return ::testing::AssertionFailure() << "accepted";
}

/// Succeeds if the bytes are refused. Also succeeds if the message that is read, when serialized, has the same bytes.
template <class Message>
::testing::AssertionResult refusedOrEqual(const std::string& bytes) {
  const Checked<Message> message = received<Message>(bytes);
  try {
    if (serialized(message.value()) == bytes) return ::testing::AssertionSuccess();
  } catch (const Refusal&) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << "read as another message";
}

template <class Message>
class CheckedMessage : public ::testing::Test {};

using Messages = ::testing::Types<tf2_msgs::TFMessage, msg::ApplyObstacles::Request, msg::ClearMap::Request,
                                  msg::ExplainPair::Request, msg::GetAllowed::Request, msg::LoadOctomap::Request,
                                  msg::QueryBatch::Request, msg::QueryBox::Request, msg::QueryNearest::Request,
                                  msg::QuerySegment::Request, msg::QuerySphere::Request, msg::ReloadRobot::Request,
                                  msg::SetAllowed::Request, std_srvs::Trigger::Request>;

class TypeName {
 public:
  template <class Message>
  static std::string GetName(int) {
    const std::string type = ros::message_traits::datatype<Message>();
    return type.substr(type.find('/') + 1);
  }
};
TYPED_TEST_SUITE(CheckedMessage, Messages, TypeName);

TYPED_TEST(CheckedMessage, IsReadAsItWasSent) {
  for (unsigned seed = 0; seed < kMessages; ++seed) {
    const std::string bytes = serialized(RandomMessage(seed).make<TypeParam>());
    EXPECT_EQ(serialized(received<TypeParam>(bytes).value()), bytes) << "seed " << seed;
  }
}

TYPED_TEST(CheckedMessage, IsRefusedWhereverItIsCut) {
  for (unsigned seed = 0; seed < kMessages; ++seed) {
    const std::string bytes = serialized(RandomMessage(seed).make<TypeParam>());
    for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
      ASSERT_TRUE(refused<TypeParam>(bytes.substr(0, cut))) << "seed " << seed << ", cut at byte " << cut;
    }
  }
}

TYPED_TEST(CheckedMessage, IsRefusedWithALengthThatItsBytesDoNotHold) {
  for (unsigned seed = 0; seed < kMessages; ++seed) {
    const auto message = RandomMessage(seed).make<TypeParam>();
    const std::string bytes = serialized(message);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    for (const std::size_t at : LengthPositions::of(message)) {
      for (const std::uint32_t length : {size + 1, 1u << 23, 1u << 27, 1u << 31, 0xffffffffu}) {
        std::string lying = bytes;
        lying.replace(at, 4, bytesOf(length));
        ASSERT_TRUE(refused<TypeParam>(lying)) << "seed " << seed << ", length " << length << " at byte " << at;
      }
    }
  }
}

TYPED_TEST(CheckedMessage, IsRefusedWithBytesAfterItsEnd) {
  EXPECT_TRUE(refused<TypeParam>(serialized(RandomMessage(1).make<TypeParam>()) + "x"));
}

TYPED_TEST(CheckedMessage, WithBytesThatChangedIsRefusedOrReadAsTheyAre) {
  std::mt19937 random(1);
  for (unsigned seed = 0; seed < kMessages; ++seed) {
    const std::string bytes = serialized(RandomMessage(seed).make<TypeParam>());
    for (int change = 0; change < 100 && !bytes.empty(); ++change) {
      std::string changed = bytes;
      for (int i = 0; i < 3; ++i) changed[random() % changed.size()] = static_cast<char>(random());
      ASSERT_TRUE(refusedOrEqual<TypeParam>(changed)) << "seed " << seed << ", change " << change;
    }
  }
}

TYPED_TEST(CheckedMessage, ConnectsAsItsOwnType) {
  namespace traits = ros::message_traits;
  EXPECT_STREQ(traits::datatype<Checked<TypeParam>>(), traits::datatype<TypeParam>());
  EXPECT_STREQ(traits::md5sum<Checked<TypeParam>>(), traits::md5sum<TypeParam>());
}

TEST(CheckedRequest, ConnectsAsItsOwnService) {
  namespace traits = ros::service_traits;
  EXPECT_STREQ(traits::datatype<Checked<msg::SetAllowed::Request>>(), traits::datatype<msg::SetAllowed>());
  EXPECT_STREQ(traits::md5sum<Checked<msg::SetAllowed::Request>>(), traits::md5sum<msg::SetAllowed>());
}

TEST(CheckedFlaw, SaysWhatTheBytesDeclareAndWhatTheyHold) {
  const auto sentence = [](const std::string& bytes) -> std::string {
    try {
      received<tf2_msgs::TFMessage>(bytes).value();
    } catch (const Refusal& refusal) {
      return refusal.what();
    }
    return "";
  };
  EXPECT_EQ(sentence(bytesOf(8388608u) + std::string(16, '\0')),
            "the message is 20 bytes long; from byte 4 on, a list of 8388608 elements needs at least 637534208 bytes");
  EXPECT_EQ(sentence(bytesOf(1u) + std::string(12, '\0') + bytesOf(100u) + std::string(72, '\0')),
            "the message is 92 bytes long; from byte 20 on, a string needs 100 bytes");
  EXPECT_EQ(sentence("abc"), "the message is 3 bytes long; from byte 0 on, a list needs 4 bytes");
  EXPECT_EQ(sentence(bytesOf(0u) + "xyz"), "the message is 7 bytes long; it must end at byte 4");
}

// The thread that receives requests reads only short ones itself.
TEST(CheckedRequest, OfMoreThanAKibibyteIsNotReadInAQuickTurn) {
  const auto bytes_of = [](std::size_t size) {
    msg::QuerySphere::Request request;
    request.header.frame_id.assign(size - serialized(request).size(), 'f');
    return serialized(request);
  };
  ASSERT_EQ(bytes_of(1024).size(), 1024u);
  const QuickTurn turn;
  const auto read = [](const std::string& bytes) {
    Checked<msg::QuerySphere::Request>().read(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  };
  EXPECT_NO_THROW(read(bytes_of(1024)));
  EXPECT_THROW(read(bytes_of(1025)), TakesLong);
}

TEST(CheckedSeeds, OfTheFuzzerAreReadCorrectly) { expectNoFlawInSeeds("wire", fuzzWire); }

}  // namespace
}  // namespace test
}  // namespace hgrid
