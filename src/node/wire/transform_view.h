// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <string_view>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// One transform of a received tf2_msgs/TFMessage, as it was sent. The names refer to the bytes of the message, which
/// must outlive this object. Nothing but the lengths has been checked.
struct TransformView {
  std::string_view parent, child;          ///< names of frames
  Time stamp{0};                           ///< ROS time
  std::array<double, 3> translation = {};  ///< x, y, z [m]
  std::array<double, 4> rotation = {};     ///< quaternion x, y, z, w
};

/// Returns the square of a quaternion's length.
inline double squaredLength(const std::array<double, 4>& q) {
  return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
}

}  // namespace hgrid
