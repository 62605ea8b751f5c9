// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_start.h"

#include <algorithm>
#include <cmath>

#include "node/guard/path_deviation.h"

namespace hgrid {

void addStart(RobotPath& path, Time now, Time start, const LoadedRobot& robot, const std::vector<double>& present,
              const RobotPath* before) {
  if (path.times.front() <= now) return;
  start = std::min(start, path.times.front() - Time(1));
  std::vector<Time> times{now};
  if (before != nullptr) {
    for (const Time time : before->times) {
      if (time > now && time < start) times.push_back(time);
    }
  }
  if (start > now) times.push_back(start);

  const Kinematics& kinematics = *robot.read->joints->kinematics;
  const std::size_t width = path.joints.size();
  std::vector<double> rows(times.size() * width);
  for (std::size_t i = 0; i < width; ++i) {
    const auto index = static_cast<std::size_t>(kinematics.find(path.joints[i]));
    const JointVariable& variable = kinematics.variables()[index];
    const double first = path.positions[i];
    std::size_t column = before == nullptr ? 0 : before->joints.size();
    if (before != nullptr) {
      const auto found = std::find(before->joints.begin(), before->joints.end(), path.joints[i]);
      column = static_cast<std::size_t>(found - before->joints.begin());
    }
    const bool has_path = before != nullptr && column < before->joints.size();
    // A joint that turns freely goes the shorter way to the first point.
    const auto from = [&](Time time) { return has_path ? before->positionAt(column, time) : present[index]; };
    const double shift = nearestTo(first, from(start), variable) - from(start);
    for (std::size_t k = times.size() - 1; k > 0; --k) rows[k * width + i] = from(times[k]) + shift;
    rows[i] = nearestTo(times.size() > 1 ? rows[width + i] : first, present[index], variable);
  }
  path.positions.insert(path.positions.begin(), rows.begin(), rows.end());
  path.times.insert(path.times.begin(), times.begin(), times.end());
}

}  // namespace hgrid
