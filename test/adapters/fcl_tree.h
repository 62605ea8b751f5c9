// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {
namespace test {

/// FCL's own way to find near pairs: a DynamicAABBTree of all shapes. A callback measures distances up to a limit.
class FclTree {
 public:
  FclTree();
  ~FclTree();

  void add(const Body& body);
  /// Moves the bodies. Then measures all pairs of different bodies that are not allowed pairs.
  /// @param world_from_bodies  poses of the bodies, in the order in which they were added
  /// @returns the number of measured pairs that are less than `bound` [m] apart
  std::size_t distances(const std::vector<Pose>& world_from_bodies, double bound,
                        const std::function<bool(std::size_t, std::size_t)>& allowed);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace test
}  // namespace hgrid
