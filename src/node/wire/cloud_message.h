// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <string>

#include "hgrid_proximity/adapters/point_cloud.h"

namespace hgrid {

/// A sensor_msgs/PointCloud2 message. Its lengths were checked while it was read.
struct CloudMessage {
  ros::Time stamp;
  std::string frame;
  PointCloudFormat format;
  std::string data;
  std::string flaw;  // why the message could not be read; empty: it could be read
};

/// Reads the bytes of a message. Throws only if memory runs out.
CloudMessage readCloudMessage(const std::uint8_t* bytes, std::size_t size);

}  // namespace hgrid

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<hgrid::CloudMessage> {
  static const char* value() { return "1158d486dd51d683ce2f1be655c3c181"; }
  static const char* value(const hgrid::CloudMessage&) { return value(); }
};
template <>
struct DataType<hgrid::CloudMessage> {
  static const char* value() { return "sensor_msgs/PointCloud2"; }
  static const char* value(const hgrid::CloudMessage&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<hgrid::CloudMessage> {
  template <typename Stream>
  static void read(Stream& stream, hgrid::CloudMessage& message) {
    message = hgrid::readCloudMessage(stream.getData(), stream.getLength());
    stream.advance(stream.getLength());
  }
};

}  // namespace serialization
}  // namespace ros
