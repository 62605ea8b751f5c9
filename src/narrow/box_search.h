// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "hgrid_proximity/geometry/pose.h"
#include "narrow/box_tree.h"

namespace hgrid {

/// A rigid transform in float.
struct FloatPose {
  explicit FloatPose(const Pose& pose);
  float turn[3][3], shift[3];
};

/// Returns lower bounds of the distances of the children of a node and one box of another node, squared.
///
/// A bound is proved by the axes of the boxes and by the direction between their centers. Each bound also contains a
/// millionth of the distance of the centers, so that the nearest of several overlapping boxes comes first. So the bound
/// of the distance, not squared, can be too large by `kBoxRounding` times the sum of both reaches and of the distance
/// of the centers of the trees.
Four squaredGaps(const BoxNode& node, const BoxNode& other, std::size_t lane, const FloatPose& pose);
constexpr double kBoxRounding = 64.0 * 0x1p-24;  // the millionth is 17 of these 64 units of rounding

/// Searches two trees for pairs of triangles that are near each other.
class BoxSearch {
 public:
  BoxSearch(const BoxTree& a, const BoxTree& b, const Pose& a_from_b)
      : BoxSearch(a, b, centered(a, b, a_from_b), centered(b, a, a_from_b.inverse())) {}

  /// Calls visit(i, j) for the pairs of triangles whose boxes are within a limit [m], near boxes early. `visit` returns
  /// the new limit, or a number less than 0 to end the search. isFarther(i, j, limit) may return true if all triangles
  /// below node i of the first tree and node j of the second are farther apart than the limit; they are then left out.
  template <class Visit, class IsFarther>
  void run(double limit, const Visit& visit, IsFarther&& isFarther) {
    setLimit(limit);
    waiting_[0] = {0, 0, 0};
    count_ = 1;
    while (count_ > 0) {
      const Waiting next = waiting_[--count_];
      if (next.key > limit_key_) continue;
      const BoxNode &node_a = a_[next.first / 4], &node_b = b_[next.second / 4];
      const std::size_t lane_a = next.first % 4, lane_b = next.second % 4;
      const std::int32_t first = node_a.child[lane_a], second = node_b.child[lane_b];
      if (first >= 0 && second >= 0 &&
          isFarther(static_cast<std::size_t>(first), static_cast<std::size_t>(second), limit)) {
        continue;
      }
      if (first < 0 && second < 0) {
        const double rest = visit(static_cast<std::size_t>(~first), static_cast<std::size_t>(~second));
        if (rest < 0.0) return;
        if (rest != limit) setLimit(limit = rest);
      } else if (second < 0 || (first >= 0 && sizeOf(node_a, lane_a) >= sizeOf(node_b, lane_b))) {
        const auto number = static_cast<Child>(first);
        expand(a_[number], node_b, lane_b, a_from_b_, [&](std::uint32_t key, Child lane) {
          return Waiting{key, 4 * number + lane, next.second};
        });
      } else {
        const auto number = static_cast<Child>(second);
        expand(b_[number], node_a, lane_a, b_from_a_, [&](std::uint32_t key, Child lane) {
          return Waiting{key, next.first, 4 * number + lane};
        });
      }
    }
  }

 private:
  using Child = std::uint32_t;  // 4 * number of its node + lane
  struct Waiting {
    std::uint32_t key;  // bits of the lower bound
    Child first, second;
  };

  BoxSearch(const BoxTree& a, const BoxTree& b, const Pose& a_from_b, const Pose& b_from_a)
      : a_(a.nodes.data()),
        b_(b.nodes.data()),
        a_from_b_(a_from_b),
        b_from_a_(b_from_a),
        rounding_(kBoxRounding * (a.reach + b.reach + a_from_b.translation().norm())) {}

  /// Returns the pose relative to the centers of the trees.
  static Pose centered(const BoxTree& a, const BoxTree& b, const Pose& a_from_b) {
    Pose result = a_from_b;
    result.translation() = a_from_b * b.center - a.center;
    return result;
  }

  static float sizeOf(const BoxNode& node, std::size_t lane) {
    return node.half[0][lane] + node.half[1][lane] + node.half[2][lane];
  }

  void setLimit(double limit) {
    constexpr double kGrown = 1.0 + 1e-6;  // makes up for the rounding of the square to float
    const double raised = (limit + rounding_) * kGrown;
    const auto squared = static_cast<float>(raised * raised);
    std::memcpy(&limit_key_, &squared, sizeof(squared));
    limit_key_ |= 3u;
  }

  /// Adds the pairs of the children of a node and one box of another node, the nearest pair last.
  template <class Make>
  void expand(const BoxNode& node, const BoxNode& other, std::size_t lane, const FloatPose& pose, const Make& make) {
    const Four gaps = squaredGaps(node, other, lane, pose);
    // The bits of floats that are not negative have the order of the floats. The lane replaces the last two bits.
    std::array<std::uint32_t, 4> keys;
    std::memcpy(keys.data(), &gaps, sizeof(keys));
    for (std::uint32_t i = 0; i < 4; ++i) keys[i] = (keys[i] & ~3u) | i;
    const auto sort = [&keys](std::size_t i, std::size_t k) {
      const std::uint32_t less = std::min(keys[i], keys[k]), more = std::max(keys[i], keys[k]);
      keys[i] = more;
      keys[k] = less;
    };
    // A sorting network, the largest first. Branches would be mispredicted.
    sort(0, 1);
    sort(2, 3);
    sort(0, 2);
    sort(1, 3);
    sort(1, 2);
    for (const std::uint32_t key : keys) {
      if (key <= limit_key_ && (key & 3u) < static_cast<Child>(node.count)) waiting_[count_++] = make(key, key & 3u);
    }
  }

  const BoxNode *a_, *b_;
  const FloatPose a_from_b_, b_from_a_;
  const double rounding_;  // [m]
  std::uint32_t limit_key_ = 0;
  std::size_t count_ = 0;
  std::array<Waiting, 6 * BoxTree::kMostLevels + 4> waiting_;  // the last one is next; a level leaves at most three
};

}  // namespace hgrid
