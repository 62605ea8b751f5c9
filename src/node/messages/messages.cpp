// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/messages.h"

#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/ShapeKind.h>

#include <algorithm>
#include <cmath>

#include "node/messages/interface_version.h"
#include "node/messages/source_messages.h"

namespace hgrid {
namespace {

msg::Shape toMsg(const BodyShape& source) {
  msg::Shape shape;
  shape.kind = static_cast<std::uint8_t>(source.shape.kind());
  shape.dimensions = source.shape.dimensions();
  shape.pose = toPose(source.body_from_shape);
  shape.padding = source.padding;
  shape.resource = source.resource;
  shape.scale.x = source.scale.x();
  shape.scale.y = source.scale.y();
  shape.scale.z = source.scale.z();
  if (source.shape.mesh()) {
    shape.vertex_count = static_cast<std::uint32_t>(source.shape.mesh()->vertices.size());
    shape.triangle_count = static_cast<std::uint32_t>(source.shape.mesh()->triangles.size());
  }
  return shape;
}

msg::SelfPairs toMsg(const std::string& robot, const SelfPairs& counts) {
  msg::SelfPairs message;
  message.robot = robot;
  message.links = static_cast<std::uint32_t>(counts.links);
  message.pairs = static_cast<std::uint32_t>(counts.pairs);
  message.rigid = static_cast<std::uint32_t>(counts.rigid);
  message.adjacent = static_cast<std::uint32_t>(counts.adjacent);
  message.srdf = static_cast<std::uint32_t>(counts.srdf);
  return message;
}

msg::Body toMsg(const Body& source, double margin) {
  msg::Body body;
  body.name = source.name;
  body.frame = source.frame;
  body.pose = toPose(source.frame_from_body);
  body.mobility = static_cast<std::uint8_t>(source.mobility);
  body.robot = source.robot;
  body.rigid_group = source.rigid_group;
  for (const BodyShape& shape : source.shapes) body.shapes.push_back(toMsg(shape));
  body.covered = source.covered;
  body.waived = source.waived;
  body.note = source.note;
  body.margin = margin;
  body.max_speed = std::isfinite(source.max_speed) ? source.max_speed : std::nan("");
  return body;
}

}  // namespace

ros::Time toRos(Time time) {
  return ros::Time().fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(0, time.count())));
}

geometry_msgs::Point toPoint(const Eigen::Vector3d& point) {
  geometry_msgs::Point result;
  result.x = point.x();
  result.y = point.y();
  result.z = point.z();
  return result;
}

geometry_msgs::Vector3 toVector(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 result;
  result.x = vector.x();
  result.y = vector.y();
  result.z = vector.z();
  return result;
}

geometry_msgs::Pose toPose(const Pose& pose) {
  geometry_msgs::Pose result;
  const Eigen::Quaterniond rotation(pose.linear());
  result.position = toPoint(pose.translation());
  result.orientation.x = rotation.x();
  result.orientation.y = rotation.y();
  result.orientation.z = rotation.z();
  result.orientation.w = rotation.w();
  return result;
}

msg::Code toMsg(Code code, const std::string& sentence) {
  msg::Code result;
  result.value = static_cast<std::uint16_t>(code);
  result.name = name(code);
  result.text = sentence;
  return result;
}

std_msgs::Header headerOf(const Tick& tick) {
  std_msgs::Header header;
  header.frame_id = tick.world_frame;
  if (tick.snapshot) header.stamp = toRos(tick.snapshot->stamp());
  return header;
}

std::vector<std::string> firstOf(const std::vector<std::string>& all, std::size_t most) {
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), most))};
}

std::string truncationOf(const Snapshot& snapshot) {
  if (!snapshot.truncated()) return {};
  const std::string listed = std::to_string(snapshot.pairs().size());
  const bool more = snapshot.pairsFound() > snapshot.pairs().size();
  return "TRUNCATED: " + (more ? "more than " + listed + " pairs are near" : "more boxes overlap than are looked at") +
         "; ~pairs lists " + listed + " of the pairs (~max_pairs)";
}

msg::WorldState worldState(const Tick& tick, const Params& params, std::uint64_t config_hash, double age_since) {
  msg::WorldState world;
  world.epoch = tick.epoch;
  world.config_hash = config_hash;
  world.valid_until = toRos(tick.made.ros + std::chrono::nanoseconds(std::llround(1e9 * params.valid_for)));
  world.unknown_space = static_cast<std::uint8_t>(params.map_unknown);
  if (!tick.snapshot) {
    world.reasons = tick.not_ready;
    world.reasons_total = static_cast<std::uint32_t>(tick.not_ready.size());
    world.worst_state = msg::BodyState::UNPLACED;
    for (const msg::SourceStatus& source : sourcesOf(tick, params)) world.incomplete.push_back(source.name);
    world.incomplete_total = static_cast<std::uint32_t>(world.incomplete.size());
    world.incomplete = firstOf(world.incomplete, static_cast<std::size_t>(params.max_listed));
    return world;
  }
  const Snapshot& snapshot = *tick.snapshot;
  world.stamp = world.history_begin = toRos(snapshot.stamp());
  world.sequence = snapshot.sequence();
  world.bodies_revision = snapshot.structure().revision;
  world.complete = snapshot.complete() && !snapshot.truncated();
  world.incomplete = firstOf(snapshot.incompleteSources(), static_cast<std::size_t>(params.max_listed));
  world.incomplete_total = static_cast<std::uint32_t>(snapshot.incompleteSources().size());
  world.reasons = snapshot.reasons();
  world.reasons_total = snapshot.reasonsTotal();
  if (snapshot.truncated()) {
    world.reasons.push_back(truncationOf(snapshot));
    ++world.reasons_total;
  }
  world.worst_state = static_cast<std::uint8_t>(snapshot.worstState());
  world.last_event = snapshot.lastEvent();
  world.max_age = snapshot.maxAge() > 0.0 ? snapshot.maxAge() + age_since : 0.0;
  return world;
}

