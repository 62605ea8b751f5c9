// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/mesh_tree.h"

#include <algorithm>
#include <array>
#include <limits>

#include "geometry/infinity.h"
#include "narrow/box_search.h"
#include "narrow/gjk.h"

namespace hgrid {
namespace {

std::vector<Triangle> trianglesOf(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  }
  return triangles;
}

/// Measures a triangle of the mesh and a convex core, in the frame of the mesh.
struct CoreMeter {
  CoreGap operator()(std::size_t i, std::size_t, const GapLimits& limits) const {
    return gapOf(ConvexCore::hull(triangles[i].data(), 3), core, mesh_from_solid, limits);
  }
  const std::vector<Triangle>& triangles;
  const ConvexCore& core;
  const Pose& mesh_from_solid;
};

/// Measures two triangles of two meshes, in the frame of the first.
struct TriangleMeter {
  TriangleMeter(const std::vector<Triangle>& a, const BoxTree& a_boxes, const std::vector<Triangle>& b,
                const BoxTree& b_boxes, const Pose& pose)
      : mine(a),
        theirs(b),
        mesh_from_other(pose),
        size(2.0 * (a_boxes.center.norm() + a_boxes.reach + (pose * b_boxes.center).norm() + b_boxes.reach)) {}

  CoreGap operator()(std::size_t i, std::size_t j, const GapLimits& limits) const {
    const Triangle& t = theirs[j];
    return gapOfTriangles(mine[i], {mesh_from_other * t[0], mesh_from_other * t[1], mesh_from_other * t[2]}, size,
                          limits);
  }
  const std::vector<Triangle>&mine, &theirs;
  const Pose& mesh_from_other;
  double size;  // [m] for gapOfTriangles()
};

/// For BoxSearch::run(): only the boxes decide what is left out.
constexpr auto neverFarther = [](std::size_t, std::size_t, double) { return false; };

/// For BoxSearch::run(): compares the hulls of two nodes. Stops doing so if it is seldom of use, as in a search of two
/// meshes that touch in many places.
class HullsAreFarther {
 public:
  /// @param a, b  hulls of the nodes of both trees; null: they are not known
  HullsAreFarther(const MeshHull* a, const MeshHull* b, const Pose& a_from_b)
      : a_(a), b_(b), a_from_b_(a_from_b), attempts_(a != nullptr && b != nullptr ? kAttempts : 0) {}

  bool operator()(std::size_t i, std::size_t j, double limit) {
    if (attempts_ <= 0) return false;
    const bool apart = a_[i].isApart(b_[j], a_from_b_, limit);
    attempts_ += apart ? kGained : -1;
    return apart;
  }

 private:
  static constexpr int kAttempts = 16;  // attempts at the beginning
  static constexpr int kGained = 3;     // further attempts for each one that was of use

  const MeshHull *const a_, *const b_;
  const Pose& a_from_b_;
  int attempts_;  // how many are left
};

/// Returns the least gap of two parts; it is infinite if it is larger than GapLimits::enough.
template <class Meter, class IsFarther>
CoreGap leastGap(BoxSearch search, const Meter& measure, const GapLimits& limits, IsFarther isFarther) {
  const double up_to = limits.enough;
  CoreGap best;
  std::size_t best_i = 0, best_j = 0;
  double least = best.lower = kInfinity;  // of the lower bounds of all parts
  const auto visit = [&](std::size_t i, std::size_t j) {
    const double enough = std::min(up_to, best.upper);
    const CoreGap gap = measure(i, j, {limits.touch, enough, false});
    least = std::min(least, gap.lower);
    if (gap.lower <= 0.0 || (gap.upper < best.upper && gap.lower <= enough)) {
      best = gap;
      best_i = i;
      best_j = j;
    }
    return best.lower <= 0.0 ? -1.0 : std::min(up_to, best.upper);
  };
  search.run(up_to, visit, isFarther);
  if (best.lower > limits.touch && best.upper < kInfinity && best.normal.isZero())
    best = measure(best_i, best_j, limits);
  best.lower = std::min(best.lower, least);
  return best;
}

template <class Meter>
void allMeetings(BoxSearch search, const Meter& measure, const GapLimits& limits, const MeshTree::Met& met) {
  const double reach = limits.enough;
  const auto visit = [&](std::size_t i, std::size_t j) {
    const CoreGap gap = measure(i, j, limits);
    return gap.lower > reach || met(gap) ? reach : -1.0;
  };
  search.run(reach, visit, neverFarther);
}

}  // namespace

