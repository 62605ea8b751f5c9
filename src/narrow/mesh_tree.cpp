// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/mesh_tree.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

namespace hgrid {
long nExpand,nLeaf,nReject,nFull;
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;
using Node = MeshTree::Node;
using Boxes = MeshTree::Boxes;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Relative to the size of the meshes and their distance: more than the rounding errors of a lower bound in float.
constexpr double kFloatRounding = 64.0 * 0x1p-24;

Four absolute(Four value) { return greatest(value, -value); }

/// Sets one child of a node: its box along the rows of `axes`, rounded outward to float.
void setChild(Node& node, std::size_t lane, const Matrix& axes, const Vector& low, const Vector& high,
              std::int32_t child) {
  const Vector center = axes.transpose() * (0.5 * (low + high));
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = Eigen::Index(i);
    for (std::size_t k = 0; k < 3; ++k) node.axes[i][k][lane] = float(axes(row, Eigen::Index(k)));
    node.center[i][lane] = float(center[row]);
    node.half[i][lane] = std::nextafter(float(0.5 * (high[row] - low[row])), std::numeric_limits<float>::infinity());
  }
  node.child[lane] = child;
  node.count = static_cast<std::int32_t>(lane) + 1;
}

/// A rigid transform in float, as the search uses it.
struct Placement {
  explicit Placement(const Pose& pose) {
    for (Eigen::Index i = 0; i < 3; ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) turn[i][k] = static_cast<float>(pose.linear()(i, k));
      shift[i] = static_cast<float>(pose.translation()[i]);
    }
  }
  float turn[3][3];
  float shift[3];
};

/// Returns the squared lower bounds of the distances of the children of a node and one box of another node.
Four squaredGaps(const Node& node, const Node& other, std::size_t lane, const Placement& place) {
  const auto& r = place.turn;
  float axes[3][3], center[3], half[3];  // of the other box: axes[k][i] is component i of axis k
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      axes[k][i] = r[i][0] * other.axes[k][0][lane] + r[i][1] * other.axes[k][1][lane] + r[i][2] * other.axes[k][2][lane];
    }
    center[i] = r[i][0] * other.center[0][lane] + r[i][1] * other.center[1][lane] + r[i][2] * other.center[2][lane] +
                place.shift[i];
    half[i] = other.half[i][lane];
  }
  const Four zero = allFour(0.0f);
  Four way[3], here = zero, there = zero, halves[3] = {zero, zero, zero};
  for (std::size_t i = 0; i < 3; ++i) way[i] = node.center[i] - allFour(center[i]);
  const Four squared = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
  Four middle = squared;
  for (std::size_t i = 0; i < 3; ++i) {
    const Four* axis = node.axes[i];
    Four reach = node.half[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const Four turn =
          absolute(axis[0] * allFour(axes[k][0]) + axis[1] * allFour(axes[k][1]) + axis[2] * allFour(axes[k][2]));
      reach += turn * allFour(half[k]);
      halves[k] += turn * node.half[i];
    }
    const Four along = absolute(axis[0] * way[0] + axis[1] * way[1] + axis[2] * way[2]);
    const Four gap = greatest(along - reach, zero);
    here += gap * gap;
    middle -= along * node.half[i];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Four along = way[0] * allFour(axes[k][0]) + way[1] * allFour(axes[k][1]) + way[2] * allFour(axes[k][2]);
    const Four gap = greatest(absolute(along) - halves[k] - allFour(half[k]), zero);
    there += gap * gap;
    middle -= absolute(along) * allFour(half[k]);
  }
  const Four between = greatest(middle, zero);
  return greatest(greatest(here, there), between * between / squared) + allFour(1e-12f) * squared;
}

/// A child of a node: its number is 4 * node + lane.
using Child = std::uint32_t;

float sizeOf(const Boxes& tree, Child child) { return tree.nodes[child / 4].half[1][child % 4]; }

/// Searches two trees for pairs of triangles that are near each other.
class Search {
 public:
  Search(const Boxes& a, const Boxes& b, const Pose& a_from_b)
      : a_(a), b_(b), a_from_b_(centered(a, b, a_from_b)), b_from_a_(centered(b, a, a_from_b.inverse())) {
    const double shift = centered(a, b, a_from_b).translation().norm();
    rounding_ = kFloatRounding * (a.reach + b.reach + shift);
  }

