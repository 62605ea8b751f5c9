// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/states/state_robots.h"
#include "bench/workload/random.h"
#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/geometry/oriented_box.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "hgrid_proximity/world/scene.h"

namespace hgrid {
namespace bench {

/// The surroundings of a robot. The root link is at the origin of the world.
struct StateWorld {
  std::vector<OrientedBox> boxes;  ///< fixed in the world
  std::optional<Octomap> map;      ///< has further boxes, its occupied leaves
  Pose world_from_map = Pose::Identity();

  /// Returns all boxes, those of the map as well.
  std::vector<OrientedBox> allBoxes() const;
};

/// Returns boxes at random places, see randomBoxes().
StateWorld randomWorld(std::size_t boxes);

/// A robot in a world, with a StateChecker for it.
struct StateScene {
  StateScene(const StateRobot& tested, const StateWorld& world);
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
  void addMap(Scene& scene, const StateWorld& world);
};

/// Adds boxes that are fixed in the world as obstacles.
void addBoxes(Scene& scene, const std::vector<OrientedBox>& boxes, NarrowPhase& narrow_phase);

/// Returns boxes at random poses. The same count gives the same boxes. Their sides are 0.03 to 0.10 m for up to 100
/// boxes, and 0.02 to 0.03 m for more.
std::vector<OrientedBox> randomBoxes(std::size_t count);

}  // namespace bench
}  // namespace hgrid
