// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/bounds_tree.h"

#include <Eigen/Core>

#include "geometry/infinity.h"

namespace hgrid {
namespace {

constexpr kernels::Box kEmpty = {{kFloatInfinity, kFloatInfinity, kFloatInfinity},
                                 {-kFloatInfinity, -kFloatInfinity, -kFloatInfinity}};

std::size_t boxesAbove(std::size_t boxes) { return (boxes + kernels::Tier::kFan - 1) / kernels::Tier::kFan; }

/// Returns the smallest box that contains `count` successive boxes.
/// @tparam kCount  `count`, if it is known when this is compiled (the loops are faster then), else Eigen::Dynamic
template <int kCount>
kernels::Box boundsOf(const kernels::Columns& boxes, std::size_t begin, Eigen::Index count) {
  using Values = Eigen::Map<const Eigen::Array<float, kCount, 1>>;
  kernels::Box box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.min[axis] = Values(boxes.bounds + axis * boxes.stride + begin, count).minCoeff();
    box.max[axis] = Values(boxes.bounds + (axis + 3) * boxes.stride + begin, count).maxCoeff();
  }
  return box;
}

}  // namespace

/// Returns the size of bounds_ for this number of leaves.
std::size_t BoundsTree::valuesFor(std::size_t leaves) {
  std::size_t values = 0;
  for (std::size_t boxes = leaves;; boxes = boxesAbove(boxes)) {
    values += 6 * (boxes + kReadBeyond);
    if (boxes <= kernels::Tier::kFan) return values;
  }
}

/// Allocates the memory for this number of leaves. The hierarchy keeps its boxes.
void BoundsTree::reserve(std::size_t leaves) {
  const std::size_t values = valuesFor(leaves);
  if (values <= bounds_.capacity()) return;
  bounds_.reserve(bounds_.capacity() == 0 ? values : values + values / 16);
  const float* from = bounds_.data();
  for (int tier = 0; tier < tier_count_; ++tier) {
    tiers_[static_cast<std::size_t>(tier)].bounds = from;
    from += 6 * tiers_[static_cast<std::size_t>(tier)].stride;
  }
}

void BoundsTree::setLevels(const std::vector<kernels::Level>& levels) {
  per_leaf_ = 0;
  build(levels.size(), [&levels](std::size_t number) { return levels[number].around; });
}

void BoundsTree::setBoxes(const kernels::Level& level) {
  per_leaf_ = kPerLeaf;
  build(leavesFor(level.end), [&level](std::size_t number) {
    const std::size_t begin = number * kPerLeaf, count = std::min<std::size_t>(kPerLeaf, level.end - begin);
    return count == kPerLeaf ? boundsOf<kPerLeaf>(level, begin, kPerLeaf)
                             : boundsOf<Eigen::Dynamic>(level, begin, static_cast<Eigen::Index>(count));
  });
}

/// Builds all tiers.
/// @param leaf_at  called as kernels::Box leaf_at(number)
template <class LeafAt>
void BoundsTree::build(std::size_t leaves, const LeafAt& leaf_at) {
  tier_count_ = 0;
  if (leaves == 0) return;
  if (const std::size_t values = valuesFor(leaves); bounds_.size() < values) bounds_.resize(values);
  float* to = bounds_.data();
  for (std::size_t boxes = leaves; boxes > 0; boxes = boxesAbove(boxes)) {
    const std::size_t stride = boxes + kReadBeyond;
    for (std::size_t number = 0; number < boxes; ++number) {
      kernels::Box box = kEmpty;
      if (tier_count_ == 0) {
        box = leaf_at(number);
      } else {
        const kernels::Tier& below = tiers_[static_cast<std::size_t>(tier_count_ - 1)];
        const auto first = static_cast<std::uint32_t>(number) * kernels::Tier::kFan;
        for (std::uint32_t i = first; i < std::min(first + kernels::Tier::kFan, below.count); ++i) {
          const kernels::Box part = boxAt(below, i);
          for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], part.min[axis]);
            box.max[axis] = std::max(box.max[axis], part.max[axis]);
          }
        }
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[axis * stride + number] = box.min[axis];
        to[(axis + 3) * stride + number] = box.max[axis];
      }
    }
    kernels::Tier& tier = tiers_[static_cast<std::size_t>(tier_count_++)];
    tier.bounds = to;
    tier.stride = stride;
    tier.count = static_cast<std::uint32_t>(boxes);
    to += 6 * stride;
    if (boxes <= kernels::Tier::kFan) return;
  }
}

}  // namespace hgrid
