// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <vector>

#include "bench/measure/median.h"
#include "bench/states/fcl_states.h"
#include "bench/states/state_scene.h"

namespace hgrid {
namespace bench {

/// A robot in a world, prepared for hgrid and for FCL.
struct StateContest : StateScene {
  StateContest(const StateRobot& tested, const StateWorld& world);

  std::unique_ptr<FclStates> fcl;
};

/// Returns the map geb079, with a free place on its floor at the origin. nullopt: there is no such file, see
/// fileOfGeb079().
std::optional<StateWorld> buildingWorld();

/// Returns the processor time of this thread [us]. Other programs on a busy machine do not count.
double threadTime();

}  // namespace bench
}  // namespace hgrid
