// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/winding_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "geometry/arc_tangent.h"

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

constexpr std::uint32_t kLeaf = 8;  // largest number of triangles in a node without children

/// An edge of a boundary. `count` is how often it leads from `low` to `high`, minus how often it leads back.
struct CountedEdge {
  std::uint32_t low, high;
  int count;
};

bool before(const CountedEdge& a, const CountedEdge& b) {
  return std::make_pair(a.low, a.high) < std::make_pair(b.low, b.high);
}

/// Adds up the counts of equal edges in a sorted list, and removes edges that cancel each other.
void cancel(std::vector<CountedEdge>& edges) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size();) {
    CountedEdge sum = edges[i];
    for (++i; i < edges.size() && !before(sum, edges[i]); ++i) sum.count += edges[i].count;
    if (sum.count != 0) edges[kept++] = sum;
  }
  edges.resize(kept);
}

/// Returns half of the solid angle of a triangle seen from a point (Van Oosterom, Strackee 1983).
double halfAngle(const Vector& point, const Vector& first, const Vector& second, const Vector& third) {
  const Vector a = first - point, b = second - point, c = third - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return arcTangent(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

constexpr double kGrazes = 1e-12;  // a line this close to an edge, as a share of the lengths, may be on either side

/// Adds a triangle to the view along a line. @param relative  its corners, relative to the start of the line
void lookAt(const std::array<Vector, 3>& relative, const Vector& direction, LineView& view) {
  bool left = false, right = false, grazes = false;  // on which sides of the edges the line passes
  double across = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector &from = relative[i], &to = relative[(i + 1) % 3];
    const double side = direction.dot(from.cross(to));
    across += side;
    const double least = kGrazes * from.norm() * to.norm();
    left = left || side > least;
    right = right || side < -least;
    grazes = grazes || std::abs(side) <= least;
  }
  if (left && right) return;
  if (grazes) {
    view.unsure = true;
    return;
  }
  const double distance = relative[0].dot((relative[1] - relative[0]).cross(relative[2] - relative[0])) / across;
  if (!(distance > 0.0)) return;
  view.sum += across > 0.0 ? 1 : -1;
  if (distance > view.distance + view.thin) return;
  if (distance < view.distance - view.thin) view.front = view.back = false;
  view.distance = std::min(view.distance, distance);
  (across > 0.0 ? view.back : view.front) = true;
}

/// Whether a line from a point may meet a box that is `more` [m] larger on each side.
/// @param per_length  1 / the components of the direction
bool mayMeet(const Vector& low, const Vector& high, double more, const Vector& point, const Vector& per_length) {
  double begin = 0.0, end = std::numeric_limits<double>::infinity();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - more - point[axis]) * per_length[axis];
    const double b = (high[axis] + more - point[axis]) * per_length[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

}  // namespace

class WindingTree::Builder {
 public:
  explicit Builder(WindingTree& tree) : tree_(tree) {}

  /// Creates the node of some triangles and all nodes below it. Sorts the triangles. @returns the boundary
  std::vector<CountedEdge> add(Span range) {
    const std::size_t number = tree_.nodes_.size();
    tree_.nodes_.emplace_back();
    setBox(tree_.nodes_[number], range);
    std::vector<CountedEdge> boundary;
    if (range.end - range.begin <= kLeaf) {
      boundary = edgesOf(range);
    } else {
      const std::uint32_t middle = halved(range, tree_.nodes_[number]);
      boundary = add({range.begin, middle});
      tree_.nodes_[number].second_child = static_cast<std::uint32_t>(tree_.nodes_.size());
      const std::vector<CountedEdge> other = add({middle, range.end});
      const auto size = static_cast<std::ptrdiff_t>(boundary.size());
      boundary.insert(boundary.end(), other.begin(), other.end());
      std::inplace_merge(boundary.begin(), boundary.begin() + size, boundary.end(), before);
    }
    cancel(boundary);
    store(boundary, tree_.nodes_[number]);
    return boundary;
  }

 private:
  void setBox(Node& node, Span range) const {
    node.triangles = range;
    node.low.setConstant(std::numeric_limits<double>::infinity());
    node.high = -node.low;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      for (const std::uint32_t corner : tree_.triangles_[i]) {
        node.low = node.low.cwiseMin(tree_.vertices_[corner]);
        node.high = node.high.cwiseMax(tree_.vertices_[corner]);
      }
    }
  }

  std::vector<CountedEdge> edgesOf(Span range) const {
    std::vector<CountedEdge> edges;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const Corners& t = tree_.triangles_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = t[k], to = t[(k + 1) % 3];
        edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
      }
    }
    std::sort(edges.begin(), edges.end(), before);
    return edges;
  }

  /// Sorts the triangles into two halves along the longest side of the box. @returns where the second half begins
  std::uint32_t halved(Span range, const Node& node) {
    Eigen::Index axis = 0;
    (node.high - node.low).maxCoeff(&axis);
    const auto place = [&](const Corners& t) {
      return tree_.vertices_[t[0]][axis] + tree_.vertices_[t[1]][axis] + tree_.vertices_[t[2]][axis];
    };
    const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
    const auto begin = tree_.triangles_.begin();
    std::nth_element(begin + range.begin, begin + middle, begin + range.end, [&](const Corners& a, const Corners& b) {
      return std::make_pair(place(a), a) < std::make_pair(place(b), b);
    });
    return middle;
  }

  /// Stores a boundary if it has at most half as many edges as the node has triangles.
  void store(const std::vector<CountedEdge>& boundary, Node& node) {
    std::size_t edges = 0;
    for (const CountedEdge& edge : boundary) edges += static_cast<std::size_t>(std::abs(edge.count));
    node.has_boundary = 2 * edges <= node.triangles.end - node.triangles.begin;
    if (!node.has_boundary) return;
    node.boundary.begin = static_cast<std::uint32_t>(tree_.edges_.size());
    for (const CountedEdge& edge : boundary) {
      const Edge directed = edge.count > 0 ? Edge{edge.low, edge.high} : Edge{edge.high, edge.low};
      tree_.edges_.insert(tree_.edges_.end(), static_cast<std::size_t>(std::abs(edge.count)), directed);
    }
    node.boundary.end = static_cast<std::uint32_t>(tree_.edges_.size());
  }

  WindingTree& tree_;
};

