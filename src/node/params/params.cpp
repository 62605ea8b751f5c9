// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/params.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <stdexcept>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/params/obstacle_params.h"
#include "node/params/param_table.h"
#include "node/params/param_value.h"
#include "node/params/param_words.h"
#include "node/params/room_overlaps.h"
#include "node/params/room_params.h"
#include "node/params/tracker_params.h"
#include "node/text/frame_names.h"

namespace hgrid {
namespace {

constexpr const char* kReserved[] = {"obstacle", "map", "cloud", "track"};  // other sources have these names

/// Parameters that are limits. Earlier versions read them without `limits/`.
constexpr const char* kNowLimits[] = {"allow_flat",
                                      "event_queue",
                                      "history_bytes",
                                      "lease_max",
                                      "max_batch",
                                      "max_bodies",
                                      "max_events",
                                      "max_description_bytes",
                                      "max_description_depth",
                                      "max_frames",
                                      "max_future",
                                      "max_hits",
                                      "max_links",
                                      "max_listed",
                                      "max_maps",
                                      "max_mesh_bytes",
                                      "max_pairs",
                                      "max_mesh_triangles",
                                      "max_planes",
                                      "max_robots",
                                      "max_rules",
                                      "max_samples",
                                      "max_size",
                                      "max_sync_wait",
                                      "mesh_memory",
                                      "mesh_timeout",
                                      "min_size",
                                      "tf_cache",
                                      "tf_queue_bytes",
                                      "track_queue_bytes",
                                      "world_limit"};

/// Other names that earlier versions read, and what takes their place.
struct FormerName {
  const char *name, *now;
};
constexpr FormerName kFormerNames[] = {
    {"guard/budget", "is now ~limits/guard_budget"},
    {"map/max_bytes", "is now ~limits/max_map_bytes"},
    {"map/max_leaves", "is now ~limits/max_map_leaves"},
    {"map/max_shown", "is now ~limits/max_shown_cells"},
    {"moveit/queue_bytes", "is now ~limits/moveit_queue_bytes"},
    {"clock_jump", "is gone: ROS time has jumped if it gains more than 10 s on real time within one tick"},
    {"finest_edge", "is gone: the node chooses the cells of the grid"},
    {"max_reasons", "is gone: messages list at most 8 reasons"},
};

/// A visitor that fills Params with the values from the parameter server.
class Reader {
 public:
  explicit Reader(ParamValue& root, const Params& params) : root_(root), params_(params) {}

