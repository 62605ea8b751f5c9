// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/box_tree.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/infinity.h"
#include "geometry/rotation.h"
#include "hgrid_proximity/geometry/aabb.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

constexpr std::size_t kTurns = 24;  // directions that are tried for the sides of a box

/// The smallest and largest coordinates of some points.
struct Bounds {
  void add(const Vector& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  Vector low = Vector::Constant(kInfinity), high = Vector::Constant(-kInfinity);
};

class BoxTreeBuilder {
 public:
  BoxTreeBuilder(std::vector<Triangle>& triangles, BoxTree& tree)
      : triangles_(triangles), tree_(tree), order_(triangles.size()) {
    Bounds bounds;
    for (const Triangle& triangle : triangles) {
      for (const Vector& corner : triangle) bounds.add(corner);
    }
    tree.center = 0.5 * (bounds.low + bounds.high);
    tree.reach = 0.5 * (bounds.high - bounds.low).norm();
    for (const Triangle& t : triangles) centers_.push_back((t[0] + t[1] + t[2]) / 3.0 - tree.center);
    std::iota(order_.begin(), order_.end(), 0);
  }

  void build() {
    const Range all{order_.begin(), order_.end()};
    tree_.nodes.resize(2);
    const Matrix axes = addBox(0, all, 1);
    sorted_.reserve(triangles_.size());
    fill(1, all, axes);
    triangles_.swap(sorted_);
  }

 private:
  using Iterator = std::vector<std::uint32_t>::iterator;
  struct Range {
    Iterator begin, end;
    std::ptrdiff_t size() const { return end - begin; }
  };

  template <class Visit>
  void forEachCorner(const Range& range, const Visit& visit) const {
    for (auto i = range.begin; i != range.end; ++i) {
      for (const Vector& corner : triangles_[*i]) visit(Vector(corner - tree_.center));
    }
  }

  /// Returns orthogonal axes as rows. The first is the normal of the plane that fits the corners best. The others are
  /// turned in this plane so that the box is small; the third gets the longest side.
  Matrix axesOf(const Range& range) const {
    const Vector origin = centers_[*range.begin];
    Vector sum = Vector::Zero();
    Matrix squares = Matrix::Zero();
    forEachCorner(range, [&](const Vector& corner) {
      const Vector v = corner - origin;
      sum += v;
      squares += v * v.transpose();
    });
    const Matrix spread = squares - sum * sum.transpose() / (3.0 * double(range.size()));
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(spread);
    if (solver.info() != Eigen::Success) return Matrix::Identity();
    std::array<Vector, kTurns> sides;
    for (std::size_t i = 0; i < kTurns; ++i) {
      const double angle = M_PI * double(i) / double(kTurns);
      sides[i] = cosine(angle) * solver.eigenvectors().col(2) + sine(angle) * solver.eigenvectors().col(1);
    }
    const auto [shorter, longer] = smallestRectangle(range, sides);
    Matrix axes;
    axes << solver.eigenvectors().col(0).transpose(), sides[shorter].transpose(), sides[longer].transpose();
    return axes.unaryExpr(&throughFloat);  // as the node stores them
  }

  /// Returns the numbers of the two perpendicular sides of the smallest rectangle around the corners, shorter first.
  std::pair<std::size_t, std::size_t> smallestRectangle(const Range& range,
                                                        const std::array<Vector, kTurns>& sides) const {
    std::array<double, kTurns> low, high;
    low.fill(kInfinity);
    high.fill(-kInfinity);
    forEachCorner(range, [&](const Vector& corner) {
      for (std::size_t i = 0; i < kTurns; ++i) {
        const double along = sides[i].dot(corner);
        low[i] = std::min(low[i], along);
        high[i] = std::max(high[i], along);
      }
    });
    std::pair<std::size_t, std::size_t> best;
    double least = kInfinity;
    for (std::size_t i = 0; i < kTurns / 2; ++i) {
      const std::size_t across = i + kTurns / 2;
      const double one = high[i] - low[i], other = high[across] - low[across];
      if (!(one * other < least)) continue;
      least = one * other;
      best = one < other ? std::make_pair(i, across) : std::make_pair(across, i);
    }
    return best;
  }

