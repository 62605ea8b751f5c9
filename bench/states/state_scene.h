// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bench/states/state_robots.h"
#include "bench/workload/random.h"
#include "hgrid_proximity/geometry/oriented_box.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "hgrid_proximity/world/scene.h"

namespace hgrid {
namespace bench {

/// A robot among boxes, with a StateChecker for them.
struct StateScene {
  /// @param boxes  fixed in the world; the root link is at the origin of the world
  StateScene(const StateRobot& tested, const std::vector<OrientedBox>& boxes);
  /// Returns random values of the group within the limits, state after state.
  std::vector<double> randomStates(Random& random, std::size_t count) const;

  StateRobot robot;
  Kinematics kinematics;
  std::vector<std::string> warnings;
  std::shared_ptr<const LinkMatrix> matrix;
  std::shared_ptr<NarrowPhase> narrow_phase;
  std::unique_ptr<StateChecker> checker;
  StateBatch batch;  ///< without positions
  StateScratch scratch;
  StateAnswers answers;

 private:
  void addRobot(Scene& scene);
};

/// Adds boxes that are fixed in the world as obstacles.
void addBoxes(Scene& scene, const std::vector<OrientedBox>& boxes, NarrowPhase& narrow_phase);

/// Returns boxes at random poses. The same count gives the same boxes. Their sides are 0.03 to 0.10 m for up to 100
/// boxes, and 0.02 to 0.03 m for more.
std::vector<OrientedBox> randomBoxes(std::size_t count);

}  // namespace bench
}  // namespace hgrid