  void section(const char*) {}
  void changeable() {}
  void string(const char* name, std::string& value, const char*) {
    if (auto given = get(name)) given->string(value);
  }
  void vector(const char* name, Eigen::Vector3d& value, const char*, double limit, const char*) {
    if (auto given = get(name)) given->vector(value, limit);
  }
  void number(const char* name, double& value, const char* unit, double low, double high, const char*) {
    if (auto given = get(name)) given->number(value, low, high, unit);
  }
  void integer(const char* name, int& value, int low, int high, const char*) {
    if (auto given = get(name)) given->integer(value, low, high);
  }
  void flag(const char* name, bool& value, const char*) {
    if (auto given = get(name)) given->flag(value);
  }
  void unknownSpace(const char* name, UnknownSpace& value, const char*) {
    if (auto given = get(name)) readWord(*given, kUnknownSpace, "ignore, report or occupied", value);
  }
  void broadPhase(const char* name, BroadPhaseType& value, const char*) {
    auto given = get(name);
    if (!given) return;
    std::string word = hgrid::name(value);
    given->string(word);
    if (find(word, value)) return;
    std::string known;
    for (const BroadPhaseType type : broadPhaseTypes())
      known += (known.empty() ? "" : ", ") + std::string(hgrid::name(type));
    given->error("is '" + printable(word, 48) + "'; it must be one of " + known);
  }
  void strings(const char* name, std::vector<std::string>& value, const char*) {
    if (auto given = get(name)) given->strings(value);
  }
  void robots(const char* name, std::vector<RobotParams>& value, const char*) {
    std::set<std::string> names;
    forEach(name, "field of a robot (name, description, semantic, tf_prefix, joint_states)", [&](ParamValue& element) {
      RobotParams robot;
      robot.semantic.clear();  // the default parameter may belong to another robot
      readString(element, "description", robot.description, true);
      readString(element, "semantic", robot.semantic, false);
      readString(element, "tf_prefix", robot.tf_prefix, false);
      readString(element, "joint_states", robot.joint_states, false);
      if (!robot.joint_states.empty()) checkTopic(element, robot.joint_states);
      if (auto given = element.require("name")) {
        given->string(robot.name);
        try {
          checkSource(robot.name, "it");
        } catch (const Refusal& refusal) {
          given->error(std::string("is not a valid name: ") + refusal.what());
        }
        if (isReservedName(robot.name)) {
          given->error("is '" + robot.name + "'; obstacle, map, cloud and track are reserved");
        }
        if (!names.insert(robot.name).second)
          given->error("is '" + printable(robot.name) + "', which is already used; names must differ");
      }
      value.push_back(robot);
    });
  }
  void waivers(const char* name, std::vector<Waiver>& value, const char*) {
    forEach(name, "field of a waiver (pattern, reason)", [&](ParamValue& element) {
      value.emplace_back();
      readString(element, "pattern", value.back().pattern, true);
      readString(element, "reason", value.back().reason, true);
    });
  }
  void allowed(const char* name, std::vector<PairRule>& value, const char*) {
    if (auto given = get(name)) value = readRules(*given);
  }
  void pairMargins(const char* name, std::vector<PairMargin>& value, double low, double high, const char*) {
    forEach(name, "field of this entry", [&](ParamValue& element) {
      value.emplace_back();
      readString(element, "first", value.back().first, true);
      readString(element, "second", value.back().second, true);
      if (auto number = element.require("margin")) number->number(value.back().margin, low, high, "m");
    });
  }
  void values(const char* name, std::vector<PatternValue>& value, const char* key, const char* unit, double low,
              double high, const char*) {
    forEach(name, "field of this entry", [&](ParamValue& element) {
      value.emplace_back();
      readString(element, "pattern", value.back().pattern, true);
      if (auto number = element.require(key)) number->number(value.back().value, low, high, unit);
    });
  }
  void kinds(const char* name, PairKinds& value, const char*) {
    auto given = get(name);
    if (!given) return;
    std::vector<std::string> names;
    given->strings(names);
    bool* const flags[] = {&value.self, &value.robot_robot, &value.robot_obstacle, &value.robot_map,
                           &value.moving_obstacle};
    for (bool* flag : flags) *flag = false;
    for (const std::string& kind : names) {
      bool known = false;
      for (std::size_t i = 0; i < 5; ++i) {
        if (kind == kKinds[i]) *flags[i] = known = true;
      }
      if (!known) {
        given->error("contains '" + printable(kind, 48) +
                     "'; allowed kinds are self, robot_robot, robot_obstacle, robot_map, moving_obstacle");
      }
    }
  }
  void rooms(const char* name, std::vector<Room>& value, const char*) {
    if (auto given = get(name)) value = readRooms(*given);
  }
  void doors(const char* name, std::vector<Portal>& value, const char*) {
    if (auto given = get(name)) value = readDoors(*given, params_.rooms);  // the table has rooms before doors
  }
  void obstacles(const char* name, std::vector<ObstacleParams>& value, const char*) {
    obstacles_ = get(name);  // finish() reads them, because the limits of sizes are parameters, too
    obstacles_target_ = &value;
  }
  void maps(const char* name, std::vector<MapParams>& value, const char*) {
    std::set<std::string> names;
    forEach(name, "field of a map (name, file, topic, frame, pose, max_age)", [&](ParamValue& element) {
      MapParams map;
      readString(element, "file", map.file, false);
      readString(element, "topic", map.topic, false);
      if (!map.file.empty() && !map.topic.empty())
        element.error("has a file and a topic; it must have only one of them");
      if (map.file.empty() && map.topic.empty()) map.topic = "octomap_binary";
      if (map.file.empty()) checkTopic(element, map.topic);
      readString(element, "frame", map.frame, false);
      map.frame = withoutSlash(map.frame);
      if (auto pose = element.get("pose")) map.frame_from_map = readPose(*pose);
      if (auto given = element.get("max_age")) given->number(map.max_age, 0.0, 86400.0, "s");
      if (map.max_age > 0.0 && !map.file.empty()) {
        element.error("has max_age " + text(map.max_age) + " s and a file; only a map from a topic may have max_age");
      }
      readLocalName(element, map.name, names);
      value.push_back(map);
    });
  }
  void clouds(const char* name, std::vector<CloudParams>& value, const char*) {
    std::set<std::string> names;
    forEach(name,
            "field of a cloud (name, topic, resolution, lifetime, empty, min_points, range, min_range, blind_range)",
            [&](ParamValue& element) {
              CloudParams cloud;
              readString(element, "topic", cloud.topic, false);
              checkTopic(element, cloud.topic);
              if (auto given = element.get("resolution")) given->number(cloud.resolution, 0.001, 100.0, "m");
              if (auto given = element.get("lifetime")) given->number(cloud.lifetime, 0.01, 3600.0, "s");
              if (auto given = element.get("empty")) readWord(*given, kEmptyCloud, "unknown or clear", cloud.empty);
              if (auto given = element.get("min_points")) given->integer(cloud.min_points, 1, 100000000);
              if (auto given = element.get("range")) given->number(cloud.range, 0.0, 1e6, "m");
              if (auto given = element.get("min_range")) given->number(cloud.min_range, 0.0, 1e3, "m");
              if (auto given = element.get("blind_range")) given->number(cloud.blind_range, 0.0, 1e3, "m");
              readLocalName(element, cloud.name, names);
              value.push_back(cloud);
            });
  }
  void pathTopics(const char* name, std::vector<PathTopicParams>& value, const char*) {
    forEach(name, "field of a topic with paths (topic, robot)", [&](ParamValue& element) {
      PathTopicParams topic;
      readString(element, "topic", topic.topic, true);
      checkTopic(element, topic.topic);
      readString(element, "robot", topic.robot, false);
      for (const PathTopicParams& other : value) {
        if (other.topic == topic.topic && other.robot == topic.robot) {
          element.error("has topic '" + printable(topic.topic) + "' and robot '" + printable(topic.robot) +
                        "', as another element; list each of them once");
        }
      }
      value.push_back(topic);
    });
  }
  void trackers(const char* name, std::vector<TrackerParams>& value, const char*) {
    trackers_ = get(name);  // finish() reads them, as obstacles
    trackers_target_ = &value;
  }
  void finish() {
    if (trackers_) *trackers_target_ = readTrackers(*trackers_, params_);
    if (obstacles_) *obstacles_target_ = readObstacles(*obstacles_, params_);
    for (const char* name : kNowLimits) refuseFormer(name, std::string("is now ~limits/") + name);
    for (const FormerName& former : kFormerNames) refuseFormer(former.name, former.now);
    for (auto& group : groups_) {
      if (group.second) group.second->finish("parameter of this node");
    }
  }

