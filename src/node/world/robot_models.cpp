// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/robot_models.h"

#include <utility>

namespace hgrid {

RobotModels::RobotModels(const Params& params, const StoredRobots& stored)
    : params_(&params), content_(std::make_shared<Content>()) {
  RobotEntries robots = configured();
  for (const auto& [name, robot] : stored) {
    if (!robot) {
      robots.erase(name);
      continue;
    }
    robots[name].spec = std::make_shared<const RobotSpec>(robot->spec);
    robots[name].absent = robot->absent;
  }
  set(std::move(robots));
}

void RobotModels::set(RobotEntries robots) {
  auto content = std::make_shared<Content>();
  content->report = makeModelReport(robots, *params_);
  content->robots = std::move(robots);
  content->revision = content_->revision + 1;
  content_ = std::move(content);
}

RobotEntries RobotModels::configured() const {
  RobotEntries robots;
  for (const RobotParams& params : params_->robots) {
    RobotSpec spec;
    spec.params = params;
    const RobotEntry* known = entry(params.name);
    RobotEntry& robot = robots[params.name];
    if (known != nullptr && isSame(*known->spec, spec)) robot = *known;
    if (!robot.spec) robot.spec = std::make_shared<const RobotSpec>(std::move(spec));
    robot.absent = false;
  }
  return robots;
}

const RobotEntry* RobotModels::entry(const std::string& name) const {
  const auto known = all().find(name);
  return known == all().end() ? nullptr : &known->second;
}

bool RobotModels::expects(const std::string& name) const {
  const RobotEntry* robot = entry(name);
  return robot != nullptr && !robot->absent;
}

const LoadedRobot* RobotModels::find(const std::string& name) const {
  const RobotEntry* robot = entry(name);
  return robot != nullptr && robot->inWorld() ? robot->model.get() : nullptr;
}

std::string RobotModels::firstRoot() const {
  if (params_->robots.empty()) return {};
  const RobotEntry* first = entry(params_->robots.front().name);
  return first == nullptr || !first->model ? std::string() : first->model->root_frame;
}

}  // namespace hgrid
