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

/// Shows every parameter to a visitor: name, value, unit and range, meaning. The one list of all of them.
template <class Visitor>
void visit(Visitor& v, Params& p) {
  v.section("The world");
  v.string("world_frame", p.world_frame,
           "tf frame of every box and every answer; empty: the root link of the robot (required with several robots)");
  v.vector("origin", p.origin, "m", 1e6,
           "point of the world frame that boxes are stored relative to (as float32): near the robot where coordinates "
           "are large");
  v.number("rate", p.rate, "Hz", 1.0, 1000.0, "ticks per second");
  v.number("margin", p.margin, "m", 0.0, 1000.0, "bodies whose boxes are this near or nearer are pairs");
  v.number("finest_edge", p.finest_edge, "m", 0.0, 1000.0,
           "longest side of the boxes on the grid's finest level, at least 0.001; 0: chosen from the bodies");

  v.section("Robots");
  v.robots("robots", p.robots,
           "list of {name, description, semantic, tf_prefix}: description and semantic name the parameters with URDF "
           "and SRDF; name and description are required, without semantic there is no SRDF; "
           "empty list: one robot named 'robot' from robot_description and robot_description_semantic");
  v.waivers("accept_uncovered", p.accept_uncovered,
            "list of {pattern, reason}: bodies with unreadable shapes that do not make the world incomplete; a robot "
            "without any collision geometry does not either if patterns match every one of its links");
  v.strings("use_visual", p.use_visual,
            "globs over body names: a link that matches and has no collision geometry uses its visual geometry");
  v.strings("mesh_roots", p.mesh_roots,
            "folders below which meshes may be read by file://; package:// is always allowed");

  v.section("Obstacles");
  v.obstacles(
      "obstacles", p.obstacles,
      "list of {name, frame, pose: {xyz: [m], rpy: [rad]}, shapes: [{type, pose, ...}]}; types: box (size: [x, y, z]), "
      "sphere (radius), cylinder, cone, capsule (height, radius) [m]; frame empty: the world frame, and the obstacle "
      "is fixed");

  v.section("Maps");
  v.maps(
      "maps", p.maps,
      "list of {name, file or topic, frame, pose: {xyz: [m], rpy: [rad]}}: OctoMaps, each the body map/name; file: the "
      "name of a .bt or .ot in map/folder; topic: of octomap_msgs/Octomap, whose frame is the map's, if neither is "
      "given "
      "octomap_binary; frame of a file, empty: the world frame, and the map is fixed; max_age [s] of a topic: without "
      "a message for longer the map is not complete, 0: off");
  v.clouds("clouds", p.clouds,
           "list of {name, topic, resolution: [m], lifetime: [s], empty, min_points, range: [m]}: "
           "sensor_msgs/PointCloud2, each the body cloud/name; its points fill cells of that edge in the world frame, "
           "which go a lifetime after they were seen last; without a newer message by then the cloud is not complete; "
           "a message with fewer than min_points finite points does not count as newer (empty: unknown) or says that "
           "nothing is there (empty: clear); range: the sensor sees no farther, 0: no bound; defaults: topic cloud, "
           "resolution 0.05, lifetime 1, empty unknown, min_points 1, range 0");
  v.string("map/folder", p.map_folder, "folder whose files maps and ~load_octomap may name; empty: none is read");
  v.number("map/occupied_from", p.map_occupied_from, "", 0.001, 0.999,
           "cells of at least this probability are occupied; only .ot files have probabilities");
  v.flag("map/nan_is_occupied", p.map_nan_is_occupied,
         "a cell whose probability is no number is occupied; false: such a file is refused");
  v.flag("map/allow_empty", p.map_allow_empty,
         "a message or file without any node is an empty map, all of it unknown; false: it is refused");
  v.unknownSpace("map/unknown", p.map_unknown,
                 "what space means that a map has no leaf for: ignore (it is free), report (a CLEAR that passes "
                 "through it becomes UNKNOWN; so does one where there is no map at all), occupied");
  v.vector(
      "map/crop_min", p.map_crop_min, "m", kNoCrop,
      "least corner, in the map's frame, of what is read of every map; cells that lie wholly outside are left out");
  v.vector("map/crop_max", p.map_crop_max, "m", kNoCrop, "its greatest corner");
  v.values("map/self_filter", p.map_self_filter, "padding", "m", 0.0, 10.0,
           "list of {pattern, padding}: robots' links, or what they carry, whose own cells are left out of maps and "
           "clouds: finest cells whose middles are as near as that to the body's padded shapes where it was at the "
           "stamp of the map (of a file: when it is taken in), so that 0.87 of a cell's edge takes all that touch; the "
           "last match counts; empty: none is");
  v.integer("map/max_bytes", p.map_max_bytes, 1000, 1 << 30, "bytes of a file or message, of clouds too");
  v.number("map/shown_within", p.map_shown_within, "m", 0.0, 1000.0,
           "~markers show occupied cells so near to a body's box; 0: none");
  v.integer("map/max_shown", p.map_max_shown, 1, 1000000, "cells that ~markers show");
  v.integer("map/max_leaves", p.map_max_leaves, 1, 100000000,
            "cells of a map or cloud: occupied ones, and with report the pieces of unknown space");

  v.strings("required", p.required,
            "globs over body names; while one of them matches no body, the world is not complete");

  v.section("Which pairs");
  v.kinds("pair_kinds", p.pair_kinds,
          "kinds of pair that are reported: self, robot_robot, robot_obstacle, robot_map, moving_obstacle");
  v.allowed("allowed_pairs", p.allowed_pairs,
            "list of {first, second, reason}: globs over body names; pairs that match may touch and are not reported");
  v.values(
      "margins", p.margins, "margin", "m", 0.0, 1000.0,
      "list of {pattern, margin}: bodies with a margin of their own; a pair has the larger one; the last match counts");
  v.pairMargins("pair_margins", p.pair_margins, 0.0, 1000.0,
                "list of {first, second, margin}: globs over body names; pairs that match have this margin instead, at "
                "least ~margin; the last match counts");
  v.values(
      "padding", p.padding, "padding", "m", 0.0, 1000.0,
      "list of {pattern, padding}: bodies whose shapes are grown on all sides; the last match counts; cells of maps "
      "and clouds are not grown");
  v.number("event_hysteresis", p.event_hysteresis, "m", 0.0, 1000.0,
           "~events tells the end of a pair when its gap exceeds its margin by more than this");

  v.section("Time");
  v.number("max_sync_wait", p.max_sync_wait, "s", 0.0, 10.0,
           "most that the time of a tick stays behind the newest transform to wait for slower ones");
  v.number("late_after", p.late_after, "s", 0.001, 3600.0,
           "a pose older than this, and than 1.5 of its periods, is LATE");
  v.number(
      "stale_after", p.stale_after, "s", 0.001, 3600.0,
      "a pose older than this, and than 1.5 of its periods, is STALE; the margins of a body with an older pose widen");
  v.number("lost_after", p.lost_after, "s", 0.001, 86400.0, "a pose older than this is LOST: the world is incomplete");
  v.values("max_speed", p.max_speed, "speed", "m/s", 0.0, 1e6,
           "list of {pattern, speed}: bound of the speed of any point of these bodies; the last match counts");
  v.number("default_max_speed", p.default_max_speed, "m/s", 0.0, 1e6,
           "speed bound where neither max_speed nor the robot's joint velocity limits give one");
  v.number(
      "horizon", p.horizon, "s", 0.0, 60.0,
      "pairs that can meet within this time, by their speed bounds, are pairs too, flagged, as are those that passed "
      "each other between two ticks; 0: neither");
  v.number("growth_cap", p.growth_cap, "m", 0.0, 1000.0, "most that the margins of a stale body widen");
  v.number("valid_for", p.valid_for, "s", 0.001, 3600.0, "valid_until of every message is this long after it was made");
  v.number("max_future", p.max_future, "s", 0.0, 3600.0, "transforms stamped farther in the future are refused");
  v.number("tf_cache", p.tf_cache, "s", 1.0, 3600.0, "how long transforms are kept");
  v.number("clock_jump", p.clock_jump, "s", 0.1, 86400.0, "a ROS clock that runs ahead by more in one tick has jumped");

  v.section("Exact distances");
  v.number("distances/max", p.distances_max, "m", 0.0, 1000.0,
           "pairs whose shapes are this near or nearer stand in ~distances; at most ~margin, also for "
           "pairs whose own margin is larger; 0: as ~margin");
  v.number(
      "distances/budget", p.distances_budget, "s", 0.0, 10.0,
      "most time per tick; what does not fit, the farthest boxes, is not measured; ~events take up to a fifth of it "
      "more; 0: as long as it takes");
  v.integer("distances/threads", p.distances_threads, 1, 64, "that measure");

  v.section("Limits");
  v.number("world_limit", p.world_limit, "m", 1.0, 1e6, "poses beyond this are refused, per axis");
  v.number("min_size", p.min_size, "m", 1e-6, 1.0, "smallest radius, side or height of a shape");
  v.number("max_size", p.max_size, "m", 1.0, 1e5, "largest radius, side, height or vertex coordinate of a shape");
  v.flag("allow_flat", p.allow_flat, "boxes may have one side of 0");
  v.integer("threads", p.threads, 1, 64,
            "that a tick's broad phase may use; worth more than 1 from some tens of thousands of shapes on");
  v.integer("max_bodies", p.max_bodies, 1, 1000000, "bodies");
  v.integer("max_frames", p.max_frames, 1, 1000000, "tf frames that are kept");
  v.integer(
      "tf_queue_bytes", p.tf_queue_bytes, 1000, 1 << 30,
      "bytes of messages of /tf that wait for the tick thread, and as many of /tf_static; each message counts 256 "
      "bytes and its publisher's name more; when there are more, the oldest are dropped (tf.dropped.LIMIT in "
      "~status); a longer message is refused");
  v.integer("max_pairs", p.max_pairs, 1, 10000000, "pairs that a tick lists; more: truncated, and not complete");
  v.integer("max_events", p.max_events, 1, 1000000, "events in one message of ~events; more: several messages");
  v.integer("event_queue", p.event_queue, 1, 100000,
            "messages of ~events that wait for a slow subscriber; more: the oldest are lost");
  v.integer("max_hits", p.max_hits, 1, 1000000, "hits in one answer; more: truncated");
  v.integer("max_listed", p.max_listed, 1, 100000, "bodies that ~status lists");
  v.integer("max_reasons", p.max_reasons, 1, 1000, "reasons for an incomplete world that a message lists");
  v.integer("max_rules", p.max_rules, 1, 10000, "rules of the allowed-pair matrix, those of allowed_pairs included");
  v.integer("max_description_bytes", p.max_description_bytes, 1000, 256 << 20, "bytes of a URDF or SRDF");
  v.integer("max_description_depth", p.max_description_depth, 8, 256, "nesting of elements in a URDF or SRDF");
  v.integer("max_links", p.max_links, 1, 100000, "links of a robot");
  v.integer("max_mesh_bytes", p.max_mesh_bytes, 1000, 1 << 30, "bytes of a mesh file");
  v.integer("max_mesh_triangles", p.max_mesh_triangles, 1, 100000000, "triangles of a mesh");
  v.integer("mesh_memory", p.mesh_memory, 64 << 20, 2147483647,
            "bytes of memory for reading a mesh; meshes near max_mesh_triangles need more than the default");
  v.number("mesh_timeout", p.mesh_timeout, "s", 0.1, 600.0, "time for reading a mesh");

  v.section("The node");
  v.integer("query_threads", p.query_threads, 1, 64, "threads that answer queries");
  v.number("marker_rate", p.marker_rate, "Hz", 0.1, 100.0, "~markers per second while somebody looks");
}

