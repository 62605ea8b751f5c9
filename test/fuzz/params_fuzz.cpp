// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "src/node/params/param_table.h"
#include "test/fuzz/param_text.h"
#include "test/fuzz/targets.h"
#include "test/support/sentences.h"

namespace hgrid {
namespace test {
namespace {

/// A visitor that checks the accepted values against the ranges of the table.
class RangeCheck {
 public:
  void section(const char*) {}
  void changeable() {}
  void string(const char*, const std::string&, const char*) {}
  void strings(const char*, const std::vector<std::string>&, const char*) {}
  void flag(const char*, bool, const char*) {}
  void kinds(const char*, const PairKinds&, const char*) {}
  void waivers(const char*, const std::vector<Waiver>&, const char*) {}
  void unknownSpace(const char* name, UnknownSpace value, const char*) {
    within(name, static_cast<double>(value), 0.0, 2.0);
  }
  void broadPhase(const char* name, BroadPhaseType value, const char*) {
    within(name, static_cast<double>(value), 0.0, static_cast<double>(broadPhaseTypes().size() - 1));
  }
  void vector(const char* name, const Eigen::Vector3d& value, const char*, double limit, const char*) {
    for (int axis = 0; axis < 3; ++axis) within(name, value[axis], -limit, limit);
  }
  void number(const char* name, double value, const char*, double low, double high, const char*) {
    within(name, value, low, high);
  }
  void integer(const char* name, int value, int low, int high, const char*) { within(name, value, low, high); }
  void pairMargins(const char* name, const std::vector<PairMargin>& values, double low, double high, const char*) {
    for (const PairMargin& entry : values) within(name, entry.margin, low, high);
  }
  void values(const char* name, const std::vector<PatternValue>& values, const char*, const char*, double low,
              double high, const char*) {
    for (const PatternValue& entry : values) within(name, entry.value, low, high);
  }
  void allowed(const char*, const std::vector<PairRule>&, const char*) {}
  void rooms(const char* name, const std::vector<Room>& rooms, const char*) {
    for (const Room& room : rooms) {
      named(name, room.name);
      if (room.walls.empty()) flaw = "a room has no walls";
      for (const RoomWall& wall : room.walls) {
        within(name, wall.normal.norm(), 1.0 - 1e-9, 1.0 + 1e-9);
        within(name, wall.offset, -4e6, 4e6);
      }
    }
    rooms_ = rooms.size();
  }
  void doors(const char* name, const std::vector<Portal>& doors, const char*) {
    for (const Portal& door : doors) {
      for (const std::size_t room : door.rooms) within(name, static_cast<double>(room), 0.0, double(rooms_) - 1.0);
      if (door.rooms[0] == door.rooms[1]) flaw = "a door leads from a room to itself";
      for (int axis = 0; axis < 3; ++axis) within(name, door.opening.sizes()[axis], 0.0, 4e6);
    }
  }
  void robots(const char* name, const std::vector<RobotParams>& robots, const char*) {
    for (const RobotParams& robot : robots) named(name, robot.name);
  }
  void maps(const char* name, const std::vector<MapParams>& maps, const char*) {
    for (const MapParams& map : maps) {
      named(name, map.name);
      within(name, map.max_age, 0.0, 86400.0);
      if (!map.frame_from_map.matrix().allFinite()) flaw = "a map has a pose that is not finite";
      if (map.file.empty() == map.topic.empty()) flaw = "a map does not have either a file or a topic";
    }
  }
  void clouds(const char* name, const std::vector<CloudParams>& clouds, const char*) {
    for (const CloudParams& cloud : clouds) {
      named(name, cloud.name);
      within(name, cloud.resolution, 0.001, 100.0);
      within(name, cloud.lifetime, 0.01, 3600.0);
      within(name, cloud.range, 0.0, 1e6);
      within(name, cloud.min_points, 1, 1e8);
    }
  }
  void pathTopics(const char*, const std::vector<PathTopicParams>& topics, const char*) {
    for (const PathTopicParams& topic : topics) {
      if (topic.topic.empty()) flaw = "a topic with paths has no name";
    }
  }
  void trackers(const char* name, const std::vector<TrackerParams>& trackers, const char*) {
    for (const TrackerParams& tracker : trackers) {
      named(name, tracker.name);
      within(name, tracker.max_speed, 0.0, 1e6);
      within(name, tracker.margin, 0.0, 1e3);
      within(name, tracker.noise, 0.0, 100.0);
      within(name, tracker.forget, 0.1, 86400.0);
      within(name, tracker.max_tracks, 1, 1000);
      if (tracker.shapes.empty()) flaw = "a tracker has no shape";
    }
  }
  void obstacles(const char* name, const std::vector<ObstacleParams>& obstacles, const char*) {
    for (const ObstacleParams& obstacle : obstacles) {
      named(name, obstacle.body.name);
      if (!obstacle.body.frame_from_body.matrix().allFinite()) flaw = "an obstacle has a pose that is not finite";
      if (obstacle.body.shapes.empty()) flaw = "an obstacle has no shape";
      for (const BodyShape& shape : obstacle.body.shapes) {
        const Aabb box = boxOf(shape.shape, shape.body_from_shape, 0.0, Eigen::Vector3d::Zero());
        if (!isValid(box)) flaw = "an obstacle has an invalid shape";
      }
    }
  }

