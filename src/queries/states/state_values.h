// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <optional>

#include "hgrid_proximity/queries/state_checker.h"
#include "queries/states/state_search.h"

namespace hgrid {

/// Reads the values of the joints from a batch of states. The variables that the batch does not have are the same in
/// all states; the constructor sets them.
class StateValues {
 public:
  /// Finds the columns of the variables. @throws Refusal as StateChecker::checkStates() says
  StateValues(const Kinematics& kinematics, const RobotShapes& robot, const StateBatch& batch, StateMemory& scratch);

  /// Returns the number of states in the batch, including an incomplete last state.
  std::size_t size() const { return sizeOf(kinematics_, batch_); }
  /// Returns the number of states in a batch, including an incomplete last state.
  static std::size_t sizeOf(const Kinematics& kinematics, const StateBatch& batch);
  /// Reads one state into a lane of the scratch memory. If the state is refused, the lane gets valid values.
  /// @param answer  receives `refused`, `detail` and `beyond_limits`
  void read(std::size_t state, std::size_t lane, StateAnswer& answer);
  /// Sets the variables that the batch does not have, if something else has changed them in this lane.
  void restoreOthers(std::size_t lane);
  /// Gives a lane valid values.
  void clear(std::size_t lane);

 private:
  bool isComplete(std::size_t state) const { return (state + 1) * width_ <= batch_.positions.size(); }
  void check(std::size_t lane, StateAnswer& answer) const;
  bool checkMimic(const JointMotion& joint, std::size_t lane, bool& beyond) const;
  void findMimics();
  void findChanges(const RobotShapes& robot);

  const Kinematics& kinematics_;
  const StateBatch& batch_;
  StateMemory& scratch_;
  const std::size_t width_;                   // number of values of one state
  bool others_beyond_ = false;                // whether a value that is the same in all states is beyond its limits
  std::optional<std::size_t> other_refused_;  // a variable outside the batch that another joint cannot mimic
};

/// Returns a sentence that says why a state was refused.
std::string refusalOf(const Kinematics& kinematics, const StateBatch& batch, std::size_t state,
                      const StateAnswer& answer);

}  // namespace hgrid
