// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace hgrid {

/// Deserializes the transforms of one message in slices, so that a message of any length can be read between ticks.
class TransformSlices {
 public:
  static constexpr std::size_t kSlice = 100;  ///< largest number of transforms in a slice

  TransformSlices() = default;
  /// Checks all lengths, but deserializes nothing yet. The bytes must outlive this object.
  /// @throws Refusal truncated if the bytes are not a valid tf2_msgs/TFMessage
  explicit TransformSlices(const std::string& bytes);

  /// Whether transforms are left.
  bool left() const { return left_ > 0; }
  /// Deserializes the next slice into a message that is used again, so that its memory is not allocated anew. The
  /// message becomes empty if no transforms are left.
  void next(tf2_msgs::TFMessage& slice);

 private:
  const std::uint8_t* bytes_ = nullptr;  ///< bytes of the next transform
  std::uint32_t size_ = 0;               ///< number of bytes that are left
  std::uint32_t left_ = 0;               ///< number of transforms that are left
};

}  // namespace hgrid
