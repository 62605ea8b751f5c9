// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/wire/transform_slices.h"

#include <ros/serialization.h>

#include <algorithm>

#include "hgrid_proximity/refusal.h"
#include "node/wire/message_walk.h"

namespace hgrid {
namespace {

/// Returns a stream that reads the bytes. IStream requires a non-const pointer, but reading does not change the bytes.
ros::serialization::IStream streamOf(const std::uint8_t* bytes, std::uint32_t size) {
  return {const_cast<std::uint8_t*>(bytes), size};
}

}  // namespace

TransformSlices::TransformSlices(const std::string& bytes)
    : bytes_(reinterpret_cast<const std::uint8_t*>(bytes.data())), size_(static_cast<std::uint32_t>(bytes.size())) {
  const std::string flaw = flawOf<tf2_msgs::TFMessage>(bytes_, size_);
  if (!flaw.empty()) throw Refusal(Code::truncated, flaw);
  streamOf(bytes_, size_).next(left_);
  bytes_ += sizeof(left_);
  size_ -= sizeof(left_);
}

void TransformSlices::next(tf2_msgs::TFMessage& slice) {
  slice.transforms.resize(std::min<std::size_t>(left_, kSlice));
  ros::serialization::IStream stream = streamOf(bytes_, size_);
  for (geometry_msgs::TransformStamped& transform : slice.transforms) stream.next(transform);
  bytes_ = stream.getData();
  size_ = stream.getLength();
  left_ -= static_cast<std::uint32_t>(slice.transforms.size());
}

}  // namespace hgrid
