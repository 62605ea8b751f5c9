// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/obstacle_service.h"

#include <ros/time.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/pairs/pair_rule.h"
#include "node/messages/obstacle_messages.h"
#include "node/time/ros_time.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

/// Checks that the globs over what may touch attached obstacles match bodies of the world or of this request.
/// @throws Refusal limit (~limits/max_rules); ChangeRefusal unknown_id; not_ready
void checkTouch(const ObstacleChanges& changes, const AnswerTick& tick, const Params& params) {
  std::size_t count = 0;
  std::vector<std::string> added;
  for (const ObstacleChange& change : changes.changes) {
    if (change.attachment) count += change.attachment->touch.size();
    if (change.kind == ObstacleChange::Kind::add) added.push_back(change.name);
  }
  if (count > static_cast<std::size_t>(params.max_rules)) {
    throw Refusal(Code::limit, "the touch lists of the request have " + std::to_string(count) + " globs; at most " +
                                   std::to_string(params.max_rules) + " are allowed (~limits/max_rules)");
  }
  for (std::size_t i = 0; i < changes.changes.size(); ++i) {
    if (!changes.changes[i].attachment) continue;
    std::vector<PairRule> unknown;
    for (const std::string& glob : changes.changes[i].attachment->touch) {
      const auto is_meant = [&](const std::string& name) { return matches(glob, name); };
      if (std::none_of(added.begin(), added.end(), is_meant)) unknown.push_back(PairRule{glob, glob, ""});
    }
    if (unknown.empty()) continue;
    try {
      checkKnown(unknown, tick.snapshot().structure().bodies);
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(
          i, Refusal(refusal.code(), "touch of '" + printable(changes.changes[i].name) + "': " + refusal.what()));
    }
  }
}

}  // namespace

ObstacleService::ObstacleService(ServiceEnvelope& envelope, const Params& params,
                                 std::shared_ptr<NarrowPhase> narrow_phase, MeshPolicy meshes, PrepareObstacles prepare,
                                 ChangeWorld change_world, WaitUntilStored wait_until_stored)
    : params_(params),
      narrow_phase_(std::move(narrow_phase)),
      meshes_(std::move(meshes)),
      prepare_(std::move(prepare)),
      change_world_(std::move(change_world)),
      wait_until_stored_(std::move(wait_until_stored)) {
  server_ = envelope.serve<msg::ApplyObstacles>("apply_obstacles",
                                                [this](ServiceCall<msg::ApplyObstacles>& call) { apply(call); });
}

void ObstacleService::apply(ServiceCall<msg::ApplyObstacles>& call) const {
  try {
    MeshLoader files(meshes_);
    const auto changes = std::make_shared<const ObstacleChanges>(obstacleChangesOf(
        call.request, call.caller, params_, *narrow_phase_,
        [&](const std::string& uri, const Eigen::Vector3d& scale) { return files.load(uri, scale); }));
    checkTouch(*changes, call.tick, params_);
    const std::shared_ptr<PreparedObstacles> prepared = prepare_(*changes, nullptr);
    call.tick = AnswerTick(change_world_([changes, prepared](World& world) {
      world.applyObstacles(*changes, fromRos(ros::Time::now()), prepared.get());
    }));
    call.response.durable = wait_until_stored_();
  } catch (const ChangeRefusal& refusal) {
    call.response.failed_index = static_cast<std::uint32_t>(refusal.index());
    throw;
  }
}

}  // namespace hgrid
