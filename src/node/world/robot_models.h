// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>
#include <utility>

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
  }
  /// Returns the model of a robot, or null if the robot is not in the world.
  const LoadedRobot* find(const std::string& name) const {
    const auto known = robots_.find(name);
    return known == robots_.end() ? nullptr : known->second.get();
  }
  /// Returns the report on what is missing in the models.
  const std::shared_ptr<const ModelReport>& report() const { return report_; }

  void swap(RobotModels& other) noexcept {
    robots_.swap(other.robots_);
    report_.swap(other.report_);
  }

 private:
  const Params& params_;
  RobotsByName robots_;
  std::shared_ptr<const ModelReport> report_ = std::make_shared<ModelReport>();
};

}  // namespace hgrid