  std::string flaw;

 private:
  std::size_t rooms_ = 0;
  void within(const std::string& name, double value, double low, double high) {
    if (!(value >= low && value <= high)) flaw = "~" + name + " was accepted with " + text(value);
  }
  void named(const std::string& parameter, const std::string& name) {
    if (!flawOfSentence(name).empty()) flaw = "~" + parameter + ": an invalid name was accepted";
  }
};

/// Checks the relations between parameters that the table does not contain.
std::string flawOfSettings(Params params) {
  RangeCheck check;
  visitParams(check, params);
  if (!check.flaw.empty()) return check.flaw;
  if (params.late_after > params.stale_after || params.stale_after > params.lost_after) return "a wrong order of ages";
  if (params.valid_for * params.rate < 1.0) return "~valid_for is too short";
  if (params.follow_data && params.valid_for * std::min(params.rate, params.heartbeat) < 1.0)
    return "~valid_for is too short";
  if (params.distances_max > params.margin) return "~distances/max is larger than ~margin";
  if ((params.map_crop_min.array() > params.map_crop_max.array()).any()) return "~map/crop is an empty box";
  if (params.robots.empty()) return "there is no robot";
  if (params.robots.size() > 1 && params.world_frame.empty()) return "several robots without a world frame";
  if (params.maps.size() > static_cast<std::size_t>(params.max_maps)) return "there are too many maps";
  return {};
}

/// Checks the text that lists all wrong parameters: `N parameters are wrong:` and N lines that each begin with `  ~`.
std::string flawOfList(const std::string& text) {
  std::istringstream lines(text);
  std::size_t count = 0, found = 0;
  std::string title, line;
  lines >> count;
  std::getline(lines, title);
  if (title != (count == 1 ? " parameter is wrong:" : " parameters are wrong:")) return "another title: " + text;
  for (; std::getline(lines, line); ++found) {
    if (line.rfind("  ~", 0) != 0) return "a line names no parameter: " + line;
    if (!flawOfSentence(line).empty()) return flawOfSentence(line);
  }
  return count == found && count > 0 ? "" : "the number of errors is wrong: " + text;
}

}  // namespace

FuzzResult fuzzParams(std::string_view input) {
  try {
    return {true, flawOfSettings(readParams(paramsFrom(input)))};
  } catch (const std::invalid_argument& refusal) {
    return {false, flawOfList(refusal.what())};
  }
}

}  // namespace test
}  // namespace hgrid
