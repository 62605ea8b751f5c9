// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "queries/states/four_boxes.h"

namespace hgrid {
namespace test {

/// Places one shape of a robot in four states.
inline FourShapes placed(const TiltedBox<float> (&boxes)[4]) {
  FourShapes result{};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) result.box.axes[axis][k][lane] = boxes[lane].axes[axis][k];
      result.box.center[k][lane] = boxes[lane].center[k];
      result.box.half[k][lane] = boxes[lane].half[k];
    }
  }
  return result;
}

}  // namespace test
}  // namespace hgrid