/// The cells of a map, as one shape.
msg::Shape shapeOf(const StaticGrid& grid) {
  msg::Shape shape;
  shape.kind = msg::ShapeKind::CELLS;
  shape.dimensions = {grid.finestEdge(), 0.0, 0.0, 0.0};
  shape.pose.orientation.w = 1.0;
  shape.scale.x = shape.scale.y = shape.scale.z = 1.0;
  shape.vertex_count = static_cast<std::uint32_t>(grid.size());
  if (grid.size() == 0) return shape;
  const Eigen::Vector3d sizes = grid.bounds().sizes();
  for (int axis = 0; axis < 3; ++axis) shape.dimensions[static_cast<std::size_t>(axis) + 1] = sizes[axis];
  shape.pose.position = toPoint(grid.bounds().center());
  return shape;
}

msg::Bodies bodies(const Tick& tick) {
  msg::Bodies message;
  message.header = headerOf(tick);
  message.epoch = tick.epoch;
  message.without_collision = tick.models->without_collision;
  if (!tick.snapshot) return message;
  const Structure& structure = tick.snapshot->structure();
  message.bodies_revision = structure.revision;
  message.origin = toPoint(tick.snapshot->origin());
  for (std::size_t i = 0; i < structure.bodies.size(); ++i) {
    message.bodies.push_back(toMsg(structure.bodies[i], structure.margin[i]));
    const auto cells = tick.snapshot->cellsOf(static_cast<std::uint32_t>(i));
    if (cells) message.bodies.back().shapes.push_back(shapeOf(*cells->grid));
  }
  return message;
}

msg::Status status(const Tick& tick, const msg::WorldState& world, const Params& params, const Ledger& ledger,
                   const Stopwatch& stopwatch) {
  msg::Status message;
  message.header = headerOf(tick);
  message.world = world;
  message.node_version = HGRID_PROXIMITY_VERSION;
  message.interface_version = kInterfaceVersion;
  message.made = toRos(tick.made.ros);
  message.not_ready = tick.not_ready;
  message.sources = sourcesOf(tick, params);
  message.sources_total = static_cast<std::uint32_t>(message.sources.size());
  message.sources.resize(std::min(message.sources.size(), static_cast<std::size_t>(params.max_listed)));
  message.bodies_total = static_cast<std::uint32_t>(tick.troubles.size());
  for (const BodyTrouble& trouble : tick.troubles) {
    if (message.bodies.size() >= static_cast<std::size_t>(params.max_listed)) break;
    msg::BodyStatus body;
    body.name = trouble.name;
    body.frame = trouble.frame;
    body.state = static_cast<std::uint8_t>(trouble.state);
    body.age = trouble.age;
    body.stamp = toRos(trouble.stamp);
    body.code = toMsg(trouble.code, trouble.sentence);
    message.bodies.push_back(body);
  }
  message.missing_frames = tick.missing_frames;
  message.contested_frames = tick.contested_frames;
  message.uncovered = tick.models->uncovered;
  message.waived = tick.models->waived;
  message.without_collision = tick.models->without_collision;
  message.uses_visual = tick.models->uses_visual;
  message.model_warnings = tick.models->warnings;
  for (const auto& robot : tick.models->self_pairs) message.self_pairs.push_back(toMsg(robot.first, robot.second));
  message.robots = static_cast<std::uint32_t>(tick.models->robots);
  if (tick.snapshot) {
    const Snapshot& snapshot = *tick.snapshot;
    message.body_count = static_cast<std::uint32_t>(snapshot.poses().size());
    message.shape_count = static_cast<std::uint32_t>(snapshot.boxes().size());
    message.pair_count = static_cast<std::uint32_t>(snapshot.pairs().size());
    for (const BroadPhaseLevel& level : snapshot.broadPhase().levels()) {
      message.level_count.push_back(static_cast<std::uint32_t>(level.boxes));
      if (std::isfinite(level.edge)) message.level_edge.push_back(level.edge);
    }
  }
  for (const auto& counter : ledger.counters()) {
    message.counters.emplace_back();
    message.counters.back().name = counter.first;
    message.counters.back().value = counter.second;
  }
  const auto gauge = [&](const std::string& name, double value) {
    message.gauges.emplace_back();
    message.gauges.back().name = name;
    message.gauges.back().value = value;
  };
  if (tick.snapshot) {
    const Structure& structure = tick.snapshot->structure();
    for (const std::uint32_t map : structure.maps) {  // in the order of their names
      const auto cells = tick.snapshot->cellsOf(map);
      gauge("cells." + structure.bodies[map].name, cells ? static_cast<double>(cells->grid->size()) : 0.0);
    }
  }
  gauge("tf.frames", static_cast<double>(tick.frames));
  for (const auto& part : stopwatch.summaries()) {
    msg::Timing timing;
    timing.name = part.first;
    timing.last = part.second.last;
    timing.median = part.second.median;
    timing.p99 = part.second.p99;
    timing.max = part.second.max;
    message.timings.push_back(timing);
  }
  message.timing_ticks = static_cast<std::uint32_t>(stopwatch.ticks());
  return message;
}

}  // namespace hgrid
