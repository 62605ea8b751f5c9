// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/params/params.h"

#include <ros/names.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/refusal.h"
#include "node/params/obstacle_params.h"
#include "node/params/param_value.h"
#include "node/tf/frame_names.h"

namespace hgrid {
namespace {

constexpr const char* kUnknownSpace[] = {"ignore", "report", "occupied"};
constexpr const char* kEmptyCloud[] = {"unknown", "clear"};
constexpr const char* kKinds[] = {"self", "robot_robot", "robot_obstacle", "robot_map", "moving_obstacle"};

/// Calls the visitor for every parameter with its name, value, unit, range and meaning. This is the only table of them.
template <class Visitor>
void visit(Visitor& v, Params& p) {
  v.section("The world");
  v.string(
      "world_frame", p.world_frame,
      "tf frame of all boxes and answers; empty: the root link of the robot; required if there are several robots");
  v.vector("origin", p.origin, "m", 1e6,
           "point of the world frame that boxes are stored relative to, as float32; choose a point near the robot if "
           "coordinates are large");
  v.number("rate", p.rate, "Hz", 1.0, 1000.0, "ticks per second");
  v.number("margin", p.margin, "m", 0.0, 1000.0, "bodies whose boxes are at most this far apart are pairs");
  v.number("finest_edge", p.finest_edge, "m", 0.0, 1000.0,
           "longest side of the boxes on the finest level of the grid, at least 0.001; 0: chosen from the bodies");

  v.section("Robots");
  v.robots("robots", p.robots,
           "list of {name, description, semantic, tf_prefix}. name: name of the robot, required. description: name of "
           "the parameter that holds the URDF, required. semantic: name of the parameter that holds the SRDF; empty: "
           "there is no SRDF. tf_prefix: prefix of the robot's tf frames. Empty list: one robot named 'robot', from "
           "robot_description and robot_description_semantic");
  v.waivers(
      "accept_uncovered", p.accept_uncovered,
      "list of {pattern, reason}: bodies that match the glob may have unreadable shapes, and the world is complete "
      "nevertheless. A robot without any collision geometry is accepted if all of its links match such globs");
  v.strings("use_visual", p.use_visual,
            "globs over body names: a link that matches and has no collision geometry uses its visual geometry");
  v.strings("mesh_roots", p.mesh_roots,
            "list of folders: file:// URIs of meshes may name files below these folders and below packages; package:// "
            "URIs are always allowed");

  v.section("Obstacles");
  v.obstacles("obstacles", p.obstacles,
              "list of {name, frame, pose: {xyz: [m], rpy: [rad]}, shapes: [{type, pose, ...}]}. Types and their sizes "
              "in m: box (size: [x, y, z]), sphere (radius), cylinder, cone, capsule (height, radius). frame: tf frame "
              "that the obstacle follows; empty: it is fixed in the world frame");

  v.section("Maps");
  v.maps("maps", p.maps,
         "list of {name, file or topic, frame, pose: {xyz: [m], rpy: [rad]}, max_age: [s]}: OctoMaps. Each is the body "
         "map/name. file: name of a .bt or .ot file in map/folder. topic: a topic of octomap_msgs/Octomap; "
         "octomap_binary if there is no file either. frame: tf frame that the map of a file follows; empty: it is "
         "fixed in the world frame. The map of a topic follows the frame of its messages. pose: pose of the map in its "
         "frame. max_age: the map of a topic is not complete while its newest message is older than this; 0: off");
  v.clouds("clouds", p.clouds,
           "list of {name, topic, resolution: [m], lifetime: [s], empty, min_points, range: [m]}: point clouds. Each "
           "is the body cloud/name. topic: a topic of sensor_msgs/PointCloud2, default cloud. resolution: edge of the "
           "cells that the points fill in the world frame, default 0.05. lifetime: how long a cell stays after the "
           "sensor last saw a point in it, default 1. The cloud is not complete if no newer message arrives within its "
           "lifetime. min_points: a message with fewer finite points counts as empty, default 1. empty: what an empty "
           "message means: unknown (it does not count as newer, default) or clear (nothing is there). range: the "
           "sensor sees no farther than this, default 0: no bound");
  v.string("map/folder", p.map_folder,
           "folder from which maps and ~load_octomap may read files; empty: no file is read");
  v.number("map/occupied_from", p.map_occupied_from, "", 0.001, 0.999,
           "cells with at least this probability are occupied; .bt files and octomap_binary messages contain no "
           "probabilities");
  v.flag("map/nan_is_occupied", p.map_nan_is_occupied,
         "true: a cell whose probability is NaN is occupied; false: a map with such a cell is refused");
  v.flag(
      "map/allow_empty", p.map_allow_empty,
      "true: a message or file without any node is an empty map, in which all space is unknown; false: it is refused");
  v.unknownSpace(
      "map/unknown", p.map_unknown,
      "how to treat space that a map has not observed: ignore (it counts as free), report (a query answers UNKNOWN "
      "instead of CLEAR if it passes through such space or if there is no map), occupied (it counts as occupied)");
  v.vector("map/crop_min", p.map_crop_min, "m", kNoCrop,
           "smallest corner, in the frame of the map, of the box that is read of each map; cells completely outside of "
           "the box are left out");
  v.vector("map/crop_max", p.map_crop_max, "m", kNoCrop,
           "largest corner, in the frame of the map, of the box that is read of each map");
  v.values("map/self_filter", p.map_self_filter, "padding", "m", 0.0, 10.0,
           "list of {pattern, padding}: globs over the names of links and of what robots carry. Cells that these "
           "bodies fill themselves are left out of maps and clouds: all finest cells whose centers are within padding "
           "of the padded shapes of the body, at its pose at the stamp of the map (of a file: when it is read). A "
           "padding of 0.87 cell edges leaves out all cells that touch the body. If several globs match, the last one "
           "counts. Empty list: no cells are left out");
  v.integer("map/max_bytes", p.map_max_bytes, 1000, 1 << 30,
            "largest size of a file or message of a map or cloud, in bytes");
  v.number("map/shown_within", p.map_shown_within, "m", 0.0, 1000.0,
           "~markers show the occupied cells that are within this distance of the box of a body; 0: none");
  v.integer("map/max_shown", p.map_max_shown, 1, 1000000, "largest number of cells that ~markers show");
  v.integer("map/max_leaves", p.map_max_leaves, 1, 100000000,
            "largest number of cells of a map or cloud: occupied cells and, if map/unknown is report, pieces of "
            "unknown space");

  v.strings("required", p.required,
            "globs over body names; while one of them matches no body, the world is not complete");

  v.section("Which pairs");
  v.kinds("pair_kinds", p.pair_kinds,
          "kinds of pairs that are reported: any of self, robot_robot, robot_obstacle, robot_map, moving_obstacle");
  v.allowed("allowed_pairs", p.allowed_pairs,
            "list of {first, second, reason}: globs over body names; pairs that match may touch and are not reported");
  v.values("margins", p.margins, "margin", "m", 0.0, 1000.0,
           "list of {pattern, margin}: margin of the bodies that match the glob. A pair has the larger margin of its "
           "two bodies. If several globs match, the last one counts");
  v.pairMargins("pair_margins", p.pair_margins, 0.0, 1000.0,
                "list of {first, second, margin}: globs over body names; pairs that match have this margin instead of "
                "those of their bodies, but at least ~margin. If several entries match, the last one counts");
  v.values("padding", p.padding, "padding", "m", 0.0, 1000.0,
           "list of {pattern, padding}: the shapes of bodies that match the glob are grown by this on all sides. If "
           "several globs match, the last one counts. Cells of maps and clouds are not grown");
  v.number("event_hysteresis", p.event_hysteresis, "m", 0.0, 1000.0,
           "~events reports the end of a pair when its gap exceeds its margin by more than this");

  v.section("Time");
  v.number("max_sync_wait", p.max_sync_wait, "s", 0.0, 10.0,
           "how far the time of a tick may stay behind the newest transform, to wait for frames that are slower");
  v.number("late_after", p.late_after, "s", 0.001, 3600.0,
           "a pose is LATE if it is older than this and older than 1.5 periods of its frame");
  v.number("stale_after", p.stale_after, "s", 0.001, 3600.0,
           "a pose is STALE if it is older than this and older than 1.5 periods of its frame; the margins of a body "
           "widen when its pose is older than this");
  v.number("lost_after", p.lost_after, "s", 0.001, 86400.0,
           "a pose is LOST if it is older than this; then the world is not complete");
  v.values("max_speed", p.max_speed, "speed", "m/s", 0.0, 1e6,
           "list of {pattern, speed}: upper bound of the speed of any point of a body that matches the glob. If "
           "several globs match, the last one counts");
  v.number("default_max_speed", p.default_max_speed, "m/s", 0.0, 1e6,
           "upper bound of the speed of bodies for which neither max_speed nor the joint velocity limits of the robot "
           "give one");
  v.number("horizon", p.horizon, "s", 0.0, 60.0,
           "bodies that can meet within this time, by their speed bounds, are pairs too, with the flag HORIZON. So are "
           "bodies that passed each other between two ticks. 0: off");
  v.number("growth_cap", p.growth_cap, "m", 0.0, 1000.0, "largest length by which the margins of a stale body widen");
  v.number("valid_for", p.valid_for, "s", 0.001, 3600.0,
           "the data of a tick is valid for this long after the tick was computed (valid_until in messages)");
  v.number("max_future", p.max_future, "s", 0.0, 3600.0,
           "a transform whose stamp is farther in the future than this is refused");
  v.number("tf_cache", p.tf_cache, "s", 1.0, 3600.0, "how long transforms are kept");
  v.number("clock_jump", p.clock_jump, "s", 0.1, 86400.0,
           "ROS time counts as having jumped if it advances by more than real time plus this within one tick");

  v.section("Exact distances");
  v.number("distances/max", p.distances_max, "m", 0.0, 1000.0,
           "~distances lists pairs whose shapes are at most this far apart; it must be at most ~margin, even if pairs "
           "have larger margins; 0: the value of ~margin");
  v.number("distances/budget", p.distances_budget, "s", 0.0, 10.0,
           "longest time per tick for measuring distances. Pairs that do not fit are not measured; these are the pairs "
           "with the largest gaps. ~events may use up to a fifth of this in addition. 0: no limit");
  v.integer("distances/threads", p.distances_threads, 1, 64, "number of threads that measure distances");

  v.section("Limits");
  v.number("world_limit", p.world_limit, "m", 1.0, 1e6, "poses with a coordinate beyond this are refused");
  v.number("min_size", p.min_size, "m", 1e-6, 1.0, "smallest radius, side or height of a shape");
  v.number("max_size", p.max_size, "m", 1.0, 1e5, "largest radius, side, height or vertex coordinate of a shape");
  v.flag("allow_flat", p.allow_flat, "true: a box may have one side of length 0");
  v.integer("threads", p.threads, 1, 64,
            "number of threads that the broad phase of a tick may use; more than 1 helps from some tens of thousands "
            "of shapes on");
  v.integer("max_bodies", p.max_bodies, 1, 1000000, "largest number of bodies");
  v.integer("max_frames", p.max_frames, 1, 1000000, "largest number of tf frames that are kept");
  v.integer("tf_queue_bytes", p.tf_queue_bytes, 1000, 1 << 30,
            "largest total size, in bytes, of the messages of /tf that wait for the tick thread, and again as much for "
            "/tf_static. A message counts as its own size plus 256 bytes plus the length of its publisher's name. When "
            "the limit is exceeded, the oldest messages are dropped (counter tf.dropped.LIMIT in ~status). A single "
            "message that is longer is refused");
  v.integer("max_pairs", p.max_pairs, 1, 10000000,
            "largest number of pairs that a tick lists; if there are more, the list is truncated and the world is not "
            "complete");
  v.integer("max_events", p.max_events, 1, 1000000,
            "largest number of events in one message of ~events; further events of a tick are in further messages");
  v.integer("event_queue", p.event_queue, 1, 100000,
            "number of messages of ~events that may wait for a slow subscriber; when the queue is full, the oldest "
            "message is dropped");
  v.integer("max_hits", p.max_hits, 1, 1000000,
            "largest number of hits in one answer; if there are more, the answer is truncated");
  v.integer("max_listed", p.max_listed, 1, 100000,
            "largest number of bodies, and of sources, that a message lists as not complete or not fresh");
  v.integer("max_reasons", p.max_reasons, 1, 1000,
            "largest number of reasons for an incomplete world that a message lists");
  v.integer("max_rules", p.max_rules, 1, 10000,
            "largest number of rules of the allowed-pair matrix, including those of allowed_pairs");
  v.integer("max_description_bytes", p.max_description_bytes, 1000, 256 << 20,
            "largest size of a URDF or SRDF, in bytes");
  v.integer("max_description_depth", p.max_description_depth, 8, 256, "deepest nesting of elements in a URDF or SRDF");
  v.integer("max_links", p.max_links, 1, 100000, "largest number of links of a robot");
  v.integer("max_mesh_bytes", p.max_mesh_bytes, 1000, 1 << 30, "largest size of a mesh file, in bytes");
  v.integer("max_mesh_triangles", p.max_mesh_triangles, 1, 100000000, "largest number of triangles of a mesh");
  v.integer("mesh_memory", p.mesh_memory, 64 << 20, 2147483647,
            "largest amount of memory for reading a mesh, in bytes; a mesh with nearly max_mesh_triangles needs more "
            "than the default");
  v.number("mesh_timeout", p.mesh_timeout, "s", 0.1, 600.0, "longest time for reading a mesh");

  v.section("The node");
  v.integer("query_threads", p.query_threads, 1, 64, "number of threads that answer queries");
  v.number("marker_rate", p.marker_rate, "Hz", 0.1, 100.0, "how often ~markers is published while it has subscribers");
}

/// A visitor that fills Params with the values from the parameter server.
class Reader {
 public:
  explicit Reader(ParamValue& root, const Params& params) : root_(root), params_(params) {}

