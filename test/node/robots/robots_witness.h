// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace tinyxml2 {
class XMLElement;
}

namespace hgrid {
namespace test {

// The witness is an independent reference for the robots test. It reads URDF, SRDF and STL itself, and has kinematics
// and boxes of its own. It uses no code of the package.

struct WitnessBox {
  Eigen::Vector3d min, max;  // [m]
};

/// Returns the box with each face moved outward by `by` [m]; inward if negative.
WitnessBox grown(const WitnessBox& box, double by);
/// Returns the distance of two boxes [m]; 0 if they overlap.
double gap(const WitnessBox& a, const WitnessBox& b);
/// Returns the distance of a point from a box [m]; 0 if the point is inside.
double gap(const WitnessBox& box, const Eigen::Vector3d& point);
/// Returns the length of the segment up to its first point within `radius` of the box [m]; infinite if there is none.
double firstTouch(const WitnessBox& box, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);

/// A body of the witness: one box for each shape.
using WitnessBody = std::vector<WitnessBox>;

/// A robot that the witness has read from its URDF and SRDF.
class WitnessRobot {
 public:
  struct Joint {
    std::string name, type, parent, child, mimics;  // mimics: the joint that this joint follows; empty: none
    double multiplier = 1.0, offset = 0.0;
    double lower = 0.0, upper = 0.0;  // [rad] or [m]; -pi .. pi for a continuous joint
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  };
  using Positions = std::map<std::string, double>;  // [rad or m] by joint; without mimic joints
  using Poses = std::map<std::string, Eigen::Isometry3d>;

  /// @param file_of  function that returns the path of the file for the URI of a mesh
  /// @throws std::runtime_error if the URDF contains something that the witness cannot read
  WitnessRobot(const std::string& urdf, const std::string& srdf,
               const std::function<std::string(const std::string& uri)>& file_of);

  const std::string& root() const { return root_; }
  /// Returns the joints that can move and mimic no other joint.
  std::vector<Joint> driven() const;
  /// Returns the pose of each link in the world frame: world_from_link by name of the link.
  Poses posesAt(const Positions& positions, const Eigen::Isometry3d& world_from_root) const;
  /// Returns the boxes of the shapes in the world frame, by link. Leaves out links without shapes.
  std::map<std::string, WitnessBody> bodiesAt(const Poses& world_from_links) const;
  std::size_t shapeCount() const;
  /// Returns whether two links may touch: they are in one rigid group or adjacent, or the SRDF allows it.
  bool mayTouch(const std::string& first, const std::string& second) const;

 private:
  using Points = std::vector<Eigen::Vector3d>;

  double position(const Joint& joint, const Positions& positions) const;
  std::string rigidGroup(std::string link) const;
  void readJoint(const tinyxml2::XMLElement& element);
  bool isAdjacent(const std::string& upper, std::string group) const;
  bool isWayBare(const std::string& first, const std::string& second) const;

  std::string root_;
  std::map<std::string, std::vector<Points>> shapes_;  // points that include all corners of the hull, by link
  std::map<std::string, Joint> joints_;                // by child link
  std::set<std::pair<std::string, std::string>> may_touch_;
};

}  // namespace test
}  // namespace hgrid
