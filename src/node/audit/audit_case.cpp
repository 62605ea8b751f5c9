// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/audit/audit_case.h"

#include <map>
#include <random>

#include "node/audit/visit_transforms.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostMapCells = 1000000;  // an audit leaves out maps with more cells
constexpr int kQueries = 8;                     // number of queries in an audit: two of each kind

/// Adds transforms to a case. There can be 100,000, so it stores each name only once, and then its index.
class TransformList {
 public:
  explicit TransformList(AuditCase& result) : result_(result) {}

  /// Appends the transforms of a message on /tf. Appends nothing if the bytes are not a valid message, because the node
  /// refuses such a message.
  void append(const ReceivedTransforms& message) {
    const std::size_t before = result_.transforms.size();
    const bool valid = visitTransforms(message.message->bytes, [&](const SerializedTransform& transform) {
      append(transform, message.publisher, false, message.received.ros);
    });
    if (!valid) result_.transforms.resize(before);
  }
  void append(const SerializedTransform& transform, const std::string& publisher, bool is_static, Time received) {
    RecordedTransform result;
    result.parent = numberOf(transform.parent);
    result.child = numberOf(transform.child);
    result.publisher = numberOf(publisher);
    result.is_static = is_static;
    result.stamp = transform.stamp;
    result.received = received;
    result.numbers = transform.numbers;
    result_.transforms.push_back(result);
  }

 private:
  std::uint32_t numberOf(const std::string& name) {
    const auto [entry, is_new] = numbers_.emplace(name, static_cast<std::uint32_t>(result_.names.size()));
    if (is_new) result_.names.push_back(name);
    return entry->second;
  }

  AuditCase& result_;
  std::map<std::string, std::uint32_t> numbers_;  // name -> index; no hash table, because chosen names could collide
};

/// Lists the pairs of links of one robot that the model of the robot switches off.
void listSwitchedOff(const BodyList& bodies, AuditCase& result) {
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].links) continue;
    for (std::uint32_t j = i + 1; j < bodies.size() && bodies[j].robot == bodies[i].robot; ++j) {
      if (bodies[j].links && bodies[i].links->allowed(bodies[i].link, bodies[j].link))
        result.switched_off.push_back({i, j});
    }
  }
}

void listCells(const Snapshot& snapshot, AuditCase& result) {
  for (const std::uint32_t map : snapshot.structure().maps) {
    const auto cells = snapshot.cellsOf(map);
    if (!cells || cells->grid->size() > kMostMapCells) continue;
    result.cells.push_back({map, cells->grid->finestEdge(), cells->grid->voxels()});
  }
}

void note(const QueryAnswer& answer, RecordedQuery& query) {
  query.verdict = answer.verdict;
  for (const QueryHit& hit : answer.hits) query.hits.push_back({hit.body, hit.distance});
}

/// Asks random queries near random bodies, so that most of them hit something.
class Asker {
 public:
  Asker(const Snapshot& snapshot, const NarrowPhase& narrow_phase, std::uint64_t seed)
      : snapshot_(snapshot), narrow_phase_(narrow_phase), random_(seed) {}

  RecordedQuery ask(RecordedQuery::Kind kind) {
    RecordedQuery query;
    query.kind = kind;
    query.from = place();
    query.to = place();
    query.radius = uniform(0.0, 0.5);
    query.box.size = Eigen::Vector3d(uniform(0.05, 1.0), uniform(0.05, 1.0), uniform(0.05, 1.0));
    query.box.world_from_box.translation() = query.from;
    query.box.world_from_box.linear() =
        Eigen::AngleAxisd(uniform(0.0, 3.0), Eigen::Vector3d(uniform(0.1, 1.0), uniform(0.1, 1.0), 1.0).normalized())
            .toRotationMatrix();
    note(answerTo(query), query);
    return query;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d place() {
    const auto& poses = snapshot_.poses();
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    if (!poses.empty()) {
      const BodyPose& pose = poses[random_() % poses.size()];
      if (pose.state != Freshness::unplaced) place = pose.world_from_body.translation();
    }
    return place + Eigen::Vector3d(uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5));
  }
  QueryAnswer answerTo(const RecordedQuery& query) const {
    switch (query.kind) {
      case RecordedQuery::Kind::sphere:
        return hgrid::query(snapshot_, Sphere{query.from, query.radius}, {});
      case RecordedQuery::Kind::segment:
        return hgrid::query(snapshot_, Segment{query.from, query.to, query.radius}, {});
      case RecordedQuery::Kind::box:
        return hgrid::query(snapshot_, query.box, narrow_phase_, {});
      case RecordedQuery::Kind::nearest:
        break;
    }
    return hgrid::nearest(snapshot_, query.from, 0.0, {});
  }

  const Snapshot& snapshot_;
  const NarrowPhase& narrow_phase_;
  std::mt19937_64 random_;
};

void takeSettings(const Params& params, AuditCase& result) {
  result.margin = params.margin;
  result.growth_cap = params.growth_cap;
  result.growth_after = params.stale_after;
  result.max_sync_wait = params.max_sync_wait;
  result.max_future = params.max_future;
  result.world_limit = params.world_limit;
  result.origin_distance = params.origin.cwiseAbs().maxCoeff();
  result.horizon = params.horizon;
  result.rooms = params.rooms;
  result.doors = params.doors;
  result.pair_kinds = params.pair_kinds;
  result.pair_margins = params.pair_margins;
}

}  // namespace

AuditCase caseOf(const Tick& tick, const TransformRecord::Content& record, std::uint64_t seed,
                 const NarrowPhase& narrow_phase) {
  const Snapshot& snapshot = *tick.snapshot;
  AuditCase result;
  takeSettings(tick.settings->params, result);
  result.config_hash = std::to_string(tick.settings->config_hash);
  result.epoch = tick.epoch;
  result.sequence = snapshot.sequence();
  result.stamp = snapshot.stamp();
  result.made = tick.made.ros;
  result.world_frame = tick.world_frame;
  result.rules = snapshot.structure().filter.rules();
  TransformList transforms(result);
  for (const auto& [key, transform] : *record.fixed) transforms.append(transform, key.second, true, Time(0));
  for (const TransformRecord::Message& message : record.moving) transforms.append(*message);
  const auto free_frames = freeFrames(*tick.robots);
  result.free_frames.assign(free_frames.begin(), free_frames.end());
  result.all_static = record.all_static;
  result.record_begin = record.begin;
  const BodyList& bodies = snapshot.structure().bodies;
  result.bodies.assign(bodies.begin(), bodies.end());
  listSwitchedOff(bodies, result);
  listCells(snapshot, result);
  result.poses = snapshot.poses();
  result.pairs = snapshot.pairs();
  result.truncated = snapshot.truncated();
  Asker asker(snapshot, narrow_phase, seed);
  for (int i = 0; i < kQueries; ++i) result.queries.push_back(asker.ask(static_cast<RecordedQuery::Kind>(i % 4)));
  return result;
}

}  // namespace hgrid
