// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>

#include <cstdint>
#include <cstring>
#include <string>

namespace hgrid {
namespace test {

/// Bytes that a test publishes as a message of the type `Kind`. They may be an invalid message. The test does not need
/// the package of the type, for example octomap_msgs.
template <class Kind>
struct RawMessage {
  std::string bytes;
};

struct OctomapKind {
  static constexpr const char* kMd5 = "9a45536b45c5e409cd49f04bb2d9999f";
  static constexpr const char* kType = "octomap_msgs/Octomap";
  static constexpr const char* kDefinition =
      "std_msgs/Header header\nbool binary\nstring id\nfloat64 resolution\nint8[] data\n";
};
struct CloudKind {
  static constexpr const char* kMd5 = "1158d486dd51d683ce2f1be655c3c181";
  static constexpr const char* kType = "sensor_msgs/PointCloud2";
  static constexpr const char* kDefinition =
      "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
      "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n";
};
struct TransformsKind {
  static constexpr const char* kMd5 = "94810edda583a504dfda3829e70d7eec";
  static constexpr const char* kType = "tf2_msgs/TFMessage";
  static constexpr const char* kDefinition = "geometry_msgs/TransformStamped[] transforms\n";
};
/// Marks bytes that are the request of a service. It names no message type, because the service determines the type.
struct RequestKind {};
using OctomapBytes = RawMessage<OctomapKind>;
using CloudBytes = RawMessage<CloudKind>;
using TransformsBytes = RawMessage<TransformsKind>;
using RequestBytes = RawMessage<RequestKind>;

/// Returns the bytes of a number as they are in a serialized message.
template <class Number>
std::string bytesOf(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}
/// Returns the bytes of a string as they are in a serialized message.
inline std::string stringOf(const std::string& text) { return bytesOf(static_cast<std::uint32_t>(text.size())) + text; }

/// Returns the bytes of a serialized message.
template <class Message>
std::string serialized(const Message& message) {
  std::string bytes(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes[0]),
                                     static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/// Returns a cloud that contains one point [m]. Its coordinates are floats, which most drivers send.
inline CloudBytes cloudOfOne(const std::string& frame, ros::Time stamp, float x, float y, float z) {
  std::string fields = bytesOf(std::uint32_t{3});
  for (std::uint32_t i = 0; i < 3; ++i) {
    fields += stringOf(std::string(1, "xyz"[i])) + bytesOf(4 * i) + '\7' + bytesOf(std::uint32_t{1});
  }
  const auto number = [](std::uint32_t value) { return bytesOf(value); };
  return {number(0) + bytesOf(stamp.sec) + bytesOf(stamp.nsec) + stringOf(frame) + number(1) + number(1) + fields +
          '\0' + number(12) + number(12) + stringOf(bytesOf(x) + bytesOf(y) + bytesOf(z)) + '\1'};
}

}  // namespace test
}  // namespace hgrid

namespace ros {
namespace message_traits {

template <class Kind>
struct MD5Sum<hgrid::test::RawMessage<Kind>> {
  static const char* value() { return Kind::kMd5; }
  static const char* value(const hgrid::test::RawMessage<Kind>&) { return value(); }
};
template <class Kind>
struct DataType<hgrid::test::RawMessage<Kind>> {
  static const char* value() { return Kind::kType; }
  static const char* value(const hgrid::test::RawMessage<Kind>&) { return value(); }
};
template <class Kind>
struct Definition<hgrid::test::RawMessage<Kind>> {
  static const char* value() { return Kind::kDefinition; }
  static const char* value(const hgrid::test::RawMessage<Kind>&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <class Kind>
struct Serializer<hgrid::test::RawMessage<Kind>> {
  template <typename Stream>
  static void write(Stream& stream, const hgrid::test::RawMessage<Kind>& message) {
    const auto size = static_cast<std::uint32_t>(message.bytes.size());
    std::memcpy(stream.advance(size), message.bytes.data(), size);
  }
  static std::uint32_t serializedLength(const hgrid::test::RawMessage<Kind>& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};

}  // namespace serialization
}  // namespace ros
