// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_deviation.h"

#include <cmath>

namespace hgrid {

double nearestTo(double expected, double present, const JointVariable& variable) {
  if (!variable.turnsFreely()) return present;
  return expected - std::remainder(expected - present, 2.0 * M_PI);
}

std::string deviationOf(const RobotPath& path, const LoadedRobot& robot, const std::vector<double>& present, Time time,
                        double most) {
  const Kinematics& kinematics = *robot.read->joints->kinematics;
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    const int index = kinematics.find(path.joints[i]);
    if (index < 0) {
      throw Refusal(Code::unknown_id,
                    "the path of robot '" + robot.name + "' names joint '" + printable(path.joints[i]) +
                        "', which the robot does not have since it was loaded again; send a new path");
    }
    const JointVariable& variable = kinematics.variables()[static_cast<std::size_t>(index)];
    const double expected = path.positionAt(i, time);
    const double is_at = nearestTo(expected, present[static_cast<std::size_t>(index)], variable);
    if (std::abs(is_at - expected) <= most) continue;
    const std::string unit = variable.is_angle ? " rad" : " m";
    return "joint '" + printable(path.joints[i]) + "' of robot '" + robot.name + "' is at " + text(is_at) + unit +
           ", but its path says " + text(expected) + unit + "; they may differ by at most " + text(most) + unit +
           " (~guard/deviation)";
  }
  return {};
}

}  // namespace hgrid
