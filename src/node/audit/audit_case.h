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
  std::uint32_t body = 0;     // index of the map or cloud in AuditCase::bodies
  double finest_edge = 0.0;   // [m]
  std::vector<Voxel> voxels;  // all occupied cells
};

/// A query and the answer of the node.
struct RecordedQuery {
  enum class Kind { sphere = 0, segment = 1, box = 2, nearest = 3 };
  struct Hit {
    std::uint32_t body = 0;  // index in AuditCase::bodies
    double distance = 0.0;   // [m]
  };
  Kind kind = Kind::sphere;
  /// [m, world frame] The ends of a segment. Other kinds of query use only `from`: it is their center or point.
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  double radius = 0.0;                                         // [m]
  OrientedBox box{Pose::Identity(), Eigen::Vector3d::Zero()};  // used only if the kind is box
  Verdict verdict = Verdict::unknown;
  std::vector<Hit> hits;  // all hits of the answer
};

/// The input of one audit: the data that the node received, and the results of one tick. case_file.h writes it to a
/// file and reads it again.
struct AuditCase {
  std::string config_hash;  // hash of the parameters of the node
  std::uint64_t epoch = 0, sequence = 0;
  Time stamp{0}, made{0};  // [ROS time] the time of the tick, and when the node made the tick
  std::string world_frame;

  // The parameters that poses and pairs depend on. doc/parameters.md explains them. `growth_after` is ~stale_after.
  double margin = 0.0, growth_cap = 0.0, growth_after = 0.0, max_sync_wait = 0.0, max_future = 0.0, world_limit = 0.0;
  double origin_distance = 0.0;  // [m] largest absolute coordinate of ~origin
  double horizon = 0.0;          // [s]
  std::vector<Room> rooms;
  std::vector<Portal> doors;
  PairKinds pair_kinds;
  std::vector<PairMargin> pair_margins;
  std::vector<PairRule> rules;  // all rules of the pair filter

  // What the node received.
  std::vector<std::string> names;             // names of all frames and publishers; no name is there twice
  std::vector<RecordedTransform> transforms;  // first those of /tf_static, then those of /tf in the order of reading
  std::vector<std::string> free_frames;       // frames that planar and floating joints move; sorted
  bool all_static = true;                     // false: some transforms of /tf_static are missing
  Time record_begin{0};                       // [ROS time] transforms of /tf from this time or earlier may be missing
  std::vector<Body> bodies;                   // sorted by name; an audit does not use Body::links and BodyShape::solid
  /// Indices of two links in `bodies` whose pair the model of their robot switches off. Sorted.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> switched_off;
  std::vector<RecordedCells> cells;  // of all maps and clouds that are not too large for an audit

  // What the node computed in the tick.
  std::vector<BodyPose> poses;  // for each of `bodies`: its pose
  std::vector<NearPair> pairs;
  bool truncated = false;  // whether `pairs` lacks some pairs, see Snapshot::truncated()
  std::vector<RecordedQuery> queries;
};

/// Collects the data for the audit of one tick. Also makes some random queries about the tick and stores the answers.
/// @param tick  a tick with a snapshot
/// @param seed  selects the random queries
AuditCase caseOf(const Tick& tick, const TransformRecord::Content& record, std::uint64_t seed,
                 const NarrowPhase& narrow_phase);

}  // namespace hgrid