  /// Calls visit(i, j) for pairs of triangles whose boxes are within a limit [m], nearer boxes earlier. `visit` returns
  /// the limit for the rest of the search; less than 0 ends it.
  template <class Visit>
  void run(double limit, const Visit& visit) {
    setLimit(limit);
    waiting_[count_++] = {0, 0, 0};
    while (count_ > 0) {
      const Waiting next = waiting_[--count_];
      if (next.key > limit_key_) continue;
      const std::int32_t first = a_.nodes[next.first / 4].child[next.first % 4],
                         second = b_.nodes[next.second / 4].child[next.second % 4];
      if (first < 0 && second < 0) { ++nLeaf;
        const double rest = visit(~first, ~second);
        if (rest < 0.0) return;
        if (rest < limit) setLimit(limit = rest);
      } else if (second < 0 || (first >= 0 && sizeOf(a_, next.first) >= sizeOf(b_, next.second))) {
        expand(a_.nodes[first], Child(first), b_.nodes[next.second / 4], next.second % 4, a_from_b_,
               [&](Child child) { return Waiting{0, child, next.second}; });
      } else {
        expand(b_.nodes[second], Child(second), a_.nodes[next.first / 4], next.first % 4, b_from_a_,
               [&](Child child) { return Waiting{0, next.first, child}; });
      }
    }
  }

 private:
  struct Waiting {
    std::uint32_t key;  // lower bound
    Child first, second;
  };

  static Pose centered(const Boxes& a, const Boxes& b, const Pose& a_from_b) {
    Pose result = a_from_b;
    result.translation() = a_from_b * b.center - a.center;
    return result;
  }

  void setLimit(double limit) {
    const double raised = (limit + rounding_) * (1.0 + 1e-6);
    const float squared = static_cast<float>(raised * raised);
    std::memcpy(&limit_key_, &squared, sizeof(squared));
    limit_key_ |= 3u;
  }

  /// Adds the pairs of the children of a node and one box of another node, the nearest pair last.
  template <class Make>
  void expand(const Node& node, Child number, const Node& other, std::size_t lane, const Placement& place,
              const Make& make) {
    ++nExpand;
    const Four gaps = squaredGaps(node, other, lane, place);
    // Floats that are not negative are ordered like their bits. The last two bits of each gap make room for its lane.
    std::uint32_t keys[4];
    std::memcpy(keys, &gaps, sizeof(keys));
    for (std::uint32_t i = 0; i < 4; ++i) keys[i] = (keys[i] & ~3u) | i;
    const auto order = [&](int i, int k) {
      const std::uint32_t less = std::min(keys[i], keys[k]), more = std::max(keys[i], keys[k]);
      keys[i] = more;
      keys[k] = less;
    };
    order(0, 1);
    order(2, 3);
    order(0, 2);
    order(1, 3);
    order(1, 2);
    for (const std::uint32_t key : keys) {
      const Child i = key & 3u;
      if (key > limit_key_ || i >= static_cast<Child>(node.count)) continue;
      Waiting added = make(4 * number + i);
      added.key = key;
      waiting_[count_++] = added;
    }
  }

  const Boxes a_, b_;
  const Placement a_from_b_, b_from_a_;
  double rounding_ = 0.0;
  std::uint32_t limit_key_ = 0;
  std::size_t count_ = 0;
  std::array<Waiting, 128> waiting_;  // the last one is next
};

/// The box of a convex core, as a tree.
class CoreBox {
 public:
  explicit CoreBox(const ConvexCore& core) {
    Vector low, high;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = core.support(-Vector::Unit(axis))[axis];
      high[axis] = core.support(Vector::Unit(axis))[axis];
    }
    center_ = 0.5 * (low + high);
    reach_ = 0.5 * (high - low).norm();
    setChild(node_, 0, Matrix::Identity(), low - center_, high - center_, -1);
  }
  Boxes boxes() const { return {&node_, center_, reach_}; }

 private:
  Node node_{};
  Vector center_;
  double reach_;
};

Triangle moved(const Pose& pose, const Triangle& triangle) {
  return {pose * triangle[0], pose * triangle[1], pose * triangle[2]};
}

}  // namespace

/// Builds the nodes of a tree.
class MeshTree::Builder {
 public:
  Builder(MeshTree& tree, std::vector<Triangle> triangles) : tree_(tree), triangles_(std::move(triangles)) {
    for (const Triangle& t : triangles_) centers_.push_back((t[0] + t[1] + t[2]) / 3.0 - tree_.center_);
    order_.resize(triangles_.size());
    std::iota(order_.begin(), order_.end(), 0);
  }

  void build() {
    tree_.nodes_.resize(2);
    tree_.triangles_.reserve(triangles_.size());
    const Range all{order_.begin(), order_.end()};
    setBox(0, 0, all, 1);
    fill(1, all);
  }

