// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/tracker_params.h"

#include <set>
#include <string>

#include "hgrid_proximity/refusal.h"
#include "node/params/obstacle_params.h"
#include "node/params/param_table.h"
#include "node/params/param_words.h"

namespace hgrid {
namespace {

constexpr int kMostTracks = 1000;  // for each pose, the nearest track is sought among all tracks

TrackerParams readTracker(ParamValue& element, const Params& params, std::set<std::string>& names) {
  TrackerParams tracker;
  readLocalName(element, tracker.name, names);
  if (tracker.name.find('/') != std::string::npos) {
    element.error("has the name '" + printable(tracker.name) +
                  "'; the name of a tracker must not contain a slash, because its tracks are track/name/id");
  }
  if (auto topic = element.require("topic")) {
    topic->string(tracker.topic);
    checkTopic(element, tracker.topic);
  }
  if (auto type = element.require("type")) readWord(*type, kTrackerType, "markers or poses", tracker.type);
  if (auto given = element.get("namespaces")) {
    given->strings(tracker.namespaces);
    if (tracker.type == TrackerType::poses) given->error("is given, but only markers have namespaces; leave it out");
  }
  if (auto shapes = element.require("shapes")) readShapes(*shapes, params, tracker.shapes);
  if (auto given = element.get("upright")) given->flag(tracker.upright);
  if (auto given = element.get("max_speed")) given->number(tracker.max_speed, 0.0, 1e6, "m/s");
  if (auto given = element.get("margin")) given->number(tracker.margin, 0.0, 1e3, "m");
  if (auto given = element.get("noise")) given->number(tracker.noise, 0.0, 100.0, "m");
  if (auto given = element.get("forget")) given->number(tracker.forget, 0.1, 86400.0, "s");
  if (auto given = element.get("max_tracks")) given->integer(tracker.max_tracks, 1, kMostTracks);
  element.finish(
      "field of a tracker (name, topic, type, namespaces, shapes, upright, max_speed, margin, noise, forget, "
      "max_tracks)");
  return tracker;
}

}  // namespace

std::vector<TrackerParams> readTrackers(ParamValue value, const Params& params) {
  std::vector<TrackerParams> trackers;
  std::set<std::string> names;
  for (ParamValue& element : value.elements()) {
    if (element.requireStruct()) trackers.push_back(readTracker(element, params, names));
  }
  return trackers;
}

}  // namespace hgrid
