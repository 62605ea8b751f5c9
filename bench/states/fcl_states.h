// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <vector>

#include "bench/states/state_robots.h"
#include "hgrid_proximity/geometry/oriented_box.h"

namespace hgrid {
namespace bench {

/// Checks states in the way of MoveIt: one at a time. FCL's trees find the shapes of the robot that are near each other
/// or near the world. A callback asks the allowed matrix, then FCL tests the exact shapes. The first contact ends the
/// check.
///
/// Only the links that the group moves are placed again for each state. FCL's meshes are surfaces, so a shape inside a
/// mesh is no contact.
class FclStates {
 public:
  /// @param rest  values of all variables, for those that are not in the group
  FclStates(const StateRobot& robot, const LinkMatrix& matrix, const std::vector<OrientedBox>& boxes,
            const std::vector<double>& rest);
  ~FclStates();

  /// Returns whether the robot touches itself or a box. @param state  values of the variables of the group
  bool isInContact(const double* state);
  /// Returns the number of exact tests of pairs of shapes so far.
  std::size_t exactTests() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bench
}  // namespace hgrid
