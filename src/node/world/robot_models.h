// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "node/params/params.h"
#include "node/robots/model_report.h"
#include "node/robots/robot_entry.h"
#include "node/robots/robot_source.h"
#include "node/robots/robot_spec.h"

namespace hgrid {

/// Stores which robots the world should have, and their models.
///
/// A copy is cheap and does not throw, and any thread may read it. To make a change, modify a copy and then swap() it
/// with the original.
class RobotModels {
 public:
  /// At first, no robot is loaded.
  /// @param params  must outlive this object and its copies
  /// @param stored  what an earlier run of the node changed
  explicit RobotModels(const Params& params, const StoredRobots& stored = {});

  /// Replaces all robots.
  void set(RobotEntries robots);
  /// Returns all robots, by name, also those that are absent or not loaded.
  const RobotEntries& all() const { return content_->robots; }
  /// As all(). The result does not change when this object changes.
  std::shared_ptr<const RobotEntries> shared() const { return {content_, &content_->robots}; }
  /// Returns the robots as ~robots lists them. Models that are known stay.
  RobotEntries configured() const;

  /// Returns the entry of a robot; null if there is no such robot.
  const RobotEntry* entry(const std::string& name) const;
  /// Returns whether the world should have a robot of this name.
  bool expects(const std::string& name) const;
  /// Returns the model of a robot, or null if the robot is not in the world.
  const LoadedRobot* find(const std::string& name) const;
  /// Returns the root frame of the first robot of ~robots; empty: it is not loaded.
  std::string firstRoot() const;
  /// Returns the report on what is missing in the models.
  const std::shared_ptr<const ModelReport>& report() const { return content_->report; }

  /// Returns a number that increases with each change.
  std::uint64_t revision() const { return content_->revision; }

  void swap(RobotModels& other) noexcept { content_.swap(other.content_); }

 private:
  struct Content {
    RobotEntries robots;
    std::shared_ptr<const ModelReport> report = std::make_shared<ModelReport>();
    std::uint64_t revision = 0;
  };

  const Params* params_;
  std::shared_ptr<const Content> content_;
};

}  // namespace hgrid
