// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/marker_scale.h"

#include <algorithm>
#include <cmath>

namespace hgrid {

MarkerScale scaleOf(const Tick& tick) {
  constexpr double kLeastDiagonal = 0.1;  // [m]
  constexpr double kStepsOfDiagonal = 8.0, kTextOfStep = 1.0 / 5.0;
  Eigen::AlignedBox3d around;
  if (tick.snapshot) {
    const Snapshot& snapshot = *tick.snapshot;
    const Structure& structure = snapshot.structure();
    for (ProxyId proxy = 0; proxy < snapshot.boxes().size(); ++proxy) {
      if (snapshot.poses()[structure.body_of_proxy[proxy]].state == Freshness::unplaced) continue;
      if (!structure.isPlane(proxy)) around.extend(inDouble(snapshot.boxes()[proxy]));
    }
    if (!around.isEmpty()) around.translate(snapshot.origin());
  }
  if (around.isEmpty()) around = {Eigen::Vector3d(-0.5, -0.5, 0.0), Eigen::Vector3d(0.5, 0.5, 1.0)};
  int power = 0;
  std::frexp(std::max(around.diagonal().norm(), kLeastDiagonal), &power);  // the diagonal is less than 2^power
  const double step = std::ldexp(1.0 / kStepsOfDiagonal, power);
  const Eigen::Array3d low = (around.min().array() / step).floor() * step,
                       high = (around.max().array() / step).ceil() * step;
  return {{low.matrix(), high.matrix()}, kTextOfStep * step};
}

}  // namespace hgrid
