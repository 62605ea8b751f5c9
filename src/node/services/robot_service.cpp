// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/robot_service.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "node/messages/robot_messages.h"
#include "node/messages/to_messages.h"
#include "node/sources/obstacle_change.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

/// Returns a sentence for each obstacle that is attached to a robot that leaves.
std::vector<std::string> leftBehind(const RobotChanges& changes, const ObstacleBodies& obstacles) {
  std::set<std::string> left;
  for (const RobotChange& change : changes) {
    const bool leaves =
        change.operation == RobotOperation::remove || change.operation == RobotOperation::declare_absent;
    leaves ? (void)left.insert(change.name) : (void)left.erase(change.name);
  }
  std::vector<std::string> sentences;
  for (const auto& [name, obstacle] : obstacles.all()) {
    if (!obstacle.attachment) continue;
    const std::string& link = obstacle.attachment->link;
    if (left.count(link.substr(0, link.find('/'))) == 0) continue;
    sentences.push_back("'" + printable(name) + "' is attached to '" + printable(link) +
                        "' and stays in the world; it becomes LOST when tf stops moving it: remove it, or add it again "
                        "with replace where it is now");
  }
  return sentences;
}

/// Returns a sentence for each robot that came and has the same root frame as another robot in the world.
std::vector<std::string> sharedRoots(const std::set<std::string>& came, const RobotEntries& robots) {
  std::map<std::string, std::string> first;  // by root frame
  std::vector<std::string> sentences;
  for (const auto& [name, robot] : robots) {
    if (!robot.inWorld()) continue;
    const auto [known, is_new] = first.emplace(robot.model->root_frame, name);
    if (is_new || (came.count(name) == 0 && came.count(known->second) == 0)) continue;
    sentences.push_back("robots '" + known->second + "' and '" + name + "' have the same root frame '" +
                        printable(known->first) + "'; if they are different robots, give each its own tf_prefix");
  }
  return sentences;
}

}  // namespace

RobotService::RobotService(ServiceEnvelope& envelope, const Params& params, RobotLoader& loader,
                           ChangeWorld change_world, WaitUntilStored wait_until_stored)
    : params_(params),
      loader_(loader),
      change_world_(std::move(change_world)),
      wait_until_stored_(std::move(wait_until_stored)) {
  server_ =
      envelope.serve<msg::ApplyRobots>("apply_robots", [this](ServiceCall<msg::ApplyRobots>& call) { apply(call); });
}

void RobotService::apply(ServiceCall<msg::ApplyRobots>& call) const {
  try {
    const auto prepared =
        std::make_shared<const PreparedRobots>(loader_.prepare(robotRequestsOf(call.request, params_)));
    const std::shared_ptr<PreparedRobotBodies> bodies = loader_.prepareBodies(prepared->changes);
    const auto left_behind = std::make_shared<std::vector<std::string>>();
    call.tick = AnswerTick(loader_.change(
        change_world_,
        [prepared, bodies, left_behind](World& world) {
          *left_behind = leftBehind(prepared->changes, world.obstacles());
          world.applyRobots(prepared->changes, bodies.get());
        },
        prepared.get()));
    ModelReport report;
    std::set<std::string> came;
    for (const RobotChange& change : prepared->changes) {
      const RobotEntry* robot = loader_.robots().entry(change.name);
      if (robot == nullptr || !robot->inWorld() || !came.insert(change.name).second) continue;
      addToReport(*robot->model, report);
    }
    std::vector<std::string> warnings = std::move(*left_behind);
    for (const auto& more : {sharedRoots(came, loader_.robots().all()), report.warnings})
      warnings.insert(warnings.end(), more.begin(), more.end());
    const auto most = static_cast<std::size_t>(params_.max_listed);
    call.response.uncovered = shortened(report.uncovered, most);
    call.response.warnings = shortened(warnings, most);
    call.response.durable = wait_until_stored_();
  } catch (const ChangeRefusal& refusal) {
    call.response.failed_index = static_cast<std::uint32_t>(refusal.index());
    throw;
  }
}

}  // namespace hgrid
