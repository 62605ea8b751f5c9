// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_octomap.h"

#include <string>

#include "node/loading/missing_note.h"
#include "node/wire/from_messages.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

constexpr const char* kMapName = "planning_scene";

OctomapMessage messageOf(const moveit::OctomapWithPose& octomap) {
  OctomapMessage message;
  message.stamp = octomap.header.stamp;
  message.frame = octomap.header.frame_id;
  message.binary = octomap.binary != 0;
  message.id = octomap.id;
  message.resolution = octomap.resolution;
  message.data.assign(octomap.data.begin(), octomap.data.end());
  return message;
}

}  // namespace

LoadedMap SceneOctomap::read(const moveit::OctomapWithPose& octomap) const {
  MapParams map;
  map.name = kMapName;
  map.topic = "a planning scene";
  map.frame_from_map = fromPose(octomap.origin, "the origin of the octomap");
  return source_.finished(source_.read(map, messageOf(octomap)));
}

void SceneOctomap::take(const moveit::OctomapWithPose& octomap) {
  try {
    if (octomap.data.empty()) return jobs_.run([](World& world) { clear(world); });
    const LoadedMap loaded = read(octomap);
    jobs_.run([loaded](World& world) { world.setMap(loaded); });
  } catch (...) {
    refuse(caughtRefusal());
  }
}

void SceneOctomap::refuse(const Refusal& why) {
  noteMissing(jobs_, SourceId::ofMap(kMapName),
              std::string(name(why.code())) + " the octomap of a planning scene: " + why.what());
  ledger_.refuse("moveit.octomap_refused", why);
}

void SceneOctomap::clear(World& world) {
  try {
    world.clearMap(kMapName);
  } catch (const Refusal& refusal) {
    if (refusal.code() != Code::unknown_id) throw;  // there is no such map
  }
}

}  // namespace hgrid
