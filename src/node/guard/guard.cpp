// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/guard.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "node/guard/conflicts_message.h"
#include "node/guard/guarded_joints.h"
#include "node/guard/path_deviation.h"
#include "node/guard/path_start.h"
#include "node/health/guarded.h"
#include "node/states/robot_choice.h"

namespace hgrid {
namespace {

// Largest turn [rad] and largest speed [rad/s] of a joint without limits between two points of a path.
constexpr double kLongestTurn = 1000.0, kFastestTurn = 1e5;

void checkJoints(const RobotPath& path, const Kinematics& kinematics) {
  const std::size_t count = path.joints.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int index = kinematics.find(path.joints[i]);
    if (index < 0) {
      throw Refusal(Code::unknown_id, "joint '" + printable(path.joints[i]) +
                                          "' of the path is not a joint value of robot '" + path.robot +
                                          "'; fixed joints and joints that mimic others have none");
    }
    if (!kinematics.variables()[static_cast<std::size_t>(index)].turnsFreely()) continue;
    for (std::size_t k = 1; k < path.points(); ++k) {
      const double turn = std::abs(path.positions[k * count + i] - path.positions[(k - 1) * count + i]);
      const double duration = seconds(path.times[k] - path.times[k - 1]);
      if (turn <= std::min(kLongestTurn, kFastestTurn * duration)) continue;
      throw Refusal(Code::out_of_range, "joint '" + printable(path.joints[i]) + "' turns by " + text(turn) +
                                            " rad in " + text(duration) + " s from point " + std::to_string(k - 1) +
                                            " to the next one; at most " + text(kLongestTurn) + " rad and " +
                                            text(kFastestTurn) + " rad/s are allowed");
    }
  }
}

}  // namespace

Guard::Guard(ros::NodeHandle private_node, Commons& commons, const TransformLookup& transforms,
             const JointStates& joint_states)
    : commons_(commons),
      transforms_(transforms),
      joint_states_(joint_states),
      publisher_(private_node.advertise<msg::Conflicts>("conflicts", 1, true)),
      thread_([this](const std::shared_ptr<const Tick>& tick) {
        guarded(commons_.ledger, "guard.check.failed", [&] { publish(*tick); });
      }) {}

std::shared_ptr<const RobotPath> Guard::follow(const PathSource& source, RobotPath path, Time start, const Tick& tick,
                                               GoalPhase phase) {
  return paths_.put(source, prepared(std::move(path), start, tick), tick, phase);
}

void Guard::begin(const PathSource& source, RobotPath path, Time start, const Tick& tick) {
  const auto waiting = paths_.waiting(source, path.robot);
  if (waiting != nullptr) paths_.replace(waiting, prepared(std::move(path), start, tick));
}

/// Checks a path and adds what the robot does before its first point. @throws Refusal as follow()
RobotPath Guard::prepared(RobotPath path, Time start, const Tick& tick) const {
  const int most = tick.settings->params.max_batch;
  if (path.points() > static_cast<std::size_t>(most)) {
    throw Refusal(Code::limit,
                  "the path has " + std::to_string(path.points()) + " points; at most " + std::to_string(most) +
                      " are allowed (~limits/max_batch). Send fewer points, or raise " + "~limits/max_batch");
  }
  const LoadedRobot& robot = robotNamed(path.robot, tick);
  for (std::string& joint : path.joints) joint = jointOf(joint, robot.name);
  checkPath(path);
  checkJoints(path, *robot.read->joints->kinematics);
  const Time now = tick.made.ros;
  if (path.times.back() < now) {
    throw Refusal(Code::out_of_range, "the path of robot '" + path.robot + "' ended " +
                                          secondsText(seconds(now - path.times.back())) +
                                          " before now; its last time must be later");
  }
  const std::shared_ptr<const RobotPath> before = paths_.of(robot.name);
  GuardedJoints present = guardedJoints(robot, tick, transforms_, joint_states_);
  // Where the turn of a joint is not known, the path is UNKNOWN. Any turn will do then.
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    const auto index = static_cast<std::size_t>(robot.read->joints->kinematics->find(path.joints[i]));
    if (!present.turn_hidden[index]) continue;
    present.values[index] = path.positions[i] - std::remainder(path.positions[i] - present.values[index], 2.0 * M_PI);
  }
  addStart(path, now, std::max(start, now), robot, present.values, before.get());
  return path;
}

void Guard::markUnreadable(const PathSource& source, const std::string& robot, const std::string& why, const Tick& tick,
                           GoalPhase phase) {
  RobotPath lost;
  lost.robot = robot;
  lost.doubt = why;
  paths_.put(source, std::move(lost), tick, phase);
}

PathAnswer Guard::check(const std::shared_ptr<const RobotPath>& path, const Tick& tick) {
  const RobotPaths paths = currentPaths(tick);
  const std::vector<PathAnswer> answers = check(paths, tick);
  const auto own = std::find_if(paths.begin(), paths.end(), [&](const auto& one) { return one->robot == path->robot; });
  if (own == paths.end() || !paths_.has(path)) {
    throw Refusal(Code::conflict, "the path of robot '" + path->robot +
                                      "' was replaced or removed before it was checked; send it again if the robot "
                                      "still follows it");
  }
  return answers[static_cast<std::size_t>(own - paths.begin())];
}

void Guard::see(const std::shared_ptr<const Tick>& tick) {
  if (!tick->snapshot || (paths_.empty() && !watched_)) return;
  if (thread_.give(tick)) commons_.ledger.count("guard.skipped");
}

/// Returns the paths that robots follow.
RobotPaths Guard::currentPaths(const Tick& tick) {
  return paths_.current(tick, [&](const RobotPath& path) -> std::optional<bool> {
    try {
      const LoadedRobot& robot = robotNamed(path.robot, tick);
      const GuardedJoints present = guardedJoints(robot, tick, transforms_, joint_states_);
      if (!present.doubt.empty() || !hiddenTurnOf(path, robot, present).empty()) return {};
      const double most = tick.settings->params.guard_deviation;
      return deviationOf(path, robot, present.values, tick.snapshot->stamp(), most).empty();
    } catch (const Refusal&) {
      return {};  // nobody knows where the robot is
    }
  });
}

std::vector<PathAnswer> Guard::check(const RobotPaths& paths, const Tick& tick) {
  const Params& params = tick.settings->params;
  const std::chrono::duration<double> budget(params.guard_budget);
  try {
    return checkPaths(
        paths, tick,
        {params.guard_ahead, params.guard_deviation,
         std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(budget)},
        transforms_, joint_states_, commons_.narrow_phase);
  } catch (...) {
    // The last message must not stand: it may say CLEAR.
    const Refusal why = commons_.ledger.fault("guard.check.failed");
    return std::vector<PathAnswer>(paths.size(), {Verdict::unknown, why.what(), 0.0, {}});
  }
}

void Guard::publish(const Tick& tick) {
  const RobotPaths paths = currentPaths(tick);
  if (paths.empty() && !watched_) return;
  watched_ = !paths.empty();
  const std::vector<PathAnswer> answers = check(paths, tick);
  std::map<Found, Time> since;
  std::vector<Time> found_at;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!answers[i].conflict) continue;
    const Found found{paths[i]->robot, answers[i].conflict->first, answers[i].conflict->second};
    const auto known = since_.find(found);
    found_at.push_back(known == since_.end() ? tick.made.ros : known->second);
    since[found] = found_at.back();
  }
  since_ = std::move(since);
  publisher_.publish(conflictsMessage(tick, paths, answers, found_at));
}

}  // namespace hgrid
