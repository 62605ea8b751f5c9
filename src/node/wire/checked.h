// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/service_traits.h>

#include <string>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/threads/quick_turn.h"
#include "node/wire/message_walk.h"

namespace hgrid {

/// A received message or request. It holds the deserialized value, or the reason why its bytes could not be read.
///
/// roscpp accepts this type wherever it accepts `Message`. All lengths are checked before memory is allocated for them.
template <class Message>
class Checked {
 public:
  Checked() = default;
  explicit Checked(Message value) : value_(std::move(value)) {}

  /// Checks and deserializes the bytes of a message. @throws TakesLong in a QuickTurn if there are more than kShort
  void read(const std::uint8_t* bytes, std::size_t size) {
    QuickTurn::require(size <= kShort);
    flaw_ = flawOf<Message>(bytes, size);
    if (!flaw_.empty()) return;
    // IStream requires a non-const pointer, but reading does not write to the bytes.
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(bytes), static_cast<std::uint32_t>(size));
    ros::serialization::deserialize(stream, value_);
  }
  /// @throws Refusal truncated if the bytes could not be read
  const Message& value() const {
    if (!flaw_.empty()) throw Refusal(Code::truncated, flaw_);
    return value_;
  }

 private:
  static constexpr std::size_t kShort = 1024;  // [bytes] reading this many takes a few microseconds at most

  Message value_;
  std::string flaw_;
};

}  // namespace hgrid

namespace ros {
namespace message_traits {

template <class Message>
struct MD5Sum<hgrid::Checked<Message>> : MD5Sum<Message> {
  using MD5Sum<Message>::value;
  static const char* value(const hgrid::Checked<Message>&) { return value(); }
};
template <class Message>
struct DataType<hgrid::Checked<Message>> : DataType<Message> {
  using DataType<Message>::value;
  static const char* value(const hgrid::Checked<Message>&) { return value(); }
};

}  // namespace message_traits

namespace service_traits {

template <class Request>
struct MD5Sum<hgrid::Checked<Request>> : MD5Sum<Request> {
  using MD5Sum<Request>::value;
  static const char* value(const hgrid::Checked<Request>&) { return value(); }
};
template <class Request>
struct DataType<hgrid::Checked<Request>> : DataType<Request> {
  using DataType<Request>::value;
  static const char* value(const hgrid::Checked<Request>&) { return value(); }
};

}  // namespace service_traits

namespace serialization {

template <class Message>
struct Serializer<hgrid::Checked<Message>> {
  template <typename Stream>
  static void read(Stream& stream, hgrid::Checked<Message>& message) {
    message.read(stream.getData(), stream.getLength());
    stream.advance(stream.getLength());
  }
};

}  // namespace serialization
}  // namespace ros
