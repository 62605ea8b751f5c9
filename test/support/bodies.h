// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {
namespace test {

/// Returns a BodyShape with `shape` at the origin of the body frame and without padding.
inline BodyShape shapeOf(const Shape& shape) {
  return {shape, Pose::Identity(), 0.0, std::string(), Eigen::Vector3d::Ones()};
}

}  // namespace test
}  // namespace hgrid
