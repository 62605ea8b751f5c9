// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <string>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// One transform of a serialized tf2_msgs/TFMessage.
struct SerializedTransform {
  std::string parent, child;           // names of frames, without the slash with which names of tf1 begin
  Time stamp{0};                       // ROS time
  std::array<double, 7> numbers = {};  // translation x, y, z [m], then the quaternion x, y, z, w
};

/// Reads values from serialized bytes, one after the other. A function returns false if too few bytes are left.
class ByteWalk {
 public:
  explicit ByteWalk(const std::string& bytes) : at_(bytes.data()), left_(bytes.size()) {}

  template <class Value>
  bool read(Value& value) {
    if (left_ < sizeof value) return false;
    std::memcpy(&value, at_, sizeof value);
    skip(sizeof value);
    return true;
  }
  bool readFrame(std::string& frame) {
    std::uint32_t length = 0;
    if (!read(length) || left_ < length) return false;
    const std::size_t slash = length > 0 && *at_ == '/' ? 1 : 0;
    frame.assign(at_ + slash, length - slash);
    skip(length);
    return true;
  }
  bool done() const { return left_ == 0; }

 private:
  void skip(std::size_t count) {
    at_ += count;
    left_ -= count;
  }
  const char* at_;
  std::size_t left_;
};

/// Calls `visit` with each transform of a serialized tf2_msgs/TFMessage. Uses no code of the folder wire, which the
/// audit checks.
/// @returns false if the bytes are not a valid message; `visit` may have been called for the first transforms even then
template <class Visit>
bool visitTransforms(const std::string& bytes, const Visit& visit) {
  ByteWalk walk(bytes);
  std::uint32_t count = 0;
  if (!walk.read(count)) return false;
  SerializedTransform transform;
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t sequence = 0, seconds = 0, nanoseconds = 0;
    if (!walk.read(sequence) || !walk.read(seconds) || !walk.read(nanoseconds) || !walk.readFrame(transform.parent) ||
        !walk.readFrame(transform.child) || !walk.read(transform.numbers)) {
      return false;
    }
    transform.stamp = std::chrono::seconds(seconds) + Time(nanoseconds);
    visit(transform);
  }
  return walk.done();
}

}  // namespace hgrid
