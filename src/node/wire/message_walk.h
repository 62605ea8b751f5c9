// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/builtin_message_traits.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "node/wire/wire_walk.h"

namespace hgrid {

/// Checks all lengths in the bytes of a serialized message of any generated type, before anything is deserialized.
///
/// The generated serializers resize a list to its declared length before they know whether the bytes hold that many
/// elements. This class takes the place of their stream. The serializers pass every field to it, and it skips the bytes
/// of that field. The field itself is not changed, so one dummy element is enough for all elements of a list.
class MessageWalk {
 public:
  MessageWalk(const std::uint8_t* bytes, std::size_t size) : walk_(bytes, size) {}

  /// Skips the bytes of a field. The generated serializers call this.
  template <class Field>
  void next(Field& field) {
    if constexpr (ros::message_traits::IsFixedSize<Field>::value) {
      walk_.skip(ros::serialization::serializationLength(field), "a value");
    } else {
      ros::serialization::Serializer<Field>::template allInOne<MessageWalk, Field&>(*this, field);
    }
  }
  void next(std::string&) { walk_.skipString("a string"); }
  template <class Element, class Allocator>
  void next(std::vector<Element, Allocator>&) {
    Element element{};  // its lists and strings are empty, so no element is shorter
    const std::size_t least_bytes = ros::serialization::serializationLength(element);
    std::uint32_t count = walk_.count("a list", least_bytes);
    if constexpr (ros::message_traits::IsFixedSize<Element>::value) {
      walk_.skip(count * least_bytes, "a list");
    } else {
      for (; count > 0 && walk_.fits(); --count) next(element);
    }
  }
  /// Returns the same as WireWalk::flaw().
  std::string flaw() const { return walk_.flaw(); }

 private:
  WireWalk walk_;
};

/// Returns why the bytes are not a valid message of type `Message`. Empty: they are valid.
template <class Message>
std::string flawOf(const std::uint8_t* bytes, std::size_t size) {
  MessageWalk walk(bytes, size);
  Message message;
  walk.next(message);
  return walk.flaw();
}

}  // namespace hgrid
