// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "node/wire/transform_view.h"

namespace hgrid {

/// Reads the transforms of one serialized tf2_msgs/TFMessage in slices, so that a message of any length can be read
/// between ticks. No name is copied.
class TransformSlices {
 public:
  static constexpr std::size_t kSlice = 100;  ///< largest number of transforms in a slice

  TransformSlices() = default;
  /// Checks all lengths, but reads nothing else yet. The bytes must outlive this object and all slices.
  /// @throws Refusal truncated if the bytes are not a valid tf2_msgs/TFMessage
  explicit TransformSlices(const std::string& bytes);

  /// Whether transforms are left.
  bool left() const { return left_ > 0; }
  /// Replaces the elements of `slice` by the next transforms. `slice` becomes empty if no transforms are left.
  void next(std::vector<TransformView>& slice);

 private:
  const char* at_ = nullptr;  ///< the next transform
  std::uint32_t left_ = 0;    ///< number of transforms that are left
};

}  // namespace hgrid
