// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/exactness/hull_faces.h"

#include <algorithm>
#include <utility>

namespace hgrid {
namespace bench {
namespace {

using Vector = Eigen::Matrix<long double, 3, 1>;

/// Returns how many of the points are in front of the triangle, and how many behind it.
std::pair<int, int> sidesOf(const std::vector<Eigen::Vector3d>& points, const std::array<int, 3>& triangle) {
  const auto at = [&](std::size_t i) { return Vector(points[i].cast<long double>()); };
  const Vector a = at(triangle[0]), normal = (at(triangle[1]) - a).cross(at(triangle[2]) - a);
  std::pair<int, int> counts;
  for (int i = 0; i < int(points.size()); ++i) {
    if (std::find(triangle.begin(), triangle.end(), i) != triangle.end()) continue;
    ++((at(i) - a).dot(normal) > 0 ? counts.first : counts.second);
  }
  return counts;
}

}  // namespace

HullFaces hullFacesOf(const std::vector<Eigen::Vector3d>& points) {
  HullFaces hull;
  hull.center.setZero();
  const int count = int(points.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) {
        const auto [front, behind] = sidesOf(points, {i, j, k});
        if (front == 0) hull.faces.push_back({i, j, k});
        if (behind == 0) hull.faces.push_back({i, k, j});
      }
    }
  }
  std::vector<int> numbers(points.size(), -1);  // of the corners; -1: the point is inside
  for (auto& face : hull.faces) {
    for (int& corner : face) {
      if (numbers[corner] < 0) {
        numbers[corner] = int(hull.corners.size());
        hull.corners.push_back(points[corner]);
      }
      corner = numbers[corner];
    }
  }
  for (const Eigen::Vector3d& corner : hull.corners) hull.center += corner / double(hull.corners.size());
  for (Eigen::Vector3d& corner : hull.corners) corner -= hull.center;
  return hull;
}

}  // namespace bench
}  // namespace hgrid