 private:
  using Iterator = std::vector<std::uint32_t>::iterator;
  struct Range {
    Iterator begin, end;
    std::ptrdiff_t size() const { return end - begin; }
  };

  /// Returns the bounds of the triangles along some axes.
  std::pair<Vector, Vector> boundsOf(const Range& range, const Matrix& axes) const {
    Vector low = Vector::Constant(kInfinity), high = -low;
    for (auto i = range.begin; i != range.end; ++i) {
      for (const Vector& corner : triangles_[*i]) {
        const Vector along = axes * (corner - tree_.center_);
        low = low.cwiseMin(along);
        high = high.cwiseMax(along);
      }
    }
    return {low, high};
  }

  /// Returns the principal axes of the corners as rows. Rounds them to float, as the node stores them.
  Matrix axesOf(const Range& range) const {
    if (getenv("AABB")) return Matrix::Identity();
    Vector sum = Vector::Zero();
    Matrix squares = Matrix::Zero();
    for (auto i = range.begin; i != range.end; ++i) {
      for (const Vector& corner : triangles_[*i]) {
        const Vector v = corner - triangles_[*range.begin][0];
        sum += v;
        squares += v * v.transpose();
      }
    }
    const double count = 3.0 * double(range.size());
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(squares - sum * sum.transpose() / count);
    if (solver.info() != Eigen::Success) return Matrix::Identity();
    return alignedAxes(range, solver.eigenvectors().col(0)).cast<float>().cast<double>();
  }

  /// Returns axes whose first row is `normal`; the others are turned so that the sides of the box are short.
  Matrix alignedAxes(const Range& range, const Vector& normal) const {
    constexpr int kTurns = 8;
    const Vector x = normal.unitOrthogonal(), y = normal.cross(x);
    std::array<Vector, kTurns> directions;
    for (int i = 0; i < kTurns; ++i) directions[i] = std::cos(M_PI * i / kTurns) * x + std::sin(M_PI * i / kTurns) * y;
    if (range.size() == 1) {
      const Triangle& t = triangles_[*range.begin];
      Vector longest = t[1] - t[0];
      for (const Vector& e : {Vector(t[2] - t[1]), Vector(t[0] - t[2])}) if (e.squaredNorm() > longest.squaredNorm()) longest = e;
      Matrix axes;
      const Vector d = longest.normalized();
      axes << normal.transpose(), d.transpose(), normal.cross(d).transpose();
      return axes;
    }
    std::array<double, kTurns> low, high;
    low.fill(kInfinity);
    high.fill(-kInfinity);
    for (auto i = range.begin; i != range.end; ++i) {
      for (const Vector& corner : triangles_[*i]) {
        const Vector v = corner - tree_.center_;
        for (std::size_t k = 0; k < kTurns; ++k) {
          const double along = directions[k].dot(v);
          low[k] = std::min(low[k], along);
          high[k] = std::max(high[k], along);
        }
      }
    }
    std::size_t best = 0;
    double least = kInfinity;
    for (std::size_t k = 0; k < kTurns / 2; ++k) {
      const std::size_t across = k + kTurns / 2;
      const double area = (high[k] - low[k]) * (high[across] - low[across]);
      if (area < least) {
        least = area;
        best = k;
      }
    }
    Matrix axes;
    const auto longer = high[best] - low[best] < high[best + kTurns / 2] - low[best + kTurns / 2];
    axes << normal.transpose(), directions[longer ? best + kTurns / 2 : best].transpose(), directions[longer ? best : best + kTurns / 2].transpose();
    return axes;
  }