MeshTree::MeshTree(const TriangleMesh& mesh) : triangles_(trianglesOf(mesh)), boxes_(boxTreeOf(triangles_)) {}

Eigen::Vector3d MeshTree::support(const Eigen::Vector3d& direction) const {
  struct Waiting {
    float most;  // [m] upper bound for the triangles below the node, times the length of the direction
    std::size_t node;
  };
  std::array<Waiting, 3 * BoxTree::kMostLevels + 1> waiting;  // the last one is next; a level leaves at most three
  const auto rounding = static_cast<float>(2.0 * kBoxRounding * boxes_.reach * direction.norm());
  const auto x = static_cast<float>(direction.x()), y = static_cast<float>(direction.y()),
             z = static_cast<float>(direction.z());
  const double from_center = direction.dot(boxes_.center);
  Eigen::Vector3d farthest = triangles_.front().front();
  double most = direction.dot(farthest) - from_center;
  waiting[0] = {std::numeric_limits<float>::infinity(), 0};
  for (std::size_t count = 1; count > 0;) {
    const Waiting next = waiting[--count];
    if (static_cast<double>(next.most) <= most) continue;
    const BoxNode& node = boxes_.nodes[next.node];
    Four bounds = rounding + x * node.center[0] + y * node.center[1] + z * node.center[2];
    for (std::size_t i = 0; i < 3; ++i) {
      const Four along = x * node.axes[i][0] + y * node.axes[i][1] + z * node.axes[i][2];
      bounds += greatest(along, -along) * node.half[i];
    }
    const std::size_t begin = count;
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(node.count); ++lane) {
      const float bound = bounds[lane];
      if (static_cast<double>(bound) <= most) continue;
      if (node.child[lane] >= 0) {
        std::size_t place = count++;  // sorted, the node with the greatest bound last
        for (; place > begin && waiting[place - 1].most > bound; --place) waiting[place] = waiting[place - 1];
        waiting[place] = {bound, static_cast<std::size_t>(node.child[lane])};
        continue;
      }
      for (const Eigen::Vector3d& corner : triangles_[static_cast<std::size_t>(~node.child[lane])]) {
        const double along = direction.dot(corner) - from_center;
        if (along <= most) continue;
        most = along;
        farthest = corner;
      }
    }
  }
  return farthest;
}

void MeshTree::makeHulls() const {
  std::call_once(hulls_made_, [this] {
    if (triangles_.size() > kMostTriangles) return;
    hulls_ = hullsOf(boxes_, triangles_);
    known_hulls_.store(hulls_.data(), std::memory_order_release);
  });
}

CoreGap MeshTree::gapTo(const ConvexSolid& solid, const Pose& mesh_from_solid, const GapLimits& limits) const {
  return leastGap(BoxSearch(boxes_, solid.box(), mesh_from_solid), CoreMeter{triangles_, solid.core(), mesh_from_solid},
                  limits, neverFarther);
}

CoreGap MeshTree::gapTo(const MeshTree& other, const Pose& mesh_from_other, const GapLimits& limits) const {
  return leastGap(BoxSearch(boxes_, other.boxes_, mesh_from_other),
                  TriangleMeter(triangles_, boxes_, other.triangles_, other.boxes_, mesh_from_other), limits,
                  HullsAreFarther(known_hulls_.load(std::memory_order_acquire),
                                  other.known_hulls_.load(std::memory_order_acquire), mesh_from_other));
}

void MeshTree::meetings(const ConvexSolid& solid, const Pose& mesh_from_solid, const GapLimits& limits,
                        const Met& met) const {
  allMeetings(BoxSearch(boxes_, solid.box(), mesh_from_solid), CoreMeter{triangles_, solid.core(), mesh_from_solid},
              limits, met);
}

void MeshTree::meetings(const MeshTree& other, const Pose& mesh_from_other, const GapLimits& limits,
                        const Met& met) const {
  allMeetings(BoxSearch(boxes_, other.boxes_, mesh_from_other),
              TriangleMeter(triangles_, boxes_, other.triangles_, other.boxes_, mesh_from_other), limits, met);
}

}  // namespace hgrid
