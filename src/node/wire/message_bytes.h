// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <string>

namespace hgrid {

/// The serialized bytes of a message. A subscriber of roscpp can use this type for messages of any type; it then sets the
/// type name and the MD5 in its SubscribeOptions. The MD5 "*" accepts all publishers.
struct MessageBytes {
  std::size_t most_bytes = 0;  ///< the bytes of longer messages are not stored
  std::size_t size = 0;        ///< number of bytes of the message
  std::string bytes;           ///< bytes of the message; empty if there are more than most_bytes

  void read(const std::uint8_t* data, std::size_t count) {
    size = count;
    if (count <= most_bytes) bytes.assign(reinterpret_cast<const char*>(data), count);
  }
};

}  // namespace hgrid

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<hgrid::MessageBytes> {
  static const char* value() { return "*"; }
  static const char* value(const hgrid::MessageBytes&) { return value(); }
};
template <>
struct DataType<hgrid::MessageBytes> {
  static const char* value() { return "*"; }
  static const char* value(const hgrid::MessageBytes&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<hgrid::MessageBytes> {
  template <typename Stream>
  static void read(Stream& stream, hgrid::MessageBytes& message) {
    message.read(stream.getData(), stream.getLength());
    stream.advance(stream.getLength());
  }
};

}  // namespace serialization
}  // namespace ros
