// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/face_directions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace hgrid {
namespace {

using Corners = WindingTree::Corners;
using Index = std::uint32_t;
using Vector = Eigen::Vector3d;

struct GivenFace {
  Corners corners;              // in ascending order
  int ahead = 0, backward = 0;  // number of triangles that visit the corners in this order, or in the other order
};

struct GivenFaces {
  std::vector<GivenFace> faces;
  std::vector<Index> of_triangle;  // for each triangle: number of its face
};

GivenFaces facesOf(const std::vector<Corners>& triangles) {
  std::vector<std::pair<Corners, Index>> sorted;
  sorted.reserve(triangles.size());
  for (Index i = 0; i < triangles.size(); ++i) {
    sorted.emplace_back(triangles[i], i);
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  GivenFaces result;
  result.of_triangle.resize(triangles.size());
  for (const auto& [corners, triangle] : sorted) {
    if (result.faces.empty() || result.faces.back().corners != corners) result.faces.push_back({corners});
    GivenFace& face = result.faces.back();
    const Corners& t = triangles[triangle];
    const auto least = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
    ++(t[(least + 1) % 3] < t[(least + 2) % 3] ? face.ahead : face.backward);
    result.of_triangle[triangle] = static_cast<Index>(result.faces.size() - 1);
  }
  return result;
}

/// An edge of a face. `direction` is 1 if the face visits `low` before `high`, or else -1.
struct FaceEdge {
  Index low, high, face;
  int direction;
};

std::vector<FaceEdge> edgesOf(const std::vector<GivenFace>& faces) {
  std::vector<FaceEdge> edges;
  edges.reserve(3 * faces.size());
  for (Index i = 0; i < faces.size(); ++i) {
    const auto& [a, b, c] = faces[i].corners;
    edges.push_back({a, b, i, 1});
    edges.push_back({b, c, i, 1});
    edges.push_back({a, c, i, -1});
  }
  std::sort(edges.begin(), edges.end(), [](const FaceEdge& a, const FaceEdge& b) {
    return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
  });
  return edges;
}

/// Calls use(begin, end) for each edge, with the faces that meet in it.
template <class Use>
void forEachEdge(const std::vector<FaceEdge>& edges, const Use& use) {
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(), [begin](const FaceEdge& edge) {
      return edge.low != begin->low || edge.high != begin->high;
    });
    use(begin, end);
    begin = end;
  }
}

/// Divides faces into patches, in a union-find forest. Knows for each face whether it is turned against the root of its
/// patch, so that its neighbors agree with it.
class PatchForest {
 public:
  struct Place {
    Index root;
    int turn;  // 1, or -1: turned against the root
  };

  explicit PatchForest(std::size_t faces) : up_(faces), two_sided_(faces, 1) {
    for (Index i = 0; i < faces; ++i) up_[i] = {i, 1};
  }

  Place placeOf(Index face) {
    int turn = 1;
    while (up_[face].root != face) {
      const Place above = up_[up_[face].root];
      up_[face] = {above.root, up_[face].turn * above.turn};  // shortens the path
      turn *= up_[face].turn;
      face = up_[face].root;
    }
    return {face, turn};
  }

  /// @param turn  1 if the two faces agree as they are, or else -1
  void connect(Index one, Index other, int turn) {
    const Place a = placeOf(one), b = placeOf(other);
    if (a.root == b.root) {
      if (a.turn * b.turn != turn) two_sided_[a.root] = 0;
    } else {
      up_[b.root] = {a.root, a.turn * b.turn * turn};
      two_sided_[a.root] &= two_sided_[b.root];
    }
  }

  /// Returns whether all neighbors can agree. @param root  of a patch
  bool isTwoSided(Index root) const { return two_sided_[root] != 0; }

 private:
  std::vector<Place> up_;
  std::vector<std::uint8_t> two_sided_;
};