  /// Divides a range into two halves along the axis on which the centers of the triangles spread most.
  std::array<Range, 2> halves(const Range& range, const Matrix& axes) {
    Vector low = Vector::Constant(kInfinity), high = -low;
    for (auto i = range.begin; i != range.end; ++i) {
      const Vector along = axes * centers_[*i];
      low = low.cwiseMin(along);
      high = high.cwiseMax(along);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    const Iterator middle = range.begin + range.size() / 2;
    const Vector direction = axes.row(axis);
    const auto key = [&](std::uint32_t i) { return std::make_pair(direction.dot(centers_[i]), i); };
    std::nth_element(range.begin, middle, range.end, [&](std::uint32_t i, std::uint32_t j) { return key(i) < key(j); });
    return {Range{range.begin, middle}, Range{middle, range.end}};
  }

  std::vector<Range> quarters(const Range& range, const Matrix& axes) {
    std::vector<Range> parts;
    if (range.size() <= 4) {
      for (auto i = range.begin; i != range.end; ++i) parts.push_back({i, i + 1});
      return parts;
    }
    for (const Range& half : halves(range, axes)) {
      for (const Range& quarter : halves(half, axes)) parts.push_back(quarter);
    }
    return parts;
  }

  void setBox(std::size_t node, std::size_t lane, const Range& range, std::int32_t child) {
    const Matrix axes = axesOf(range);
    const auto [low, high] = boundsOf(range, axes);
    setChild(tree_.nodes_[node], lane, axes, low, high, child);
  }

  void fill(std::size_t number, const Range& range) {
    const std::vector<Range> parts = quarters(range, axesOf(range));
    for (std::size_t lane = 0; lane < parts.size(); ++lane) {
      std::size_t child = tree_.nodes_.size();
      if (parts[lane].size() == 1) {
        child = ~tree_.triangles_.size();
        tree_.triangles_.push_back(triangles_[*parts[lane].begin]);
      } else {
        tree_.nodes_.emplace_back();
      }
      setBox(number, lane, parts[lane], static_cast<std::int32_t>(child));
    }
    for (std::size_t lane = 0; lane < parts.size(); ++lane) {
      const std::int32_t child = tree_.nodes_[number].child[lane];
      if (child >= 0) fill(static_cast<std::size_t>(child), parts[lane]);
    }
  }

  MeshTree& tree_;
  std::vector<Triangle> triangles_;
  std::vector<Vector> centers_;  // of the triangles, relative to the center of the tree
  std::vector<std::uint32_t> order_;
};

MeshTree::MeshTree(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  Vector low = Vector::Constant(kInfinity), high = -low;
  for (const auto& t : mesh.triangles) {
    triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
    for (const Vector& corner : triangles.back()) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  center_ = 0.5 * (low + high);
  reach_ = 0.5 * (high - low).norm();
  Builder(*this, std::move(triangles)).build();
}

CoreGap MeshTree::gapTo(const ConvexCore& core, const Pose& mesh_from_core, double up_to) const {
  const CoreBox box(core);
  CoreGap best;
  best.lower = best.upper = kInfinity;
  Search(boxes(), box.boxes(), mesh_from_core).run(up_to, [&](std::int32_t i, std::int32_t) {
    const Triangle& triangle = triangles_[std::size_t(i)];
    const double enough = std::min(up_to, best.upper);
    const CoreGap gap = gapOf(ConvexCore::hull(triangle.data(), triangle.size()), core, mesh_from_core, enough);
    if (gap.lower <= 0.0 || (gap.upper < best.upper && gap.lower <= up_to)) best = gap;
    return best.lower <= 0.0 ? -1.0 : best.upper;
  });
  return best;
}

CoreGap MeshTree::gapTo(const MeshTree& other, const Pose& mesh_from_other, double up_to) const {
  CoreGap best;
  best.lower = best.upper = kInfinity;
  Search(boxes(), other.boxes(), mesh_from_other).run(up_to, [&](std::int32_t i, std::int32_t j) {
    const double enough = std::min(up_to, best.upper);
    const CoreGap gap = gapOfTriangles(triangles_[std::size_t(i)],
                                       moved(mesh_from_other, other.triangles_[std::size_t(j)]), 10, enough);
    if (gap.lower <= 0.0 || (gap.upper < best.upper && gap.lower <= up_to)) best = gap;
    return best.lower <= 0.0 ? -1.0 : best.upper;
  });
  return best;
}

bool MeshTree::meetings(const ConvexCore& core, const Pose& mesh_from_core, double reach, const Met& met) const {
  const CoreBox box(core);
  bool more = true;
  Search(boxes(), box.boxes(), mesh_from_core).run(reach, [&](std::int32_t i, std::int32_t) {
    const Triangle& triangle = triangles_[std::size_t(i)];
    const CoreGap gap = gapOf(ConvexCore::hull(triangle.data(), triangle.size()), core, mesh_from_core, reach);
    if (!(gap.lower > reach)) more = met(gap);
    return more ? reach : -1.0;
  });
  return more;
}

bool MeshTree::meetings(const MeshTree& other, const Pose& mesh_from_other, double reach, const Met& met) const {
  bool more = true;
  Search(boxes(), other.boxes(), mesh_from_other).run(reach, [&](std::int32_t i, std::int32_t j) {
    const CoreGap gap = gapOfTriangles(triangles_[std::size_t(i)],
                                       moved(mesh_from_other, other.triangles_[std::size_t(j)]), 10, reach);
    if (!(gap.lower > reach)) more = met(gap);
    return more ? reach : -1.0;
  });
  return more;
}

}  // namespace hgrid
