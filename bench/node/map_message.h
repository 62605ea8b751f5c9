// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstring>
#include <string>

namespace hgrid {
namespace bench {

/// An octomap_msgs/Octomap, made without that package, that is serialised already: sending it costs one copy.
struct MapMessage {
  std::string bytes;
};

}  // namespace bench
}  // namespace hgrid

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<hgrid::bench::MapMessage> {
  static const char* value() { return "9a45536b45c5e409cd49f04bb2d9999f"; }
  static const char* value(const hgrid::bench::MapMessage&) { return value(); }
};
template <>
struct DataType<hgrid::bench::MapMessage> {
  static const char* value() { return "octomap_msgs/Octomap"; }
  static const char* value(const hgrid::bench::MapMessage&) { return value(); }
};
template <>
struct Definition<hgrid::bench::MapMessage> {
  static const char* value() {
    return "std_msgs/Header header\nbool binary\nstring id\nfloat64 resolution\nint8[] data\n";
  }
  static const char* value(const hgrid::bench::MapMessage&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<hgrid::bench::MapMessage> {
  template <typename Stream>
  static void write(Stream& stream, const hgrid::bench::MapMessage& message) {
    const auto size = static_cast<std::uint32_t>(message.bytes.size());
    std::memcpy(stream.advance(size), message.bytes.data(), size);
  }
  static std::uint32_t serializedLength(const hgrid::bench::MapMessage& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};

}  // namespace serialization
}  // namespace ros