 private:
  void refuseFormer(const char* name, const std::string& now) {
    if (auto given = get(name)) given->error(now);
  }
  template <class Read>
  void forEach(const char* name, const char* noun, Read&& read) {
    auto given = get(name);
    if (!given) return;
    for (ParamValue& element : given->elements()) {
      if (!element.requireStruct()) continue;
      read(element);
      element.finish(noun);
    }
  }
  static void readString(ParamValue& element, const char* key, std::string& value, bool required) {
    if (auto given = required ? element.require(key) : element.get(key)) given->string(value);
  }

  /// Returns the value of a parameter. The name "group/key" means the member `key` of the struct `group`.
  std::optional<ParamValue> get(const std::string& name) {
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) return root_.get(name);
    const std::string group = name.substr(0, slash);
    auto known = groups_.find(group);
    if (known == groups_.end()) {
      known = groups_.emplace(group, root_.get(group)).first;
      if (known->second && !known->second->requireStruct()) known->second.reset();
    }
    return known->second ? known->second->get(name.substr(slash + 1)) : std::nullopt;
  }

  ParamValue& root_;
  const Params& params_;
  std::map<std::string, std::optional<ParamValue>> groups_;
  std::optional<ParamValue> obstacles_;
  std::vector<ObstacleParams>* obstacles_target_ = nullptr;
  std::optional<ParamValue> trackers_;
  std::vector<TrackerParams>* trackers_target_ = nullptr;
};

}  // namespace

