// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/robots/model_report.h"

#include "hgrid_proximity/bodies/name.h"
#include "node/robots/idle_patterns.h"

namespace hgrid {
namespace {

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Returns the names of all bodies except maps. Maps are left out because they are added and removed at run time.
std::vector<std::string> bodyNames(const RobotEntries& robots, const Params& params) {
  std::vector<std::string> names;
  for (const auto& robot : robots) {
    for (const Body& body : robot.second.model->bodies) names.push_back(body.name);
  }
  for (const ObstacleParams& obstacle : params.obstacles) names.push_back(obstacle.body.name);
  for (const CloudParams& cloud : params.clouds) names.push_back(joined("cloud", cloud.name));
  return names;
}

}  // namespace

void addToReport(const LoadedRobot& robot, ModelReport& report) {
  for (const Body& body : robot.bodies) {
    if (!body.covered) (body.waived ? report.waived : report.uncovered).push_back(body.name + ": " + body.note);
  }
  if (!robot.gap.empty()) report.uncovered.push_back(robot.gap);
  if (!robot.waived_gap.empty()) report.waived.push_back(robot.waived_gap);
  append(report.without_collision, robot.without_collision);
  append(report.uses_visual, robot.uses_visual);
  report.self_pairs.emplace_back(robot.name, robot.self_pairs);
  for (const std::string& warning : robot.warnings) report.warnings.push_back(robot.name + ": " + warning);
}

std::shared_ptr<const ModelReport> makeModelReport(const RobotEntries& robots, const Params& params) {
  auto report = std::make_shared<ModelReport>();
  bool all_loaded = true;
  for (const auto& [name, robot] : robots) {
    (robot.absent ? report->absent : report->expected).push_back(name);
    all_loaded = all_loaded && robot.model;
    if (!robot.inWorld()) continue;
    addToReport(*robot.model, *report);
    ++report->robots;
  }
  // The links of absent robots count as names, so that a pattern for them is not idle.
  if (all_loaded) {
    std::vector<std::string> without_collision;
    for (const auto& robot : robots) append(without_collision, robot.second.model->without_collision);
    append(report->warnings, idlePatterns(params, bodyNames(robots, params), without_collision));
    append(report->warnings, idleMargins(params));
  }
  return report;
}

}  // namespace hgrid
