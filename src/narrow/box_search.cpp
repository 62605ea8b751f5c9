// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/box_search.h"

namespace hgrid {
namespace {

constexpr float kOfCenters = 1e-12f;  // the square of a millionth, see squaredGaps()

Four absolute(Four value) { return greatest(value, -value); }

/// Returns the product of a vector and four vectors.
Four dot(const Four (&four)[3], const float (&one)[3]) {
  return four[0] * allFour(one[0]) + four[1] * allFour(one[1]) + four[2] * allFour(one[2]);
}
Four dot(const Four (&a)[3], const Four (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// One box of a node, in the frame of another tree.
struct MovedBox {
  MovedBox(const BoxNode& node, std::size_t lane, const FloatPose& pose) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& row = pose.turn[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& axis = node.axes[k];
        axes[k][i] = row[0] * axis[0][lane] + row[1] * axis[1][lane] + row[2] * axis[2][lane];
      }
      center[i] =
          row[0] * node.center[0][lane] + row[1] * node.center[1][lane] + row[2] * node.center[2][lane] + pose.shift[i];
      half[i] = node.half[i][lane];
    }
  }
  float axes[3][3], center[3], half[3];
};

}  // namespace

FloatPose::FloatPose(const Pose& pose) {
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) turn[i][k] = static_cast<float>(pose.linear()(i, k));
    shift[i] = static_cast<float>(pose.translation()[i]);
  }
}

Four squaredGaps(const BoxNode& node, const BoxNode& other, std::size_t lane, const FloatPose& pose) {
  const MovedBox box(other, lane, pose);
  const Four zero = allFour(0.0f);
  Four way[3];
  for (std::size_t i = 0; i < 3; ++i) way[i] = node.center[i] - allFour(box.center[i]);
  const Four squared_way = dot(way, way);
  Four by_node = zero, by_other = zero;      // squared distances of boxes around the boxes, along the axes of each
  Four by_centers = squared_way;             // distance along the way between the centers, times that way
  Four other_reach[3] = {zero, zero, zero};  // of the boxes of the node, along the axes of the other box
  for (std::size_t i = 0; i < 3; ++i) {
    Four reach = node.half[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Four share = absolute(dot(node.axes[i], box.axes[k]));
      reach += share * allFour(box.half[k]);
      other_reach[k] += share * node.half[i];
    }
    const Four along = absolute(dot(node.axes[i], way)), gap = greatest(along - reach, zero);
    by_node += gap * gap;
    by_centers -= along * node.half[i];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Four along = absolute(dot(way, box.axes[k])), half = allFour(box.half[k]),
               gap = greatest(along - other_reach[k] - half, zero);
    by_other += gap * gap;
    by_centers -= along * half;
  }
  const Four between = greatest(by_centers, zero);
  // The quotient can be NaN. It comes first, since greatest() then returns the second value.
  return greatest(between * between / squared_way, greatest(by_node, by_other)) + allFour(kOfCenters) * squared_way;
}

}  // namespace hgrid