  /// Adds a child with a box around some triangles. @returns the axes of the box
  Matrix addBox(std::size_t node, const Range& range, std::int32_t child) {
    const Matrix axes = axesOf(range);
    Bounds bounds;
    forEachCorner(range, [&](const Vector& corner) { bounds.add(axes * corner); });
    addChild(tree_.nodes[node], axes, bounds.low, bounds.high, child);
    return axes;
  }

  /// Divides two or more triangles in two along the axis on which their centers spread most, at the mean of the
  /// centers. Each part gets at least a quarter of the triangles, rounded down, and at least one.
  std::array<Range, 2> halves(const Range& range, const Matrix& axes) {
    Bounds bounds;
    Vector sum = Vector::Zero();
    for (auto i = range.begin; i != range.end; ++i) {
      const Vector along = axes * centers_[*i];
      bounds.add(along);
      sum += along;
    }
    Eigen::Index axis = 0;
    (bounds.high - bounds.low).maxCoeff(&axis);
    const Vector direction = axes.row(axis);
    const double mean = sum[axis] / double(range.size());
    const auto along = [&](std::uint32_t i) { return direction.dot(centers_[i]); };
    const auto before = [&](std::uint32_t i, std::uint32_t j) {
      return std::make_pair(along(i), i) < std::make_pair(along(j), j);
    };
    const auto least = std::max<std::ptrdiff_t>(1, range.size() / 4);
    const auto below = std::count_if(range.begin, range.end, [&](std::uint32_t i) { return along(i) < mean; });
    const Iterator middle = range.begin + std::clamp<std::ptrdiff_t>(below, least, range.size() - least);
    std::nth_element(range.begin, middle, range.end, before);
    return {Range{range.begin, middle}, Range{middle, range.end}};
  }

  std::vector<Range> quarters(const Range& range, const Matrix& axes) {
    std::vector<Range> parts;
    if (range.size() <= 4) {
      for (auto i = range.begin; i != range.end; ++i) parts.push_back({i, i + 1});
      return parts;
    }
    for (const Range& half : halves(range, axes)) {
      if (half.size() == 1) {
        parts.push_back(half);
      } else {
        for (const Range& quarter : halves(half, axes)) parts.push_back(quarter);
      }
    }
    return parts;
  }

  /// Fills a node and all nodes below it.
  void fill(std::size_t number, const Range& range, const Matrix& axes) {
    std::vector<std::pair<Range, Matrix>> inner;
    const std::size_t first = tree_.nodes.size();
    for (const Range& part : quarters(range, axes)) {
      if (part.size() == 1) {
        addBox(number, part, ~static_cast<std::int32_t>(sorted_.size()));
        sorted_.push_back(triangles_[*part.begin]);
      } else {
        inner.emplace_back(part, addBox(number, part, static_cast<std::int32_t>(first + inner.size())));
      }
    }
    tree_.nodes.resize(first + inner.size());
    for (std::size_t i = 0; i < inner.size(); ++i) fill(first + i, inner[i].first, inner[i].second);
  }

  std::vector<Triangle>& triangles_;
  BoxTree& tree_;
  std::vector<Vector> centers_;  // of the triangles, relative to the center of the tree
  std::vector<std::uint32_t> order_;
  std::vector<Triangle> sorted_;
};

}  // namespace

void addChild(BoxNode& node, const Eigen::Matrix3d& axes, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
              std::int32_t child) {
  const auto lane = static_cast<std::size_t>(node.count++);
  const Vector center = axes.transpose() * (0.5 * (low + high)), half = 0.5 * (high - low);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 3; ++k) {
      node.axes[i][k][lane] = static_cast<float>(axes(row, static_cast<Eigen::Index>(k)));
    }
    node.center[i][lane] = static_cast<float>(center[row]);
    node.half[i][lane] = static_cast<float>(half[row]);
  }
  node.child[lane] = child;
}

BoxTree boxTreeOf(std::vector<Triangle>& triangles) {
  BoxTree tree;
  BoxTreeBuilder(triangles, tree).build();
  return tree;
}

}  // namespace hgrid
