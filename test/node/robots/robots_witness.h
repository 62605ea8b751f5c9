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

/// The independent witness of the robots test: its own reading of URDF, SRDF and STL, its own kinematics and boxes.
/// Of the product it uses nothing.

struct WitnessBox {
  Eigen::Vector3d min, max;  // [m]
};

/// The box with every face moved outward by `by` [m]; inward if negative.
WitnessBox grown(const WitnessBox& box, double by);
double gap(const WitnessBox& a, const WitnessBox& b);
double gap(const WitnessBox& box, const Eigen::Vector3d& point);
/// [m] along the segment to its first point within `radius` of the box; infinite if there is none.
double firstTouch(const WitnessBox& box, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius);

/// One body: a box for each of its shapes.
using WitnessBody = std::vector<WitnessBox>;

/// A robot as its URDF and SRDF tell it.
class WitnessRobot {
 public:
  struct Joint {
    std::string name, type, parent, child, mimics;  // mimics: name of the joint that this one follows, or empty
    double multiplier = 1.0, offset = 0.0;
    double lower = 0.0, upper = 0.0;  // [rad] or [m]; -pi .. pi for a continuous joint
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  };
  using Positions = std::map<std::string, double>;  // by joint, without those that follow another
  using Poses = std::map<std::string, Eigen::Isometry3d>;

  /// @param file_of  path of the file that a mesh's URI means
  /// @throws std::runtime_error on what the witness does not know
  WitnessRobot(const std::string& urdf, const std::string& srdf,
               const std::function<std::string(const std::string& uri)>& file_of);

  const std::string& root() const { return root_; }
  /// Joints that move and follow no other.
  std::vector<Joint> driven() const;
  /// world_from_link of every link.
  Poses posesAt(const Positions& positions, const Eigen::Isometry3d& world_from_root) const;
  /// Boxes of the links that have shapes, in the world, by link.
  std::map<std::string, WitnessBody> bodiesAt(const Poses& world_from_links) const;
  std::size_t shapeCount() const;
  /// Whether two links may touch: they belong to one rigid group or to adjacent groups, or the SRDF says so.
  bool mayTouch(const std::string& first, const std::string& second) const;

 private:
  using Points = std::vector<Eigen::Vector3d>;

  double position(const Joint& joint, const Positions& positions) const;
  std::string rigidGroup(std::string link) const;
  void readJoint(const tinyxml2::XMLElement& element);
  bool isAdjacent(const std::string& upper, std::string group) const;

  std::string root_;
  std::map<std::string, std::vector<Points>> shapes_;  // by link, each as the corners of its hull or more
  std::map<std::string, Joint> joints_;                // by child link
  std::set<std::pair<std::string, std::string>> may_touch_;
};

}  // namespace test
}  // namespace hgrid
