// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "broadphase/hgrid/level_bounds.h"

#include "geometry/infinity.h"

namespace hgrid {
namespace {

constexpr kernels::Box kEmpty = {{kFloatInfinity, kFloatInfinity, kFloatInfinity},
                                 {-kFloatInfinity, -kFloatInfinity, -kFloatInfinity}};

std::size_t boxesAbove(std::size_t boxes) { return (boxes + kernels::Tier::kFan - 1) / kernels::Tier::kFan; }

}  // namespace

std::size_t LevelBounds::valuesFor(std::size_t levels) {
  std::size_t values = 0;
  for (std::size_t boxes = levels;; boxes = boxesAbove(boxes)) {
    values += 6 * (boxes + kReadBeyond);
    if (boxes <= kernels::Tier::kFan) return values;
  }
}

void LevelBounds::reserve(std::size_t levels) { bounds_.reserve(valuesFor(levels)); }

void LevelBounds::set(const std::vector<kernels::Level>& levels) {
  bounds_.assign(levels.empty() ? 0 : valuesFor(levels.size()), 0.0f);
  tier_count_ = 0;
  float* to = bounds_.data();
  for (std::size_t boxes = levels.size(); boxes > 0; boxes = boxesAbove(boxes)) {
    const std::size_t stride = boxes + kReadBeyond;
    for (std::size_t number = 0; number < boxes; ++number) {
      kernels::Box box = kEmpty;
      if (tier_count_ == 0) {
        box = levels[number].around;
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
