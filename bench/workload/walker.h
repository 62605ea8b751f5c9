// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {

/// The space [m] in which a walker may be. Walkers turn back at the border. So after 1,500 frames, the world is still
/// as dense as in the beginning.
struct Region {
  Eigen::Vector3f low, high;
};

/// A point that moves at random. In each frame it moves by 1 to 5 % of its size, in a direction that it keeps for some
/// frames.
class Walker {
 public:
  static constexpr std::uint64_t kLeg = 20;  ///< frames between two changes of direction

  /// @param number  number of the walker. Together with the frame number, it determines every step, so that worlds
  ///                repeat exactly.
  /// @param at      [m] position in frame 0
  /// @param size    [m] the length of a step is 1 to 5 % of it
  Walker(std::uint64_t number, const Eigen::Vector3f& at, float size, const Region& region)
      : at_(at), size_(size), region_(&region), number_(number) {
    turn(0);
  }

  void walk(std::uint64_t frame) {
    if ((frame + number_) % kLeg == 0) turn(frame);  // walkers turn in different frames
    at_ += step_;
    for (int axis = 0; axis < 3; ++axis) {
      if (at_[axis] >= region_->low[axis] && at_[axis] <= region_->high[axis]) continue;
      step_[axis] = -step_[axis];
      at_[axis] = std::clamp(at_[axis], region_->low[axis], region_->high[axis]);
    }
  }

  const Eigen::Vector3f& at() const { return at_; }

 private:
  void turn(std::uint64_t frame) {
    Random random(mixed(number_ + 1) ^ frame);
    Eigen::Vector3d direction;
    do {
      for (int axis = 0; axis < 3; ++axis) direction[axis] = random.uniform(-1.0, 1.0);
    } while (direction.squaredNorm() > 1.0 || direction.squaredNorm() < 0.01);
    step_ = (direction.normalized() * random.uniform(0.01, 0.05) * double(size_)).cast<float>();
  }

  Eigen::Vector3f at_, step_;
  float size_;
  const Region* region_;
  std::uint64_t number_;
};

}  // namespace bench
}  // namespace hgrid