  void section(const char*) {}
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
  void strings(const char* name, std::vector<std::string>& value, const char*) {
    if (auto given = get(name)) given->strings(value);
  }
  void robots(const char* name, std::vector<RobotParams>& value, const char*) {
    std::set<std::string> names;
    forEach(name, "field of a robot (name, description, semantic, tf_prefix)", [&](ParamValue& element) {
      RobotParams robot;
      robot.semantic.clear();  // the default parameter may belong to another robot
      readString(element, "description", robot.description, true);
      readString(element, "semantic", robot.semantic, false);
      readString(element, "tf_prefix", robot.tf_prefix, false);
      if (auto given = element.require("name")) {
        given->string(robot.name);
        try {
          checkSource(robot.name, "it");
        } catch (const Refusal& refusal) {
          given->error(std::string("is not a valid name: ") + refusal.what());
        }
        if (robot.name == "obstacle" || robot.name == "map" || robot.name == "cloud") {
          given->error("is '" + robot.name + "'; obstacle, map and cloud are reserved");
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
    forEach(name, "field of an allowed pair (first, second, reason)", [&](ParamValue& element) {
      value.emplace_back();
      readString(element, "first", value.back().first, true);
      readString(element, "second", value.back().second, true);
      readString(element, "reason", value.back().reason, false);
    });
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
  void obstacles(const char* name, std::vector<ObstacleParams>& value, const char*) {
    obstacles_ = get(name);  // finish() reads them, since the limits on sizes are parameters too
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
    forEach(name, "field of a cloud (name, topic, resolution, lifetime, empty, min_points, range)",
            [&](ParamValue& element) {
              CloudParams cloud;
              readString(element, "topic", cloud.topic, false);
              checkTopic(element, cloud.topic);
              if (auto given = element.get("resolution")) given->number(cloud.resolution, 0.001, 100.0, "m");
              if (auto given = element.get("lifetime")) given->number(cloud.lifetime, 0.01, 3600.0, "s");
              if (auto given = element.get("empty")) readWord(*given, kEmptyCloud, "unknown or clear", cloud.empty);
              if (auto given = element.get("min_points")) given->integer(cloud.min_points, 1, 100000000);
              if (auto given = element.get("range")) given->number(cloud.range, 0.0, 1e6, "m");
              readLocalName(element, cloud.name, names);
              value.push_back(cloud);
            });
  }
  void finish() {
    if (obstacles_) *obstacles_target_ = readObstacles(*obstacles_, params_.shapeLimits());
    for (auto& group : groups_) {
      if (group.second) group.second->finish("parameter of this node");
    }
  }

 private:
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

  /// Reads a word of the list `words`. Its position in the list is the value of the enum.
  template <std::size_t count, class Enum>
  static void readWord(ParamValue& given, const char* const (&words)[count], const char* rule, Enum& value) {
    std::string word = words[static_cast<std::size_t>(value)];
    given.string(word);
    const auto* const found = std::find(std::begin(words), std::end(words), word);
    if (found == std::end(words)) {
      given.error("is '" + printable(word, 48) + "'; it must be " + rule);
    } else {
      value = static_cast<Enum>(found - std::begin(words));
    }
  }

  static void checkTopic(const ParamValue& element, const std::string& topic) {
    std::string flaw = "it must not be empty";
    if (topic.empty() || !ros::names::validate(topic, flaw)) {
      element.error("has the topic '" + printable(topic) + "': " + flaw);
    }
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
};

/// A visitor that writes the text of config/params.yaml.
class Printer {
 public:
  void section(const char* title) {
    out_ << "\n# " << title << "\n";
    group_.clear();
  }
  void string(const char* name, const std::string& value, const char* meaning) {
    entry(name, meaning, "\"" + value + "\"");
  }
  void vector(const char* name, const Eigen::Vector3d& value, const char* unit, double limit, const char* meaning) {
    entry(name, std::string("[") + unit + "] " + meaning + "; each within " + text(-limit) + " .. " + text(limit),
          "[" + decimal(value[0]) + ", " + decimal(value[1]) + ", " + decimal(value[2]) + "]");
  }
  void number(const char* name, double value, const char* unit, double low, double high, const char* meaning) {
    entry(name, std::string("[") + unit + "] " + meaning + "; " + text(low) + " .. " + text(high), decimal(value));
  }
  void integer(const char* name, int value, int low, int high, const char* meaning) {
    entry(name, std::string(meaning) + "; " + std::to_string(low) + " .. " + std::to_string(high),
          std::to_string(value));
  }
  void flag(const char* name, bool value, const char* meaning) { entry(name, meaning, value ? "true" : "false"); }
  void kinds(const char* name, const PairKinds&, const char* meaning) {
    entry(name, meaning, "[self, robot_robot, robot_obstacle, robot_map, moving_obstacle]");
  }
  void unknownSpace(const char* name, UnknownSpace value, const char* meaning) {
    entry(name, meaning, kUnknownSpace[static_cast<std::size_t>(value)]);
  }
  void strings(const char* name, const std::vector<std::string>&, const char* meaning) { list(name, "", meaning); }
  void robots(const char* name, const std::vector<RobotParams>&, const char* meaning) { list(name, "", meaning); }
  void waivers(const char* name, const std::vector<Waiver>&, const char* meaning) { list(name, "", meaning); }
  void allowed(const char* name, const std::vector<PairRule>&, const char* meaning) { list(name, "", meaning); }
  void obstacles(const char* name, const std::vector<ObstacleParams>&, const char* meaning) { list(name, "", meaning); }
  void maps(const char* name, const std::vector<MapParams>&, const char* meaning) { list(name, "", meaning); }
  void clouds(const char* name, const std::vector<CloudParams>&, const char* meaning) { list(name, "", meaning); }
  void pairMargins(const char* name, const std::vector<PairMargin>&, double low, double high, const char* meaning) {
    list(name, "[m] ", std::string(meaning) + "; " + text(low) + " .. " + text(high));
  }
  void values(const char* name, const std::vector<PatternValue>&, const char*, const char* unit, double low,
              double high, const char* meaning) {
    list(name, std::string("[") + unit + "] ", std::string(meaning) + "; " + text(low) + " .. " + text(high));
  }
  std::string yaml() const { return out_.str(); }

 private:
  void list(const char* name, const std::string& unit, const std::string& meaning) {
    entry(name, unit + meaning, "[]");
  }
  void entry(const std::string& name, std::string meaning, const std::string& value) {
    const std::size_t slash = name.find('/');
    const std::string group = slash == std::string::npos ? "" : name.substr(0, slash);
    if (group != group_ && !group.empty()) out_ << group << ":\n";
    group_ = group;
    const std::string indent = group.empty() ? "" : "  ";
    while (!meaning.empty()) {  // wrap the lines
      std::size_t end = meaning.size();
      if (end > 110) end = meaning.rfind(' ', 110);
      out_ << indent << "# " << meaning.substr(0, end) << "\n";
      meaning.erase(0, end + 1);
    }
    out_ << indent << (group.empty() ? name : name.substr(slash + 1)) << ": " << value << "\n";
  }
  static std::string decimal(double value) {  // YAML 1.1 reads 1e+06 as a string
    std::string shown = text(value);
    const std::size_t exponent = shown.find('e');
    if (shown.find('.') == std::string::npos)
      shown.insert(exponent == std::string::npos ? shown.size() : exponent, ".0");
    return shown;
  }

  std::ostringstream out_;
  std::string group_;  // group of the last entry
};

}  // namespace

Params readParams(XmlRpc::XmlRpcValue values) {
  std::vector<std::string> errors;
  Params params;
  ParamValue root(std::move(values), "~", errors);
  root.get("diagnostic_period");  // a parameter of diagnostic_updater
  Reader reader(root, params);
  visit(reader, params);
  reader.finish();
  if (params.robots.empty()) params.robots.push_back(RobotParams{});
  for (const RobotParams& robot : params.robots) {  // the descriptions may be in the private namespace of the node
    root.get(robot.description);
    root.get(robot.semantic);
  }
  root.finish("parameter of this node");

  const auto require = [&](bool holds, const std::string& sentence) {
    if (!holds) errors.push_back(sentence);
  };
  require(params.late_after <= params.stale_after && params.stale_after <= params.lost_after,
          "~late_after is " + text(params.late_after) + " s, ~stale_after is " + text(params.stale_after) +
              " s and ~lost_after is " + text(params.lost_after) + " s; none may be smaller than the one before it");
  require(params.valid_for * params.rate >= 1.0, "~valid_for is " + text(params.valid_for) +
                                                     " s; it must be at least one period of ~rate, " +
                                                     text(1.0 / params.rate) + " s");
  require(params.distances_max <= params.margin, "~distances/max is " + text(params.distances_max) +
                                                     " m; it must be at most ~margin, " + text(params.margin) + " m");
  for (int axis = 0; axis < 3; ++axis) {
    require(params.map_crop_min[axis] <= params.map_crop_max[axis],
            std::string("~map/crop_min is ") + text(params.map_crop_min[axis]) + " m along " + "xyz"[axis] +
                " and ~map/crop_max is " + text(params.map_crop_max[axis]) + " m; crop_min must be at most crop_max");
  }
  require(params.min_size < params.max_size,
          "~min_size is " + text(params.min_size) + " m; it must be below ~max_size, " + text(params.max_size) + " m");
  require(params.finest_edge == 0.0 || params.finest_edge >= 1e-3,
          "~finest_edge is " + text(params.finest_edge) + " m; it must be 0 or at least 0.001 m");
  require(params.allowed_pairs.size() <= static_cast<std::size_t>(params.max_rules),
          "~allowed_pairs has " + std::to_string(params.allowed_pairs.size()) + " rules; at most ~max_rules, " +
              std::to_string(params.max_rules) + ", are allowed");
  for (const PatternValue& padding : params.padding) {
    require(padding.pattern.rfind("map/", 0) != 0 && padding.pattern.rfind("cloud/", 0) != 0,
            "~padding has the pattern '" + printable(padding.pattern) +
                "'; cells of maps and clouds cannot be grown, use ~margins or ~map/self_filter");
  }
  if (params.distances_max == 0.0) params.distances_max = params.margin;
  params.world_frame = withoutSlash(params.world_frame);
  require(params.robots.size() < 2 || !params.world_frame.empty(),
          "~world_frame is empty; with several robots it must name a frame that tf connects to all of them");
  if (errors.empty()) return params;
  std::string message =
      std::to_string(errors.size()) + (errors.size() == 1 ? " parameter is" : " parameters are") + " wrong:";
  for (const std::string& error : errors) message += "\n  " + error;
  throw std::invalid_argument(message);
}

std::string paramsAsYaml() {
  Params defaults;
  Printer printer;
  visit(printer, defaults);
  return "# All parameters of proximity_node with their default values. A description begins with the unit in "
         "brackets\n"
         "# and ends with the allowed range, both ends included. Load the values that you change into the private\n"
         "# namespace of the node. The node does not start if a name is unknown.\n" +
         printer.yaml();
}

}  // namespace hgrid
