// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/robot_path.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace hgrid {

double RobotPath::positionAt(std::size_t joint, Time time) const {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const auto at = [&](std::size_t point) { return positions[point * joints.size() + joint]; };
  if (after == times.begin()) return at(0);
  const auto next = static_cast<std::size_t>(after - times.begin());
  if (next == times.size()) return at(next - 1);
  const double share = static_cast<double>((time - times[next - 1]).count()) /
                       static_cast<double>((times[next] - times[next - 1]).count());
  return at(next - 1) + share * (at(next) - at(next - 1));
}

void checkPath(const RobotPath& path) {
  if (path.positions.size() != path.points() * path.joints.size() || path.points() == 0 || path.joints.empty()) {
    throw Refusal(Code::out_of_range, "the path has " + std::to_string(path.joints.size()) + " joints, " +
                                          std::to_string(path.points()) + " times and " +
                                          std::to_string(path.positions.size()) +
                                          " positions; it must have at least one joint and one time, and one "
                                          "position for each joint at each time");
  }
  std::set<std::string> names;
  for (const std::string& joint : path.joints) {
    if (names.insert(joint).second) continue;
    throw Refusal(Code::conflict, "the path names joint '" + printable(joint) + "' twice; name each joint once");
  }
  for (std::size_t i = 0; i < path.positions.size(); ++i) {
    if (std::isfinite(path.positions[i])) continue;
    throw Refusal(Code::nonfinite, "the position of joint '" + printable(path.joints[i % path.joints.size()]) +
                                       "' at point " + std::to_string(i / path.joints.size()) + " is " +
                                       text(path.positions[i]) + "; it must be finite");
  }
  for (std::size_t i = 1; i < path.points(); ++i) {
    if (path.times[i] > path.times[i - 1]) continue;
    throw Refusal(Code::out_of_range, "point " + std::to_string(i) + " is " +
                                          text(seconds(path.times[i] - path.times[i - 1])) +
                                          " s later than the point before it; this time must be greater than 0");
  }
}

RobotPath withoutJoints(const RobotPath& path, const std::vector<std::string>& joints) {
  RobotPath rest;
  rest.robot = path.robot;
  rest.doubt = path.doubt;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    if (std::count(joints.begin(), joints.end(), path.joints[i]) == 0) kept.push_back(i);
  }
  if (kept.empty()) return rest;
  rest.times = path.times;
  for (const std::size_t i : kept) rest.joints.push_back(path.joints[i]);
  for (std::size_t point = 0; point < path.points(); ++point) {
    for (const std::size_t i : kept) rest.positions.push_back(path.positions[point * path.joints.size() + i]);
  }
  return rest;
}

std::shared_ptr<const RobotPath> mergePaths(const RobotPaths& newest_first) {
  if (newest_first.size() == 1) return newest_first.front();
  const auto result = std::make_shared<RobotPath>();
  RobotPath& merged = *result;
  merged.robot = newest_first.front()->robot;
  std::vector<std::pair<const RobotPath*, std::size_t>> columns;  // a path and a joint of it, for each joint
  for (const auto& path : newest_first) {
    if (merged.doubt.empty()) merged.doubt = path->doubt;
    for (std::size_t i = 0; i < path->joints.size(); ++i) {
      if (std::count(merged.joints.begin(), merged.joints.end(), path->joints[i]) > 0) continue;
      merged.joints.push_back(path->joints[i]);
      columns.emplace_back(path.get(), i);
    }
    merged.times.insert(merged.times.end(), path->times.begin(), path->times.end());
  }
  std::sort(merged.times.begin(), merged.times.end());
  merged.times.erase(std::unique(merged.times.begin(), merged.times.end()), merged.times.end());
  for (const Time time : merged.times) {
    for (const auto& [path, joint] : columns) merged.positions.push_back(path->positionAt(joint, time));
  }
  return result;
}

}  // namespace hgrid
