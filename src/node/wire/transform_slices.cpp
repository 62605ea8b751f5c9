// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/wire/transform_slices.h"

#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "hgrid_proximity/refusal.h"
#include "node/wire/message_walk.h"

namespace hgrid {
namespace {

// A serialized transform: sequence number, stamp, name of the parent, name of the child, seven numbers.
constexpr std::size_t kSequence = 4, kStamp = 8, kLength = 4, kNumbers = 7 * sizeof(double);

/// Reads a value at `at`, and moves `at` behind it.
template <class Value>
Value take(const char*& at) {
  Value value;
  std::memcpy(&value, at, sizeof value);  // assumes a little-endian machine
  at += sizeof value;
  return value;
}

std::string_view takeName(const char*& at) {
  const auto length = take<std::uint32_t>(at);
  const std::string_view name(at, length);
  at += length;
  return name;
}

/// Skips the name at `at`. @returns false if it does not end before `end`; then `at` is not changed
bool skipName(const char*& at, const char* end) {
  if (static_cast<std::size_t>(end - at) < kLength) return false;
  const char* name = at;
  const auto length = take<std::uint32_t>(name);
  if (static_cast<std::size_t>(end - name) < length) return false;
  at = name + length;
  return true;
}

/// Whether `count` transforms fill the bytes from `at` to `end`.
bool fill(std::uint32_t count, const char* at, const char* end) {
  for (; count > 0; --count) {
    if (static_cast<std::size_t>(end - at) < kSequence + kStamp) return false;
    at += kSequence + kStamp;
    if (!skipName(at, end) || !skipName(at, end) || static_cast<std::size_t>(end - at) < kNumbers) return false;
    at += kNumbers;
  }
  return at == end;
}

}  // namespace

TransformSlices::TransformSlices(const std::string& bytes) {
  const char* at = bytes.data();
  const char* const end = at + bytes.size();
  const bool has_count = bytes.size() >= sizeof(std::uint32_t);
  const auto count = has_count ? take<std::uint32_t>(at) : 0;
  if (!has_count || !fill(count, at, end)) {
    const std::string flaw =
        flawOf<tf2_msgs::TFMessage>(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    throw Refusal(Code::truncated, flaw);
  }
  at_ = at;
  left_ = count;
}

void TransformSlices::next(std::vector<TransformView>& slice) {
  slice.resize(std::min<std::size_t>(left_, kSlice));
  left_ -= static_cast<std::uint32_t>(slice.size());
  for (TransformView& transform : slice) {
    at_ += kSequence;
    const auto whole = take<std::uint32_t>(at_), nanoseconds = take<std::uint32_t>(at_);
    transform.stamp = std::chrono::seconds(whole) + Time(nanoseconds);
    transform.parent = takeName(at_);
    transform.child = takeName(at_);
    transform.translation = take<std::array<double, 3>>(at_);
    transform.rotation = take<std::array<double, 4>>(at_);
  }
}

}  // namespace hgrid
