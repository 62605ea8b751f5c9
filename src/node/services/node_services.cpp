// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/node_services.h"

#include <string>

#include "node/params/mesh_policy.h"

namespace hgrid {

NodeServices::NodeServices(const ros::NodeHandle& quick_node, const ros::NodeHandle& query_node,
                           const ros::NodeHandle& batch_node, const ros::NodeHandle& admin_node, Commons& commons,
                           NewestTick newest, PrepareObstacles prepare_obstacles, ChangeWorld change_world,
                           const TransformLookup& transforms, const TickHistory& history, Loading& loading,
                           StateKeeper& state, Guard& guard, Stopwatch& stopwatch, QuerySketch& sketch)
    : quick_questions_(quick_node, newest, commons.ledger),
      questions_(query_node, newest, commons.ledger),
      batch_questions_(batch_node, newest, commons.ledger),
      changes_(admin_node, newest, commons.ledger),
      query_(quick_questions_, questions_, commons.settings.params, transforms, history, commons.narrow_phase, sketch),
      batches_(batch_questions_, commons.settings.params, transforms, history, leases_, commons.narrow_phase),
      fields_(batch_questions_, commons.settings.params, transforms, history, leases_, commons.narrow_phase),
      states_(batch_questions_, commons.settings.params, transforms, leases_, commons.narrow_phase),
      guard_(batch_questions_, guard),
      explain_(questions_, commons.settings.params, history, commons.narrow_phase),
      allowed_(changes_, commons.settings.params, change_world, [&state] { return state.waitUntilStored(); }),
      maps_(changes_, loading.mapSource(), change_world,
            [&loading, &state](const std::string& map, const std::optional<MapParams>& loaded) {
              loading.maps().forget(map);
              state.noteMap(map, loaded);
              return state.waitUntilStored();
            }),
      obstacles_(changes_, commons.settings.params, commons.narrow_phase,
                 meshPolicy(commons.settings.params, loading.isEnding()), prepare_obstacles, change_world,
                 [&state] { return state.waitUntilStored(); }),
      robots_(changes_, commons.settings.params, loading.robots(), change_world,
              [&state] { return state.waitUntilStored(); }),
      scenes_(changes_, commons.settings.params, commons.narrow_phase, prepare_obstacles, change_world,
              [&state] { return state.waitUntilStored(); }),
      reset_(
          changes_,
          [&loading, change_world](const std::function<void(World&)>& change) {
            return loading.robots().change(change_world, change, nullptr);
          },
          stopwatch),
      reload_(
          changes_, [&loading](const std::string& robot) { return loading.robots().reload(robot); }, change_world) {}

}  // namespace hgrid