bool isReservedName(const std::string& robot) {
  return std::find(std::begin(kReserved), std::end(kReserved), robot) != std::end(kReserved);
}

Params readParams(XmlRpc::XmlRpcValue values, std::vector<std::string>& errors) {
  Params params;
  ParamValue root(std::move(values), "~", errors);
  root.get("diagnostic_period");  // a parameter of diagnostic_updater
  Reader reader(root, params);
  visitParams(reader, params);
  reader.finish();
  if (params.robots.empty()) params.robots.push_back(RobotParams{});
  for (const RobotParams& robot : params.robots) {  // the descriptions may be in the private namespace of the node
    root.get(robot.description);
    root.get(robot.semantic);
  }
  root.finish("parameter of this node");
  if (errors.empty()) addOverlaps(params.rooms, params.doors, errors);

  const auto require = [&](bool holds, const std::string& sentence) {
    if (!holds) errors.push_back(sentence);
  };
  require(params.late_after <= params.stale_after && params.stale_after <= params.lost_after,
          "~late_after is " + text(params.late_after) + " s, ~stale_after is " + text(params.stale_after) +
              " s and ~lost_after is " + text(params.lost_after) + " s; none may be smaller than the one before it");
  const bool beats = params.follow_data && params.heartbeat < params.rate;  // ticks may be a period of it apart
  const double slowest = beats ? params.heartbeat : params.rate;
  require(params.valid_for * slowest >= 1.0, "~valid_for is " + text(params.valid_for) +
                                                 " s; it must be at least one period of " +
                                                 (beats ? "~heartbeat, " : "~rate, ") + text(1.0 / slowest) + " s");
  require(params.distances_max <= params.margin, "~distances/max is " + text(params.distances_max) +
                                                     " m; it must be at most ~margin, " + text(params.margin) + " m");
  for (int axis = 0; axis < 3; ++axis) {
    require(params.map_crop_min[axis] <= params.map_crop_max[axis],
            std::string("~map/crop_min is ") + text(params.map_crop_min[axis]) + " m along " + "xyz"[axis] +
                " and ~map/crop_max is " + text(params.map_crop_max[axis]) + " m; crop_min must be at most crop_max");
  }
  require(params.min_size < params.max_size, "~limits/min_size is " + text(params.min_size) +
                                                 " m; it must be below ~limits/max_size, " + text(params.max_size) +
                                                 " m");
  require(params.allowed_pairs.size() <= static_cast<std::size_t>(params.max_rules),
          "~allowed_pairs has " + std::to_string(params.allowed_pairs.size()) + " rules; at most ~limits/max_rules, " +
              std::to_string(params.max_rules) + ", are allowed");
  require(params.robots.size() <= static_cast<std::size_t>(params.max_robots),
          "~robots has " + std::to_string(params.robots.size()) + " robots; at most ~limits/max_robots, " +
              std::to_string(params.max_robots) + ", are allowed");
  require(params.maps.size() <= static_cast<std::size_t>(params.max_maps),
          "~maps has " + std::to_string(params.maps.size()) + " maps; at most ~limits/max_maps, " +
              std::to_string(params.max_maps) + ", are allowed");
  for (const PatternValue& padding : params.padding) {
    require(padding.pattern.rfind("map/", 0) != 0 && padding.pattern.rfind("cloud/", 0) != 0,
            "~padding has the pattern '" + printable(padding.pattern) +
                "'; cells of maps and clouds cannot be grown, use ~margins or ~map/self_filter");
  }
  params.world_frame = withoutSlash(params.world_frame);
  require(params.robots.size() < 2 || !params.world_frame.empty(),
          "~world_frame is empty; with several robots it must name a frame that tf connects to all of them");
  return params;
}

Params readParams(XmlRpc::XmlRpcValue values) {
  std::vector<std::string> errors;
  Params params = readParams(std::move(values), errors);
  if (errors.empty()) return params;
  std::string message =
      std::to_string(errors.size()) + (errors.size() == 1 ? " parameter is" : " parameters are") + " wrong:";
  for (const std::string& error : errors) message += "\n  " + error;
  throw std::invalid_argument(message);
}

}  // namespace hgrid