struct Patch {
  bool closed = true;       // whether its edges cancel
  bool agrees = true;       // whether the given directions agree
  bool given_twice = true;  // whether each face is given as often for one side as for the other
  int times = 0;            // how often the first face was given, negative if it is turned against the root
  double volume = 0.0;      // [6 m^3] that it encloses, if all faces agree with the root
  double given_area = 0.0;  // [2 m^2] area that is given with the direction of the root, minus that with the other
  bool isKept(bool two_sided) const { return agrees || !two_sided || (given_twice && !closed); }
};

/// Sets Patch::closed.
void findOpen(const std::vector<FaceEdge>& edges, PatchForest& forest, std::vector<Patch>& patches) {
  std::vector<std::pair<Index, int>> sums;
  forEachEdge(edges, [&](auto begin, auto end) {
    sums.clear();
    for (auto edge = begin; edge != end; ++edge) {
      const auto [root, turn] = forest.placeOf(edge->face);
      sums.emplace_back(root, turn * edge->direction);
    }
    std::sort(sums.begin(), sums.end());
    for (std::size_t i = 0; i < sums.size();) {
      const Index root = sums[i].first;
      int sum = 0;
      for (; i < sums.size() && sums[i].first == root; ++i) sum += sums[i].second;
      if (sum != 0) patches[root].closed = false;
    }
  });
}

/// Returns a patch for each face; those of the roots of the forest are the patches of their faces.
std::vector<Patch> patchesOf(const std::vector<Vector>& vertices, const std::vector<GivenFace>& faces,
                             PatchForest& forest) {
  const std::vector<FaceEdge> edges = edgesOf(faces);
  forEachEdge(edges, [&forest](auto begin, auto end) {
    if (end - begin == 2) forest.connect(begin->face, begin[1].face, -begin->direction * begin[1].direction);
  });
  std::vector<Patch> patches(faces.size());
  findOpen(edges, forest, patches);
  for (Index i = 0; i < faces.size(); ++i) {
    const auto [root, turn] = forest.placeOf(i);
    const auto& [corners, ahead, backward] = faces[i];
    Patch& patch = patches[root];
    const int times = turn * (ahead - backward);
    if (patch.times == 0) patch.times = times;
    patch.agrees = patch.agrees && (ahead == 0 || backward == 0) && times == patch.times;
    patch.given_twice = patch.given_twice && times == 0;
    const Vector& first = vertices[faces[root].corners[0]];  // nearer than the origin, so there is less rounding
    const Vector a = vertices[corners[0]] - first, b = vertices[corners[1]] - first, c = vertices[corners[2]] - first;
    patch.volume += turn * a.dot(b.cross(c));
    patch.given_area += times * (b - a).cross(c - a).norm();
  }
  return patches;
}

}  // namespace

FaceDirections faceDirections(const std::vector<Vector>& vertices, const std::vector<Corners>& triangles) {
  const auto [faces, face_of_triangle] = facesOf(triangles);
  PatchForest forest(faces.size());
  const std::vector<Patch> patches = patchesOf(vertices, faces, forest);
  FaceDirections result;
  bool outward = false, inward = false;
  for (Index i = 0; i < faces.size(); ++i) {
    const auto [root, turn] = forest.placeOf(i);
    const Patch& patch = patches[root];
    result.simple = result.simple && patch.closed && forest.isTwoSided(root);
    if (patch.isKept(forest.isTwoSided(root))) {
      outward = outward || patch.times * patch.volume >= 0.0;
      inward = inward || patch.times * patch.volume <= 0.0;
      continue;
    }
    Corners corners = faces[i].corners;
    if (turn * (patch.closed ? patch.volume : patch.given_area) < 0.0) std::swap(corners[1], corners[2]);
    result.corrected.push_back(corners);
  }
  result.simple = result.simple && !(outward && inward);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Index root = forest.placeOf(face_of_triangle[i]).root;
    if (patches[root].isKept(forest.isTwoSided(root))) result.given.push_back(triangles[i]);
  }
  return result;
}

}  // namespace hgrid
