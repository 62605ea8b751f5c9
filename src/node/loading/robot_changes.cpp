// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/robot_changes.h"

#include "hgrid_proximity/refusal.h"
#include "node/sources/obstacle_change.h"
#include "node/world/robot_edits.h"

namespace hgrid {
namespace {

/// Prepares the changes of one request, one after the other.
class Preparation {
 public:
  Preparation(RobotEntries robots, const RobotSource& source, const Params& params)
      : robots_(std::move(robots)), source_(source), params_(params), reader_(source) {}

  void add(const RobotRequest& request) {
    RobotChange change;
    change.operation = request.operation;
    change.index = request.index;
    change.name = request.spec.params.name;
    if (request.operation == RobotOperation::add) {
      const RobotEntry* other = request.like.empty() ? nullptr : &templateOf(request);
      change.spec = specOf(request, other);
      if (!isNeeded(change.operation, change.name, change.spec.get(), robots_, params_)) return;
      change.model = other == nullptr ? loaded(*change.spec) : likeOther(*change.spec, *other);
    } else {
      if (!isNeeded(change.operation, change.name, nullptr, robots_, params_)) return;
      const RobotEntry& robot = robots_.at(change.name);
      if (change.operation == RobotOperation::declare_present && !robot.model) change.model = loadedIfPossible(robot);
    }
    edit(change, params_, robots_);
    prepared_.changes.push_back(std::move(change));
  }
  PreparedRobots result() && { return std::move(prepared_); }

 private:
  const RobotEntry& templateOf(const RobotRequest& request) const {
    const std::string sentence =
        "robot '" + request.spec.params.name + "' cannot be added like '" + printable(request.like) + "': ";
    const auto known = robots_.find(request.like);
    if (known == robots_.end()) throw Refusal(Code::unknown_id, sentence + "there is no such robot");
    if (!known->second.model)
      throw Refusal(Code::not_ready,
                    sentence + "that robot is not loaded yet; wait until it is, or give a description");
    if (!known->second.refused.empty()) {
      throw Refusal(Code::not_ready, sentence + "the newest description of that robot could not be used (" +
                                         known->second.refused + "); correct it first");
    }
    return known->second;
  }
  static std::shared_ptr<const RobotSpec> specOf(const RobotRequest& request, const RobotEntry* other) {
    auto spec = std::make_shared<RobotSpec>(request.spec);
    if (other == nullptr) return spec;
    spec->text = other->spec->text;
    spec->params.description = other->spec->params.description;
    spec->params.semantic = other->spec->params.semantic;
    return spec;
  }
  std::shared_ptr<const LoadedRobot> loaded(const RobotSpec& spec) {
    const RobotDescription description = source_.describe(spec);
    auto robot = std::make_shared<const LoadedRobot>(reader_.load(spec, description));
    prepared_.read[spec.params.name] = description.hash();
    prepared_.like.erase(spec.params.name);
    return robot;
  }
  std::shared_ptr<const LoadedRobot> loadedIfPossible(const RobotEntry& robot) {
    try {
      return loaded(*robot.spec);
    } catch (const Refusal&) {
      return nullptr;  // the robot is there, but not loaded, so the world is not complete; the loader tries again
    }
  }
  std::shared_ptr<const LoadedRobot> likeOther(const RobotSpec& spec, const RobotEntry& other) {
    const std::string& name = spec.params.name;
    if (!other.model->read || !source_.fits(*other.model->read, name)) return loaded(spec);
    prepared_.like[name] = other.spec->params.name;
    prepared_.read.erase(name);
    return std::make_shared<const LoadedRobot>(source_.make(spec, other.model->read));
  }

  RobotEntries robots_;  // as they will be after the changes so far
  const RobotSource& source_;
  const Params& params_;
  SharedReader reader_;
  PreparedRobots prepared_;
};

}  // namespace

LoadedRobot SharedReader::load(const RobotSpec& robot, const RobotDescription& description) {
  for (const auto& [text, read] : known_) {
    if (isSame(text, description) && source_.fits(*read, robot.params.name)) return source_.make(robot, read);
  }
  known_.emplace_back(description, source_.read(robot, description));
  return source_.make(robot, known_.back().second);
}

PreparedRobots prepare(const std::vector<RobotRequest>& requests, RobotEntries robots, const RobotSource& source,
                       const Params& params) {
  Preparation preparation(std::move(robots), source, params);
  for (const RobotRequest& request : requests) {
    try {
      preparation.add(request);
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(request.index, refusal);
    }
  }
  return std::move(preparation).result();
}

}  // namespace hgrid
