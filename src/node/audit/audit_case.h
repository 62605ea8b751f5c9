// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/geometry/voxel.h"
#include "hgrid_proximity/pairs/near_pair.h"
#include "hgrid_proximity/queries/query.h"
#include "node/audit/transform_record.h"
#include "node/params/params.h"
#include "node/tick/tick.h"

namespace hgrid {

/// One transform as it was received.
struct RecordedTransform {
  std::uint32_t parent = 0, child = 0, publisher = 0;  // indices into AuditCase::names
  bool is_static = false;
  Time stamp{0}, received{0};          // ROS time
  std::array<double, 7> numbers = {};  // translation x, y, z [m], then the quaternion x, y, z, w
};

/// The occupied cells of a map or a cloud.
struct RecordedCells {
  std::uint32_t body = 0;
  double finest_edge = 0.0;   // [m]
  std::vector<Voxel> voxels;  // all occupied cells
};

/// A query and what the node answered.
struct RecordedQuery {
  enum class Kind { sphere = 0, segment = 1, box = 2, nearest = 3 };
  struct Hit {
    std::uint32_t body = 0;
    double distance = 0.0;  // [m]
  };
  Kind kind = Kind::sphere;
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();  // [m, world] `to` only for a segment
  double radius = 0.0;                                                           // [m]
  OrientedBox box{Pose::Identity(), Eigen::Vector3d::Zero()};                    // only for a box
  Verdict verdict = Verdict::unknown;
  std::vector<Hit> hits;  // all hits
};

/// Everything that an audit compares: what the node received, and what it made of it in one tick. It is a plain value,
/// so that a file can hold it (see case_file.h).
struct AuditCase {
  std::string config_hash;
  std::uint64_t epoch = 0, sequence = 0;
  Time stamp{0}, made{0};  // ROS time of the tick, and when it was made
  std::string world_frame;

  // The settings that decide about poses and pairs; see doc/parameters.md for their meaning.
  double margin = 0.0, growth_cap = 0.0, growth_after = 0.0, max_sync_wait = 0.0, max_future = 0.0, world_limit = 0.0;
  double origin_distance = 0.0;  // [m] largest absolute coordinate of ~origin
  PairKinds pair_kinds;
  std::vector<PairMargin> pair_margins;
  std::vector<PairRule> rules;  // the rules in force

  // What the node received.
  std::vector<std::string> names;             // of frames and publishers, each once
  std::vector<RecordedTransform> transforms;  // in the order in which they were read; those of /tf_static first
  bool all_static = true;                     // see TransformRecord::Content
  Time record_begin{0};                       // [ROS time] see TransformRecord::Content
  std::vector<Body> bodies;                   // sorted by name; `links` and `solid` are not used
  std::vector<std::pair<std::uint32_t, std::uint32_t>> switched_off;  // pairs of links, by the robots' models; sorted
  std::vector<RecordedCells> cells;

  // What the node made of it.
  std::vector<BodyPose> poses;  // of the bodies, in the same order
  std::vector<NearPair> pairs;
  bool truncated = false;
  std::vector<RecordedQuery> queries;
};

/// Collects the case of one tick, and asks it some random queries.
/// @param tick  a tick with a snapshot
/// @param seed  decides about the queries
AuditCase caseOf(const Tick& tick, const TransformRecord::Content& record, const Params& params,
                 std::uint64_t config_hash, std::uint64_t seed, const NarrowPhase& narrow_phase);

}  // namespace hgrid
