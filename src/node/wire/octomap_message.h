// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <string>

namespace hgrid {

/// An octomap_msgs/Octomap message. It is read without the package octomap_msgs. Its lengths were checked before memory
/// was allocated for them.
struct OctomapMessage {
  ros::Time stamp;
  std::string frame;
  bool binary = false;
  std::string id;
  double resolution = 0.0;  // [m]
  std::string data;
  std::string flaw;  // why the message could not be read; empty: it could be read
};

/// Reads the bytes of a message. Throws only if memory runs out.
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
