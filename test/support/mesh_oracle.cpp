// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/mesh_oracle.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace hgrid {
namespace test {
namespace {

/// Returns the least |start + sides * x| over all x, if the least is reached with mixes: the weights x, and one minus
/// their sum, of each of the two faces are not negative. Otherwise it returns infinity.
/// @param of_first  number of columns of `sides` that belong to the first face
Real leastOfFaces(const Vector3r& start, const Eigen::Matrix<Real, 3, Eigen::Dynamic>& sides, Eigen::Index of_first) {
  Eigen::Matrix<Real, Eigen::Dynamic, 1> x(sides.cols());
  if (sides.cols() > 0) x = sides.completeOrthogonalDecomposition().solve(-start);
  const Real first = x.head(of_first).sum(), second = x.tail(sides.cols() - of_first).sum(), little = 1e-17L;
  if ((x.array() < -little).any() || first > 1 + little || second > 1 + little)
    return std::numeric_limits<Real>::infinity();
  return (start + sides * x).norm();
}

/// Returns the corners that a number from 1 to 7 selects.
std::vector<Vector3r> face(const Triangle3r& triangle, int number) {
  std::vector<Vector3r> corners;
  for (std::size_t i = 0; i < 3; ++i) {
    if (number >> i & 1) corners.push_back(triangle[i]);
  }
  return corners;
}

/// Whether the segment meets the triangle. Both must not be parallel; if they are, others decide.
bool pierces(const Vector3r& from, const Vector3r& to, const Triangle3r& triangle) {
  Eigen::Matrix<Real, 3, 3> matrix;
  matrix << triangle[1] - triangle[0], triangle[2] - triangle[0], from - to;
  const Eigen::FullPivLU<Eigen::Matrix<Real, 3, 3>> solver(matrix);
  if (!solver.isInvertible()) return false;
  const Vector3r x = solver.solve(from - triangle[0]);
  return x.minCoeff() >= 0 && x[0] + x[1] <= 1 && x[2] <= 1;
}

bool cross(const Triangle3r& a, const Triangle3r& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return true;
  }
  return false;
}

Vector3r precise(const Eigen::Vector3d& point) { return point.cast<Real>(); }

std::vector<Triangle3r> trianglesOf(const TriangleMesh& mesh, const Pose& pose) {
  const Eigen::Matrix<Real, 3, 3> rotation = pose.linear().cast<Real>();
  const Vector3r shift = precise(pose.translation());
  std::vector<Triangle3r> triangles;
  for (const auto& t : mesh.triangles) {
    triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangles.back()[i] = rotation * precise(mesh.vertices[t[i]]) + shift;
  }
  return triangles;
}

}  // namespace

Real triangleDistance(const Triangle3r& first, const Triangle3r& second) {
  if (cross(first, second)) return 0;
  Real least = std::numeric_limits<Real>::infinity();
  for (int i = 1; i < 8; ++i) {
    for (int j = 1; j < 8; ++j) {
      const std::vector<Vector3r> a = face(first, i), b = face(second, j);
      if (a.size() + b.size() > 4) continue;  // the nearest points have no more degrees of freedom, except if they meet
      Eigen::Matrix<Real, 3, Eigen::Dynamic> sides(3, Eigen::Index(a.size() + b.size() - 2));
      Eigen::Index column = 0;
      for (std::size_t k = 1; k < a.size(); ++k) sides.col(column++) = a[k] - a[0];
      for (std::size_t k = 1; k < b.size(); ++k) sides.col(column++) = b[0] - b[k];
      least = std::min(least, leastOfFaces(a[0] - b[0], sides, Eigen::Index(a.size()) - 1));
    }
  }
  return least;
}

double bruteForceDistance(const TriangleMesh& first, const TriangleMesh& second, const Pose& first_from_second) {
  Real least = std::numeric_limits<Real>::infinity();
  const std::vector<Triangle3r> others = trianglesOf(second, first_from_second);
  for (const Triangle3r& a : trianglesOf(first, Pose::Identity())) {
    for (const Triangle3r& b : others) {
      // A sphere around each triangle skips pairs that cannot be nearest.
      const Vector3r p = (a[0] + a[1] + a[2]) / 3, q = (b[0] + b[1] + b[2]) / 3;
      Real reach = 0;
      for (const Vector3r& corner : a) reach = std::max(reach, (corner - p).norm());
      const Real reach_a = reach;
      reach = 0;
      for (const Vector3r& corner : b) reach = std::max(reach, (corner - q).norm());
      if ((p - q).norm() - reach - reach_a > least) continue;
      least = std::min(least, triangleDistance(a, b));
    }
  }
  return double(least);
}

double bruteForceWindingNumber(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  Real sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vector3r a = precise(mesh.vertices[t[0]]) - precise(point), b = precise(mesh.vertices[t[1]]) - precise(point),
                   c = precise(mesh.vertices[t[2]]) - precise(point);
    const Real la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return double(sum / (2 * std::acos(Real(-1))));
}

}  // namespace test
}  // namespace hgrid
