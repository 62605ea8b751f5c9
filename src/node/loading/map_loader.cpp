// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/loading/map_loader.h"

#include <boost/function.hpp>
#include <optional>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "node/health/guarded.h"
#include "node/loading/missing_note.h"

namespace hgrid {

MapLoader::MapLoader(ros::NodeHandle& node, const Params& params, const MapSource& source, const StoredMaps& stored,
                     TickJobs& jobs, Ledger& ledger)
    : source_(source), jobs_(jobs), ledger_(ledger) {
  for (const MapParams& map : params.maps) {
    if (!map.file.empty() && stored.count(map.name) == 0) files_.put(map.name, map);
    if (!map.topic.empty()) subscribe(node, map);
  }
  for (const auto& [name, map] : stored) {
    if (map) files_.put(name, *map);
  }
}

void MapLoader::subscribe(ros::NodeHandle& node, const MapParams& map) {
  const boost::function<void(const boost::shared_ptr<const OctomapMessage>&)> callback =
      [this, map](const boost::shared_ptr<const OctomapMessage>& message) {
        guarded(ledger_, "maps.failed", [&] { onMessage(map, *message); });
      };
  subscribers_.push_back(node.subscribe<OctomapMessage>(map.topic, 1, callback));
}

/// Puts the map of a message into the world. If this fails although the message could be read, stores the map for a
/// retry. It replaces an older stored map.
void MapLoader::onMessage(const MapParams& map, const OctomapMessage& message) {
  if (message.stamp.isZero()) ledger_.count("maps.unstamped");  // the map then ages from its arrival
  std::optional<ReadMap> read;
  const bool done = put(map, [&] {
    read = source_.read(map, message);
    return source_.finished(*read);
  });
  arrived_.remove(map.name);
  if (done) files_.remove(map.name);  // the message is newer
  if (read && !done) arrived_.put(map.name, std::move(*read));
}

void MapLoader::loadMissing() {
  files_.tryAll(
      [this](const MapParams& map) { return putGuarded(map, [&] { return source_.finished(source_.read(map)); }); });
  arrived_.tryAll([this](const ReadMap& map) { return putGuarded(map.params, [&] { return source_.finished(map); }); });
}

void MapLoader::forget(const std::string& map) {
  if (map.empty()) {
    files_.clear();
    arrived_.clear();
  } else {
    files_.remove(map);
    arrived_.remove(map);
  }
}

/// Puts the map that `load` returns into the world. If this fails, reports the failure. @returns whether it succeeded
bool MapLoader::put(const MapParams& map, const std::function<LoadedMap()>& load) {
  try {
    const LoadedMap loaded = load();
    jobs_.run([loaded](World& world) { world.setMap(loaded); });
    ledger_.count("maps.accepted");
    return true;
  } catch (...) {
    const Refusal why = caughtRefusal();
    noteMissing(jobs_, SourceId::ofMap(map.name),
                std::string(name(why.code())) + " map '" + map.name + "': " + why.what());
    grace_.refuse(ledger_, "maps.refused", why);
    return false;
  }
}

/// Calls put() and catches all exceptions, because the other maps must still be loaded.
bool MapLoader::putGuarded(const MapParams& map, const std::function<LoadedMap()>& load) {
  bool done = false;
  guarded(ledger_, "maps.failed", [&] { done = put(map, load); });
  return done;
}

}  // namespace hgrid
