// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bodies/forward_kinematics.h"
#include "hgrid_proximity/geometry/sphere.h"
#include "hgrid_proximity/queries/query_scope.h"
#include "hgrid_proximity/queries/state_checker.h"
#include "queries/states/four_boxes.h"
#include "queries/states/four_spheres.h"
#include "queries/states/mesh_clearance.h"
#include "queries/states/sphere_cover.h"

namespace hgrid {

/// A body that the joints of the robot move: one of its links, or an obstacle that is attached to a link.
struct RobotBody {
  std::uint32_t body;      ///< index into Structure::bodies
  std::uint32_t own_link;  ///< index into Structure::bodies of a link of the same robot; for a link, the link itself
  std::uint32_t group;     ///< rigid group of the robot
  bool counts;             ///< whether its contacts with all bodies are looked for; false: only with bodies that count
  Pose group_from_body;    ///< pose of the body in the frame of its group
};

/// A shape of such a body.
struct RobotShape {
  std::uint32_t body, shape;  ///< index of the body, and index of the shape among the shapes of the body
  std::uint32_t group;        ///< rigid group of the robot
  Pose group_from_shape;
  const BodyShape* what;      ///< the shape itself; the snapshot keeps it alive
  TiltedBox<float> in_group;  ///< box around the padded shape, in the frame of the group
  bool is_straight;           ///< whether the axes of this box are those of the frame of the group, as in most robots
  SphereCover cover;          ///< spheres that contain the padded shape
  FourSpheres spheres;        ///< spheres inside the padded shape, in the frame of the group
  MeshClearance clearance;    ///< if the shape is a mesh: tells what is far from it
};

/// Shapes of one rigid group that are close together, so that one search of the world finds what is near any of them.
/// RobotBody::counts is the same for the bodies of all of them.
struct ShapeCluster {
  static constexpr std::uint32_t kMost = 16;  ///< largest number of shapes in a cluster

  std::uint32_t first, last;  ///< indices into RobotShapes::shapes(): first .. last - 1
};

/// Two shapes of the robot that must not touch each other. They are indices into RobotShapes::shapes().
struct SelfPair {
  std::uint32_t first, second;
  /// The one whose RobotShape::clearance is asked: the closed mesh, or the larger of two. Structure::kNone if there is
  /// none, or if a shape cannot be measured.
  std::uint32_t mesh;
};

/// Successive self pairs. Usually, the first shape of each pair is in one cluster and the second one in another. If the
/// boxes around both clusters are far apart, no pair has to be tested. One block has the pairs for which this test
/// would take longer than it saves, because their clusters have only few pairs with each other.
struct SelfBlock {
  static constexpr std::size_t kFew = 6;  ///< pairs of clusters with fewer self pairs are not tested as such

  std::uint32_t first_cluster, second_cluster;  ///< indices into RobotShapes::clusters(), or Structure::kNone
  std::uint32_t first, last;                    ///< indices into RobotShapes::selfPairs(): first .. last - 1

  /// Whether the pairs are those of two clusters.
  bool isOfClusters() const { return first_cluster != Structure::kNone; }
};

/// The shapes that move with the joints of one robot, or of several joined robots, and their pairs that the pair filter
/// does not switch off.
class RobotShapes {
 public:
  /// @param robot    name of the robot in the snapshot; empty: `kinematics` are those of joinRobots()
  /// @param options  which bodies count, and the name of the world frame
  /// @throws Refusal unknown_id if the snapshot has no links of this robot, or the robot has no variable of the group
  /// @throws Refusal conflict if its links are not those of `kinematics`
  RobotShapes(const Snapshot& snapshot, const Kinematics& kinematics, const std::string& robot,
              const StateCheckerOptions& options, const QueryScope& scope);

  const std::vector<RobotBody>& bodies() const { return bodies_; }
  /// Returns the shapes. First come the shapes of the bodies that count.
  const std::vector<RobotShape>& shapes() const { return shapes_; }
  /// Returns how many shapes are of bodies that count.
  std::size_t counting() const { return counting_; }
  /// Returns the clusters of the shapes, in the order of the shapes. Each shape is in one of them.
  const std::vector<ShapeCluster>& clusters() const { return clusters_; }
  /// Returns how many clusters have shapes of bodies that count. These clusters come before the others.
  std::size_t countingClusters() const { return counting_clusters_; }
  const std::vector<SelfPair>& selfPairs() const { return self_pairs_; }
  /// Returns the blocks of selfPairs(), in their order. Each pair is in one of them.
  const std::vector<SelfBlock>& selfBlocks() const { return self_blocks_; }
  /// Returns whether a rigid group, or a group that moves with it, has a shape.
  bool carriesShapes(std::size_t group) const { return carries_shapes_[group]; }
  /// Returns whether the joints of the robot move this body.
  bool moves(std::uint32_t body) const { return body < is_own_.size() && is_own_[body]; }

  /// Computes where the shapes are in four states.
  /// @param groups    poses of the rigid groups
  /// @param changes   for each rigid group; null: compute all
  /// @param placed    has one element for each of shapes()
  void place(const std::vector<FourPoses>& groups, const GroupChange* changes, const Eigen::Vector3d& origin,
             std::vector<FourShapes>& placed) const;
  /// Computes the axis-aligned boxes around the shapes of each cluster.
  /// @param bounds  has one element for each of clusters()
  void boundClusters(const std::vector<FourShapes>& placed, std::vector<FourBounds>& bounds) const;

 private:
  void addLinks(const Snapshot& snapshot, const Kinematics& kinematics, const std::string& robot);
  void addAttached(const Snapshot& snapshot, const Kinematics& kinematics, bool joined, const std::string& world_frame);
  void chooseGroup(const Kinematics& kinematics, const std::vector<std::string>& group);
  void chooseRobots(const Snapshot& snapshot, const std::vector<std::string>& robots);
  void addShapes(const Snapshot& snapshot, const QueryScope& scope);
  void addShapesOf(const Snapshot& snapshot, const QueryScope& scope, bool counts);
  void findCarriers(const Kinematics& kinematics);
  void addClusters();
  void addSelfPairs(const PairFilter& filter);
  std::vector<SelfPair> pairsOf(const PairFilter& filter, const ShapeCluster& a, const ShapeCluster& b) const;
  void addSelfBlock(std::uint32_t first_cluster, std::uint32_t second_cluster, const std::vector<SelfPair>& pairs);
  std::uint32_t meshOf(std::uint32_t first, std::uint32_t second) const;

  std::vector<RobotBody> bodies_;
  std::vector<RobotShape> shapes_;  // sorted by rigid group, so that place() reads each of them once
  std::size_t counting_ = 0;
  std::vector<ShapeCluster> clusters_;
  std::size_t counting_clusters_ = 0;
  std::vector<SelfPair> self_pairs_;
  std::vector<SelfBlock> self_blocks_;
  std::vector<bool> is_own_;          // by index of the body
  std::vector<bool> carries_shapes_;  // by index of the rigid group
};

/// Returns spheres inside a padded shape at a pose [m]; nothing if none are known.
std::vector<Sphere> spheresInside(const BodyShape& shape, const Pose& frame_from_shape);

/// Returns a box around a padded shape at a pose.
/// @param relative_rounding  how much the box is grown for the rounding of coordinates to float, as a part of the
/// distance of its center from the origin of the frame
TiltedBox<float> tiltedBoxOf(const BodyShape& shape, const Pose& frame_from_shape, double relative_rounding);

}  // namespace hgrid
