// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_services.h"

#include <ros/time.h>

#include <boost/function.hpp>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "node/health/guarded.h"
#include "node/moveit/scene_message.h"
#include "node/moveit/scene_reply.h"
#include "node/time/ros_time.h"
#include "node/wire/checked.h"
#include "node/world/world.h"

namespace hgrid {

SceneServices::SceneServices(ros::NodeHandle node, Commons& commons, SceneOctomap& octomap, SceneGaps& gaps,
                             NewestTick newest, PrepareObstacles prepare, ChangeWorld change_world)
    : commons_(commons),
      reader_(commons.settings.params, *commons.narrow_phase),
      octomap_(octomap),
      gaps_(gaps),
      newest_(std::move(newest)),
      prepare_(std::move(prepare)),
      change_world_(std::move(change_world)) {
  serve<moveit::GetPlanningScene>(node, "get_planning_scene", "moveit.get_failed", &SceneServices::get);
  serve<moveit::ApplyPlanningScene>(node, "apply_planning_scene", "moveit.apply_failed", &SceneServices::apply);
}

/// Advertises a service. If the work throws, the call fails.
template <class Service>
void SceneServices::serve(ros::NodeHandle& node, const char* name, const char* failed,
                          void (SceneServices::*work)(const typename Service::Request&, typename Service::Response&)) {
  using Event = ros::ServiceEvent<Checked<typename Service::Request>, typename Service::Response>;
  const boost::function<bool(Event&)> callback = [this, failed, work](Event& event) {
    return !guarded(commons_.ledger, failed, [&] { (this->*work)(event.getRequest().value(), event.getResponse()); });
  };
  servers_.push_back(node.advertiseService<Event>(name, callback));
}

void SceneServices::get(const moveit::GetPlanningScene::Request& request,
                        moveit::GetPlanningScene::Response& response) {
  struct Present {
    std::shared_ptr<const PlacedObstacles> obstacles;
    std::vector<MatrixRule> matrix;
  };
  const auto present = std::make_shared<Present>();
  const auto tick = change_world_([present](World& world) {
    present->obstacles = world.obstacles().share();
    present->matrix = world.matrix();
  });
  response.scene = planningScene(request.components, *tick, *present->obstacles, present->matrix);
}

void SceneServices::apply(const moveit::ApplyPlanningScene::Request& request,
                          moveit::ApplyPlanningScene::Response& response) {
  try {
    const auto read = std::make_shared<ReadScene>(request.scene, reader_);
    if (read->refused()) throw *read->refused();
    std::shared_ptr<const LoadedMap> map;
    if (!request.scene.octomap.data.empty()) {
      map = std::make_shared<const LoadedMap>(octomap_.read(request.scene.octomap));
    }
    const std::shared_ptr<PreparedObstacles> prepared = read->prepare(prepare_, newest_().get());
    change_world_([read, map, prepared, &gaps = gaps_](World& world) {
      read->applyTo(world, fromRos(ros::Time::now()), prepared.get());
      if (!read->applied()) throw *read->refused();
      read->noteIn(gaps);
      showGaps(gaps, world);
      if (map) world.setMap(*map);
      if (!map && read->octomap()) SceneOctomap::clear(world);
    });
    for (const char* part : read->unused()) commons_.ledger.count(std::string("moveit.unused.") + part);
    response.success = 1;
  } catch (const Refusal& refusal) {
    commons_.ledger.refuse("moveit.apply_refused", refusal);
  }
}

}  // namespace hgrid
