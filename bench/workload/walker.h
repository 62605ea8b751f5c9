// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "bench/workload/random.h"

namespace hgrid {
namespace bench {

/// The space [m] in which a walker may be. Walkers turn back at its border. Therefore the world stays as dense as in
/// the beginning.
struct Region {
  Eigen::Vector3f low, high;
};

/// A point that moves at random. In each frame (time step) it moves by 1 to 5 % of `size`. It keeps its direction for
/// kLeg frames.
class Walker {
 public:
  static constexpr std::uint64_t kLeg = 20;  ///< number of frames between two changes of direction

  /// @param number  number of the walker. It determines every step together with the frame number. Thus two runs of a
  ///                 world are equal.
  /// @param at      [m] position in frame 0, before the first step
  /// @param size    [m] each step is 1 to 5 % of this length
  Walker(std::uint64_t number, const Eigen::Vector3f& at, float size, const Region& region)
      : at_(at), size_(size), region_(&region), number_(number) {
    turn(0);
  }

  void walk(std::uint64_t frame) {
    if ((frame + number_) % kLeg == 0) turn(frame);  // not all walkers turn in the same frame
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