/// Fills Params from the parameter server's values.
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
      robot.semantic.clear();  // the default one may be another robot's
      readString(element, "description", robot.description, true);
      readString(element, "semantic", robot.semantic, false);
      readString(element, "tf_prefix", robot.tf_prefix, false);
      if (auto given = element.require("name")) {
        given->string(robot.name);
        try {
          checkSource(robot.name, "it");
        } catch (const Refusal& refusal) {
          given->error(std::string("cannot be a name: ") + refusal.what());
        }
        if (robot.name == "obstacle" || robot.name == "map" || robot.name == "cloud") {
          given->error("is '" + robot.name + "'; obstacle, map and cloud are reserved");
        }
        if (!names.insert(robot.name).second) given->error("is '" + printable(robot.name) + "' a second time");
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
    forEach(name, "field of it", [&](ParamValue& element) {
      value.emplace_back();
      readString(element, "first", value.back().first, true);
      readString(element, "second", value.back().second, true);
      if (auto number = element.require("margin")) number->number(value.back().margin, low, high, "m");
    });
  }
  void values(const char* name, std::vector<PatternValue>& value, const char* key, const char* unit, double low,
              double high, const char*) {
    forEach(name, "field of it", [&](ParamValue& element) {
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
        given->error("names '" + printable(kind, 48) +
                     "'; kinds are self, robot_robot, robot_obstacle, robot_map, moving_obstacle");
      }
    }
  }
  void obstacles(const char* name, std::vector<ObstacleParams>& value, const char*) {
    obstacles_ = get(name);  // read last: the limits on sizes are parameters too
    obstacles_target_ = &value;
  }
  void maps(const char* name, std::vector<MapParams>& value, const char*) {
    std::set<std::string> names;
    forEach(name, "field of a map (name, file, topic, frame, pose, max_age)", [&](ParamValue& element) {
      MapParams map;
      readString(element, "file", map.file, false);
      readString(element, "topic", map.topic, false);
      if (!map.file.empty() && !map.topic.empty()) element.error("must have a file or a topic, and not both");
      if (map.file.empty() && map.topic.empty()) map.topic = "octomap_binary";
      if (map.file.empty()) checkTopic(element, map.topic);
      readString(element, "frame", map.frame, false);
      map.frame = withoutSlash(map.frame);
      if (auto pose = element.get("pose")) map.frame_from_map = readPose(*pose);
      if (auto given = element.get("max_age")) given->number(map.max_age, 0.0, 86400.0, "s");
      if (map.max_age > 0.0 && !map.file.empty()) {
        element.error("has max_age " + text(map.max_age) + " s and a file; only a map of a topic can grow old");
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

  /// A word of a list; its place there is the value.
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

  /// Of a name "group/key" the member of that struct.
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

/// Writes config/params.yaml.
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
    while (!meaning.empty()) {  // wrapped for people
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
  std::string group_;  // of the last entry
};

}  // namespace

Params readParams(XmlRpc::XmlRpcValue values) {
  std::vector<std::string> errors;
  Params params;
  ParamValue root(std::move(values), "~", errors);
  root.get("diagnostic_period");  // of diagnostic_updater
  Reader reader(root, params);
  visit(reader, params);
  reader.finish();
  if (params.robots.empty()) params.robots.push_back(RobotParams{});
  for (const RobotParams& robot : params.robots) {  // they may stand in the node's own namespace
    root.get(robot.description);
    root.get(robot.semantic);
  }
  root.finish("parameter of this node");

  const auto require = [&](bool holds, const std::string& sentence) {
    if (!holds) errors.push_back(sentence);
  };
  require(params.late_after <= params.stale_after && params.stale_after <= params.lost_after,
          "~late_after is " + text(params.late_after) + " s, ~stale_after " + text(params.stale_after) +
              " s, ~lost_after " + text(params.lost_after) + " s; they must not decrease in this order");
  require(params.valid_for * params.rate >= 1.0, "~valid_for is " + text(params.valid_for) +
                                                     " s; it must be at least one period of ~rate, " +
                                                     text(1.0 / params.rate) + " s");
  require(params.distances_max <= params.margin, "~distances/max is " + text(params.distances_max) +
                                                     " m; it must be at most ~margin, " + text(params.margin) + " m");
  for (int axis = 0; axis < 3; ++axis) {
    require(params.map_crop_min[axis] <= params.map_crop_max[axis],
            std::string("~map/crop_min is ") + text(params.map_crop_min[axis]) + " m along " + "xyz"[axis] +
                ", ~map/crop_max " + text(params.map_crop_max[axis]) + " m; the first must be at most the second");
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
          "~world_frame is empty; with several robots it must name the frame that all are known in");
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
  return "# All parameters of proximity_node with their defaults. In brackets the unit, at the end the range, both "
         "ends\n"
         "# allowed. Load what you change into the node's private namespace; unknown names stop the start.\n" +
         printer.yaml();
}

}  // namespace hgrid
