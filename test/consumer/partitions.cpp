// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Uses the partitions without ROS: an empty scene with each kind of broad phase. Prints their names.
#include "hgrid_proximity/partitions/partitions.h"

#include <cstdio>

#include "hgrid_proximity/world/scene.h"

int main() {
  for (const hgrid::BroadPhaseType type : hgrid::broadPhaseTypes()) {
    hgrid::SceneOptions options;
    options.broad_phase = [type](double finest_edge, int threads) {
      return hgrid::makeBroadPhase({type, finest_edge, threads});
    };
    hgrid::Scene scene(options);
    if (scene.commit(hgrid::Time{1}, {})->broadPhase().size() != 0) return 1;
    std::printf("%s\n", name(type));
  }
  return 0;
}
