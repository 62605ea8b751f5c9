// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/states/state_contest.h"

#include <time.h>

#include "bench/maps/map.h"
#include "bench/maps/map_peer.h"

namespace hgrid {
namespace bench {

StateContest::StateContest(const StateRobot& tested, const StateWorld& world) : StateScene(tested, world) {
  fcl = std::make_unique<FclStates>(robot, *matrix, world.allBoxes(), batch.others);
}

std::optional<StateWorld> buildingWorld() {
  const std::string file = fileOfGeb079();
  if (file.empty()) return std::nullopt;
  return StateWorld{{}, readMap(file), Pose(Eigen::Translation3d(0.0, 2.0, -0.1))};
}

double threadTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * double(now.tv_sec) + 1e-3 * double(now.tv_nsec);
}

}  // namespace bench
}  // namespace hgrid
