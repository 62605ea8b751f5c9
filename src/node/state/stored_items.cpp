// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/state/stored_items.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <sstream>
#include <utility>

#include "node/params/body_params.h"
#include "node/text/body_text.h"

namespace hgrid {
namespace {

constexpr const char* kRemoved = "removed\n";  // the text of a removed obstacle or map

template <class File>
void passNames(File& file, const char* word, std::vector<std::string>& names) {
  passAll(file, word, names, {}, [&](std::string& name) {
    file.line("name");
    file.value(name);
  });
}

template <class File>
void pass(File& file, std::string& text) {
  file.value(text);
}

/// Writes or reads a value that may be absent.
template <class File, class Value>
void passOptional(File& file, std::optional<Value>& value, const Value& blank) {
  bool exists = value.has_value();
  file.value(exists);
  if (File::kReads) value = exists ? std::optional<Value>(blank) : std::nullopt;
  if (value) pass(file, *value);
}

template <class File>
void pass(File& file, RequestedObstacle& what) {
  auto lifetime = static_cast<std::int64_t>(what.lifetime.count());
  file.line("obstacle");
  file.value(what.moving);
  file.value(what.lost_at_end);
  file.value(lifetime);
  file.value(what.owner);
  what.lifetime = std::chrono::nanoseconds(lifetime);
  pass(file, what.body);
}

template <class File>
void pass(File& file, Attachment& attachment) {
  file.line("attachment");
  file.value(attachment.link);
  file.value(attachment.owner);
  file.value(attachment.without_robot);
  passOptional(file, attachment.link_from_body, Pose(Pose::Identity()));
  passNames(file, "touch", attachment.touch);
  passNames(file, "touch_links", attachment.touch_links);
}

template <class File>
void pass(File& file, PlacedObstacle& obstacle) {
  RequestedObstacle what = obstacle.what ? *obstacle.what : RequestedObstacle();
  pass(file, what);
  file.line("place");
  file.value(obstacle.owner);
  file.value(obstacle.asked.frame);
  passOptional(file, obstacle.asked.at, Time(0));
  pass(file, obstacle.asked.frame_from_body);
  file.line("pose");
  file.value(obstacle.lost);
  file.value(obstacle.frame);
  pass(file, obstacle.frame_from_body);
  bool is_attached = obstacle.attachment != nullptr;
  file.line("attached");
  file.value(is_attached);
  if (is_attached) {
    Attachment attachment = obstacle.attachment ? *obstacle.attachment : Attachment();
    pass(file, attachment);
    file.line("carrier");
    file.value(obstacle.carrier_speed);
    passNames(file, "touches", obstacle.touch);
    if (File::kReads) obstacle.attachment = std::make_shared<const Attachment>(std::move(attachment));
  }
  if (File::kReads) obstacle.what = std::make_shared<const RequestedObstacle>(std::move(what));
}

template <class File>
void pass(File& file, MapParams& map) {
  file.line("file");
  file.value(map.file);
  file.value(map.frame);
  pass(file, map.frame_from_map);
}

template <class File>
void pass(File& file, RobotDescription& text) {
  std::string urdf = text.urdf();
  std::optional<std::string> srdf = text.srdf();
  file.line("urdf");
  file.value(urdf);
  file.line("srdf");
  passOptional(file, srdf, std::string());
  if (File::kReads) text = RobotDescription(std::move(urdf), std::move(srdf));
}

}  // namespace

std::string keyOf(const RobotDescription& text) {
  std::ostringstream key;
  key << kDescriptionKeys << std::hex << text.hash();
  return key.str();
}

namespace {

/// @param text_key  key of the description of the robot; empty: parameters hold it
template <class File>
void pass(File& file, StoredRobot& robot, std::string& text_key) {
  file.line("robot");
  file.value(robot.absent);
  file.value(robot.spec.params.description);
  file.value(robot.spec.params.semantic);
  file.value(robot.spec.params.tf_prefix);
  file.value(text_key);
}

template <class File>
void pass(File& file, PairRule& rule, const RuleClocks& clocks) {
  using Steady = PairRule::Clock;
  bool ends = rule.ends != Steady::time_point::max();
  std::int64_t remaining = 0;  // [ns]
  std::int64_t wall_end = 0;   // [ns] by the wall clock
  if (ends && !File::kReads) {
    remaining = std::chrono::nanoseconds(rule.ends - clocks.steady).count();
    wall_end = remaining + std::chrono::nanoseconds(clocks.wall.time_since_epoch()).count();
  }
  file.line("rule");
  file.value(rule.first);
  file.value(rule.second);
  file.value(rule.reason);
  file.value(rule.allowed);
  file.value(rule.set_by);
  pass(file, rule.since);
  file.value(ends);
  file.value(remaining);
  file.value(wall_end);
  if (!File::kReads) return;
  rule.origin = Origin::service;
  if (!ends) return;
  // A wall clock that was set back must not prolong the rule.
  const std::chrono::nanoseconds by_wall = std::chrono::nanoseconds(wall_end) - clocks.wall.time_since_epoch();
  const std::chrono::nanoseconds left = std::min(std::chrono::nanoseconds(remaining), by_wall);
  rule.ends = clocks.steady + std::chrono::duration_cast<Steady::duration>(left);
}

template <class Value>
std::string textOf(Value value) {
  std::ostringstream out;
  TextWriter writer(out);
  pass(writer, value);
  return out.str() + "\n";
}

template <class Value>
Value read(const std::string& key, const std::string& text) {
  std::istringstream in(text);
  TextReader reader(in, "the stored " + key);
  Value value;
  pass(reader, value);
  return value;
}

bool begins(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

void readRobot(const std::string& key, const std::string& text, StoredWorld& stored) {
  const std::string name = key.substr(std::string(kRobotKeys).size());
  std::optional<StoredRobot>& robot = stored.robots[name];
  if (text == kRemoved) return;
  std::istringstream in(text);
  TextReader reader(in, "the stored " + key);
  StoredRobot read;
  std::string text_key;
  pass(reader, read, text_key);
  read.spec.params.name = name;
  if (!text_key.empty()) {
    const auto known = stored.descriptions.find(text_key);
    if (known == stored.descriptions.end()) {
      stored.robots.erase(name);
      throw Refusal(Code::parse, "the stored " + key + " cannot be used, because its description is not stored");
    }
    read.spec.text = known->second;
  }
  robot = std::move(read);
}

void readItem(const std::string& key, const std::string& text, NarrowPhase& narrow_phase, const RuleClocks& clocks,
              StoredWorld& stored) {
  if (begins(key, kObstacleKeys)) {
    const std::string name = key.substr(std::string(kObstacleKeys).size());
    if (text == kRemoved) {
      stored.removed.insert(name);
      return;
    }
    PlacedObstacle obstacle = read<PlacedObstacle>(key, text);
    auto what = std::make_shared<RequestedObstacle>(*obstacle.what);
    makeSolids(narrow_phase, what->body);
    obstacle.what = std::move(what);
    obstacle.restored = true;
    stored.obstacles.push_back(std::move(obstacle));
  } else if (begins(key, kMapKeys)) {
    const std::string name = key.substr(std::string(kMapKeys).size());
    std::optional<MapParams> map;
    if (text != kRemoved) {
      map = read<MapParams>(key, text);
      map->name = name;
    }
    stored.maps[name] = map;
  } else if (begins(key, kDescriptionKeys)) {  // these come before the robots, because items are sorted
    stored.descriptions[key] = std::make_shared<const RobotDescription>(read<RobotDescription>(key, text));
  } else if (begins(key, kRobotKeys)) {
    readRobot(key, text, stored);
  } else if (key == kRulesKey) {
    std::istringstream in(text);
    TextReader reader(in, "the stored " + key);
    std::vector<PairRule> rules;  // separate, so that an exception leaves no rule
    passAll(reader, "rules", rules, {}, [&](PairRule& rule) { pass(reader, rule, clocks); });
    const auto has_ended = [&](const PairRule& rule) { return rule.ends <= clocks.steady; };
    rules.erase(std::remove_if(rules.begin(), rules.end(), has_ended), rules.end());
    stored.rules = std::move(rules);
  }
}

}  // namespace

StateEdit editOf(const PlacedObstacle& obstacle) {
  return {StateEdit::Kind::set, kObstacleKeys + obstacle.what->body.name, textOf(obstacle)};
}

StateEdit removalOf(const std::string& obstacle, bool is_configured) {
  const std::string key = kObstacleKeys + obstacle;
  if (is_configured) return {StateEdit::Kind::set, key, kRemoved};
  return {StateEdit::Kind::erase, key, ""};
}

StateEdit editOf(const std::vector<PairRule>& rules, const RuleClocks& clocks) {
  if (rules.empty()) return {StateEdit::Kind::erase, kRulesKey, ""};
  std::ostringstream out;
  TextWriter writer(out);
  std::vector<PairRule> copy = rules;
  passAll(writer, "rules", copy, {}, [&](PairRule& rule) { pass(writer, rule, clocks); });
  return {StateEdit::Kind::set, kRulesKey, out.str() + "\n"};
}

StateEdit editOf(const std::string& name, const std::optional<MapParams>& map) {
  return {StateEdit::Kind::set, kMapKeys + name, map ? textOf(*map) : kRemoved};
}

StateEdit editOfRobot(const std::string& name, const std::optional<StoredRobot>& robot) {
  if (!robot) return {StateEdit::Kind::set, kRobotKeys + name, kRemoved};
  std::ostringstream out;
  TextWriter writer(out);
  StoredRobot copy = *robot;
  std::string text_key = copy.spec.text ? keyOf(*copy.spec.text) : "";
  pass(writer, copy, text_key);
  return {StateEdit::Kind::set, kRobotKeys + name, out.str() + "\n"};
}

StateEdit editOf(const RobotDescription& text) { return {StateEdit::Kind::set, keyOf(text), textOf(text)}; }

StateEdit removalOf(const RobotDescription& text) { return {StateEdit::Kind::erase, keyOf(text), ""}; }

StateEdit removalOfRobot(const std::string& name) { return {StateEdit::Kind::erase, kRobotKeys + name, ""}; }

StoredWorld storedWorldOf(const StateItems& items, NarrowPhase& narrow_phase, const RuleClocks& clocks) {
  StoredWorld stored;
  for (const auto& [key, text] : items) {
    try {
      readItem(key, text, narrow_phase, clocks, stored);
    } catch (const Refusal& refusal) {
      stored.troubles.push_back(refusal.what());
      stored.unreadable.push_back(key);
    }
  }
  return stored;
}

}  // namespace hgrid
