// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/case_file.h"

#include <istream>
#include <ostream>

#include "hgrid_proximity/refusal.h"
#include "node/text/body_text.h"

namespace hgrid {
namespace {

constexpr const char* kTitle = "hgrid_proximity_audit_5";  // kind and version of the file

// Each pass() function writes a value if the file is a TextWriter. If the file is a TextReader, it reads the value.

template <class File>
void pass(File& file, BodyPose& pose) {
  file.line("pose");
  file.value(pose.state);
  pass(file, pose.stamp);
  file.value(pose.age);
  file.value(pose.period);
  pass(file, pose.world_from_body);
}

template <class File>
void pass(File& file, RecordedTransform& transform) {
  file.line("transform");
  file.value(transform.parent);
  file.value(transform.child);
  file.value(transform.publisher);
  file.value(transform.is_static);
  pass(file, transform.stamp);
  pass(file, transform.received);
  for (double& number : transform.numbers) file.value(number);
}

template <class File>
void pass(File& file, RecordedCells& cells) {
  file.line("map");
  file.value(cells.body);
  file.value(cells.finest_edge);
  passAll(file, "cells", cells.voxels, {}, [&](Voxel& voxel) {
    file.line("cell");
    file.value(voxel.x);
    file.value(voxel.y);
    file.value(voxel.z);
    file.value(voxel.level);
  });
}

template <class File>
void pass(File& file, NearPair& pair) {
  file.line("pair");
  file.value(pair.first);
  file.value(pair.second);
  file.value(pair.gap);
  file.value(pair.margin);
  file.value(pair.flags);
}

template <class File>
void pass(File& file, RecordedQuery& query) {
  file.line("query");
  file.value(query.kind);
  file.value(query.verdict);
  pass(file, query.from);
  pass(file, query.to);
  file.value(query.radius);
  pass(file, query.box.size);
  pass(file, query.box.world_from_box);
  passAll(file, "hits", query.hits, {}, [&](RecordedQuery::Hit& hit) {
    file.line("hit");
    file.value(hit.body);
    file.value(hit.distance);
  });
}

template <class File>
void passRooms(File& file, AuditCase& audited) {
  passAll(file, "rooms", audited.rooms, {}, [&](Room& room) {
    file.line("room");
    file.value(room.name);
    passAll(file, "walls", room.walls, {}, [&](RoomWall& wall) {
      file.line("wall");
      pass(file, wall.normal);
      file.value(wall.offset);
    });
  });
  passAll(file, "doors", audited.doors, {}, [&](Portal& door) {
    file.line("door");
    for (std::size_t& room : door.rooms) file.value(room);
    pass(file, door.opening.min());
    pass(file, door.opening.max());
  });
}

template <class File>
void passSettings(File& file, AuditCase& audited) {
  file.line("settings");
  for (double* number : {&audited.margin, &audited.growth_cap, &audited.growth_after, &audited.max_sync_wait,
                         &audited.max_future, &audited.world_limit, &audited.origin_distance, &audited.horizon}) {
    file.value(*number);
  }
  PairKinds& kinds = audited.pair_kinds;
  file.line("pair_kinds");
  for (bool* kind :
       {&kinds.self, &kinds.robot_robot, &kinds.robot_obstacle, &kinds.robot_map, &kinds.moving_obstacle}) {
    file.value(*kind);
  }
  passAll(file, "pair_margins", audited.pair_margins, {}, [&](PairMargin& entry) {
    file.line("pair_margin");
    file.value(entry.first);
    file.value(entry.second);
    file.value(entry.margin);
  });
  passAll(file, "rules", audited.rules, {}, [&](PairRule& rule) {
    file.line("rule");
    file.value(rule.first);
    file.value(rule.second);
    file.value(rule.allowed);
  });
}

template <class File>
void passCase(File& file, AuditCase& audited) {
  file.line(kTitle);
  file.line("tick");
  file.value(audited.config_hash);
  file.value(audited.epoch);
  file.value(audited.sequence);
  pass(file, audited.stamp);
  pass(file, audited.made);
  pass(file, audited.record_begin);
  file.value(audited.world_frame);
  file.value(audited.truncated);
  file.value(audited.all_static);
  passSettings(file, audited);
  passRooms(file, audited);
  passAll(file, "names", audited.names, {}, [&](std::string& name) {
    file.line("name");
    file.value(name);
  });
  passAll(file, "free_frames", audited.free_frames, {}, [&](std::string& name) {
    file.line("free_frame");
    file.value(name);
  });
  passAll(file, "transforms", audited.transforms, {}, [&](RecordedTransform& transform) { pass(file, transform); });
  passAll(file, "bodies", audited.bodies, {}, [&](Body& body) { pass(file, body); });
  passAll(file, "poses", audited.poses, {}, [&](BodyPose& pose) { pass(file, pose); });
  passAll(file, "switched_off", audited.switched_off, {}, [&](std::pair<std::uint32_t, std::uint32_t>& pair) {
    file.line("off");
    file.value(pair.first);
    file.value(pair.second);
  });
  passAll(file, "maps", audited.cells, {}, [&](RecordedCells& cells) { pass(file, cells); });
  passAll(file, "pairs", audited.pairs, {}, [&](NearPair& pair) { pass(file, pair); });
  passAll(file, "queries", audited.queries, {}, [&](RecordedQuery& query) { pass(file, query); });
  file.line("end");
}

/// Checks that each index of a body or name is less than the number of bodies or names in the case.
void checkIndices(const AuditCase& audited) {
  const std::size_t bodies = audited.bodies.size();
  bool valid = audited.poses.size() == bodies;
  const std::size_t names = audited.names.size();
  for (const RecordedTransform& transform : audited.transforms) {
    valid = valid && transform.parent < names && transform.child < names && transform.publisher < names;
  }
  for (const NearPair& pair : audited.pairs) valid = valid && pair.first < pair.second && pair.second < bodies;
  for (const Portal& door : audited.doors) {
    for (const std::size_t room : door.rooms) valid = valid && room < audited.rooms.size();
  }
  for (const RecordedCells& cells : audited.cells) valid = valid && cells.body < bodies;
  for (const RecordedQuery& query : audited.queries) {
    valid = valid && query.kind <= RecordedQuery::Kind::nearest;
    for (const RecordedQuery::Hit& hit : query.hits) valid = valid && hit.body < bodies;
  }
  if (!valid)
    throw Refusal(Code::parse, "the audit file is not valid: the number of a body or name is beyond its list");
}

}  // namespace

void writeCase(const AuditCase& audited, std::ostream& out) {
  AuditCase copy = audited;  // passCase() needs a value that it could also change
  TextWriter writer(out);
  passCase(writer, copy);
  out << '\n';
}

AuditCase readCase(std::istream& in) {
  AuditCase audited;
  TextReader reader(in, "the audit file");
  passCase(reader, audited);
  checkIndices(audited);
  return audited;
}

}  // namespace hgrid
