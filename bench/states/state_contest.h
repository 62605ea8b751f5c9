// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/states/fcl_states.h"
#include "bench/states/state_robots.h"
#include "bench/workload/random.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "hgrid_proximity/world/scene.h"

namespace hgrid {
namespace bench {

/// A robot among boxes, prepared for both programs.
struct StateContest {
  StateContest(const StateRobot& tested, std::size_t boxes);
  /// Returns random values of the group within the limits, state after state.
  std::vector<double> randomStates(Random& random, std::size_t count) const;

  StateRobot robot;
  Kinematics kinematics;
  std::vector<std::string> warnings;
  std::shared_ptr<const LinkMatrix> matrix;
  std::shared_ptr<NarrowPhase> narrow_phase;
  std::unique_ptr<StateChecker> checker;
  std::unique_ptr<FclStates> fcl;
  StateBatch batch;  ///< without positions
  StateScratch scratch;
  StateAnswers answers;

 private:
  void addRobot(Scene& scene);
  void addBoxes(Scene& scene, const std::vector<OrientedBox>& boxes);
};

/// Returns the median of some values, at least one.
double medianOf(std::vector<double> values);

/// Returns the processor time of this thread [us]. Other programs on a busy machine do not count.
double threadTime();

}  // namespace bench
}  // namespace hgrid
