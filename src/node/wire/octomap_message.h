// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <string>

namespace hgrid {

/// An octomap_msgs/Octomap as it came, read without that package and without believing its lengths: nothing is
/// allocated for what is not there.
struct OctomapMessage {
  ros::Time stamp;
  std::string frame;
  bool binary = false;
  std::string id;
  double resolution = 0.0;  // [m]
  std::string data;
  std::string flaw;  // why it could not be read; empty if it could
};

/// Reads the bytes of a message. Never throws but for want of memory.
OctomapMessage readOctomapMessage(const std::uint8_t* bytes, std::size_t size);

}  // namespace hgrid

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<hgrid::OctomapMessage> {
  static const char* value() { return "9a45536b45c5e409cd49f04bb2d9999f"; }
  static const char* value(const hgrid::OctomapMessage&) { return value(); }
};
template <>
struct DataType<hgrid::OctomapMessage> {
  static const char* value() { return "octomap_msgs/Octomap"; }
  static const char* value(const hgrid::OctomapMessage&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<hgrid::OctomapMessage> {
  template <typename Stream>
  static void read(Stream& stream, hgrid::OctomapMessage& message) {
    message = hgrid::readOctomapMessage(stream.getData(), stream.getLength());
    stream.advance(stream.getLength());
  }
};

}  // namespace serialization
}  // namespace ros
