// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/states/state_contest.h"

#include <time.h>

namespace hgrid {
namespace bench {

StateContest::StateContest(const StateRobot& tested, std::size_t boxes) : StateScene(tested, randomBoxes(boxes)) {
  fcl = std::make_unique<FclStates>(robot, *matrix, randomBoxes(boxes), batch.others);
}

double threadTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * double(now.tv_sec) + 1e-3 * double(now.tv_nsec);
}

}  // namespace bench
}  // namespace hgrid
