// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_check.h"

#include <algorithm>

#include "hgrid_proximity/queries/state_checker.h"
#include "node/guard/edge_walk.h"
#include "node/guard/joined_paths.h"

namespace hgrid {
namespace {

StateChecker checkerOf(const std::vector<std::string>& robots, const JoinedPaths& joined, const Tick& tick,
                       const std::shared_ptr<const NarrowPhase>& narrow_phase) {
  StateCheckerOptions options;
  options.world_frame = tick.world_frame;
  options.robots = robots;
  return StateChecker(tick.snapshot, joined.kinematics(), "", narrow_phase, options);
}

/// Returns the number of the path of a robot.
std::size_t indexOf(const std::string& robot, const RobotPaths& paths) {
  const auto found = std::find_if(paths.begin(), paths.end(), [&](const auto& path) { return path->robot == robot; });
  return static_cast<std::size_t>(found - paths.begin());
}

/// If there is a doubt, sets free_for to 0, and makes the verdict unknown unless a conflict was found.
PathAnswer doubted(PathAnswer answer, const std::string& doubt) {
  if (doubt.empty()) return answer;
  answer.free_for = 0.0;
  if (answer.conflict) return answer;
  answer.verdict = Verdict::unknown;
  answer.reason = doubt;
  return answer;
}

}  // namespace

std::vector<PathAnswer> checkPaths(const RobotPaths& paths, const Tick& tick, const PathLimits& limits,
                                   const TransformLookup& transforms, const JointStates& joint_states,
                                   const std::shared_ptr<const NarrowPhase>& narrow_phase) {
  const JoinedPaths joined(paths, tick, limits.deviation, transforms, joint_states);
  const std::string& doubt = joined.doubt();
  std::vector<PathAnswer> answers(paths.size(), {Verdict::unknown, doubt, 0.0, {}});
  const Time now = tick.made.ros;
  std::vector<Time> times;
  StateBatch batch;
  if (joined.robots().empty()) return answers;
  try {
    batch =
        joined.states(now, now + std::chrono::duration_cast<Time>(std::chrono::duration<double>(limits.ahead)), times);
  } catch (const Refusal& refusal) {
    return std::vector<PathAnswer>(paths.size(), {Verdict::unknown, refusal.what(), 0.0, {}});
  }
  if (batch.joints.empty()) return answers;  // no path could be read

  EdgeWalk walk(batch, times, limits.deadline);
  const auto is_late = [&] { return std::chrono::steady_clock::now() > limits.deadline; };
  // What is clear for several robots together is clear for each of them. So only robots with a conflict, and those for
  // which a part is unknown, are checked alone.
  std::vector<std::string> rest = joined.robots();
  std::size_t first = 0;  // all edges before this one are clear for the robots in `rest`
  const auto answer = [&](const std::string& robot) {
    PathAnswer answer = walk.clearUntil(first);
    if (first + 1 < times.size() && is_late()) {
      answer.verdict = Verdict::unknown;
      answer.reason = "the time of one check (~limits/guard_budget) has passed";
    } else if (first + 1 < times.size()) {
      walk.extend(answer, checkerOf({robot}, joined, tick, narrow_phase), first);
    }
    answers[indexOf(robot, paths)] = doubted(answer, doubt);
  };
  while (rest.size() > 1 && !is_late()) {
    const std::string robot = walk.advance(checkerOf(rest, joined, tick, narrow_phase), first);
    const auto found = std::find(rest.begin(), rest.end(), robot);
    if (found == rest.end()) break;
    answer(robot);
    rest.erase(found);
  }
  for (const std::string& robot : rest) answer(robot);
  return answers;
}

}  // namespace hgrid
