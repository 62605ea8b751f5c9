// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "node/world/model_report.h"

namespace hgrid {

/// Stores the models of the robots in the world.
///
/// Copies are cheap. To make a change, modify a copy and then swap() it with the original.
class RobotModels {
 public:
  explicit RobotModels(const Params& params) : params_(params) {}

  /// Replaces the model of the robot of the same name, if there is one.
  void set(std::shared_ptr<const LoadedRobot> robot) {
    const std::string name = robot->name;
    robots_.insert_or_assign(name, std::move(robot));
    report_ = makeModelReport(robots_, params_);
    ++revision_;
  }
  /// Returns the model of a robot, or null if the robot is not in the world.
  const LoadedRobot* find(const std::string& name) const {
    const auto known = robots_.find(name);
    return known == robots_.end() ? nullptr : known->second.get();
  }
  /// Returns the model of the robot that has a link of this name, "robot/link"; null if no robot in the world has it.
  const LoadedRobot* findLink(const std::string& link) const {
    const LoadedRobot* robot = find(link.substr(0, link.find('/')));
    return robot != nullptr && robot->links.count(link) != 0 ? robot : nullptr;
  }
  /// Returns the full names, "robot/link", of the links of all robots that have this name without the robot.
  std::vector<std::string> linksNamed(const std::string& name) const {
    std::vector<std::string> links;
    for (const auto& robot : robots_) {
      if (robot.second->links.count(robot.first + "/" + name) != 0) links.push_back(robot.first + "/" + name);
    }
    return links;
  }
  /// Returns all models, by the name of the robot.
  const RobotsByName& all() const { return robots_; }
  /// Returns the report on what is missing in the models.
  const std::shared_ptr<const ModelReport>& report() const { return report_; }

  /// Returns a number that increases with each change.
  std::uint64_t revision() const { return revision_; }

  void swap(RobotModels& other) noexcept {
    robots_.swap(other.robots_);
    report_.swap(other.report_);
    std::swap(revision_, other.revision_);
  }

 private:
  const Params& params_;
  RobotsByName robots_;
  std::uint64_t revision_ = 0;
  std::shared_ptr<const ModelReport> report_ = std::make_shared<ModelReport>();
};

}  // namespace hgrid