WindingTree::WindingTree(std::vector<Eigen::Vector3d> vertices, std::vector<Corners> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
  if (!triangles_.empty()) closed_ = Builder(*this).add({0, static_cast<std::uint32_t>(triangles_.size())}).empty();
}

double WindingTree::windingNumber(const Eigen::Vector3d& point) const {
  return nodes_.empty() ? 0.0 : halfAngles(0, point) / (2.0 * M_PI);
}

void WindingTree::look(const Vector& point, const Vector& direction, LineView& view) const {
  if (!nodes_.empty()) look(0, point, direction, direction.cwiseInverse(), view);
}

void WindingTree::look(std::size_t number, const Vector& point, const Vector& direction, const Vector& per_length,
                       LineView& view) const {
  const Node& node = nodes_[number];
  if (!mayMeet(node.low, node.high, view.thin, point, per_length)) return;
  if (node.second_child != 0) {
    look(number + 1, point, direction, per_length, view);
    look(node.second_child, point, direction, per_length, view);
    return;
  }
  for (std::uint32_t i = node.triangles.begin; i < node.triangles.end; ++i) {
    const auto& [a, b, c] = triangles_[i];
    lookAt({vertices_[a] - point, vertices_[b] - point, vertices_[c] - point}, direction, view);
  }
}

double WindingTree::halfAngles(std::size_t number, const Eigen::Vector3d& point) const {
  const Node& node = nodes_[number];
  double sum = 0.0;
  if (node.has_boundary && !node.holds(point)) {
    for (std::uint32_t i = node.boundary.begin; i < node.boundary.end; ++i) {
      const auto& [from, to] = edges_[i];
      sum += halfAngle(point, vertices_[edges_[node.boundary.begin].first], vertices_[from], vertices_[to]);
    }
  } else if (node.second_child != 0) {
    sum = halfAngles(number + 1, point) + halfAngles(node.second_child, point);
  } else {
    for (std::uint32_t i = node.triangles.begin; i < node.triangles.end; ++i) {
      const Corners& t = triangles_[i];
      sum += halfAngle(point, vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]);
    }
  }
  return sum;
}

}  // namespace hgrid
