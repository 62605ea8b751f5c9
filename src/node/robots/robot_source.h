// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/robot_model.h"
#include "hgrid_proximity/bodies/self_pairs.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"
#include "node/robots/robot_joints.h"
#include "node/robots/robot_spec.h"

namespace hgrid {

struct ReadDescription;

/// A robot that was read and can be put into the world.
struct LoadedRobot {
  /// Links that move together, and the tf frame that places all of them.
  struct Group {
    std::string frame;
    std::vector<std::pair<std::size_t, Pose>> members;  // index into `bodies`, and pose of that body in the frame
  };

  /// The place of a link in its group.
  struct Seat {
    std::size_t group = 0;  // index into `groups`
    Pose frame_from_link = Pose::Identity();
  };

  std::string name;
  std::string root_frame;
  std::vector<Body> bodies;  // one body for each link that has geometry
  std::vector<Group> groups;
  std::set<std::string, std::less<>> free_frames;  // frames of the links that a planar or floating joint moves
  /// Frames of links that robot_state_publisher may never send, and why, as the end of a sentence.
  std::map<std::string, std::string> unsent_frames;
  std::map<std::string, Seat> links;           // all links, by full name (robot/link)
  std::vector<std::string> without_collision;  // names of the other links
  std::vector<std::string> uses_visual;        // names of the bodies whose shapes are the link's visual geometry
  std::string gap;                             // why the robot as a whole is incomplete; empty: it is complete
  std::string waived_gap;  // why the robot would be incomplete without ~accept_uncovered, and the reasons of the
                           // waivers; empty: nothing is waived
  SelfPairs self_pairs;    // how many pairs of the robot's own links the model switches off
  std::vector<std::string> warnings;
  std::shared_ptr<const ReadDescription> read;  // the description that it was made from
};

/// A description that was read. Robots that are equal share it.
struct ReadDescription {
  RobotModel model;  // its shapes are prepared for exact distances
  std::shared_ptr<const LinkMatrix> links;
  SelfPairs self_pairs;
  std::vector<std::string> warnings;
  std::vector<bool> use_visual;  // for each link: whether ~use_visual names it
  std::shared_ptr<const RobotJoints> joints;
};

/// Returns the largest speed [m/s] that is expected of points that move with a link and are at most `reach` [m] from
/// its origin: what the joints above it allow. If one of these has no limit, or if the root frame of the robot is not
/// the world frame, so that the whole robot may move, that adds ~default_max_speed.
double expectedSpeed(const LoadedRobot& robot, const RobotModel& model, std::uint32_t link, double reach,
                     const Params& params);

/// Sets max_speed and speed_bound of a link. Its shapes must have their paddings.
void setSpeeds(const LoadedRobot& robot, const RobotModel& model, const Params& params, Body& link);

/// Reads robots: their descriptions (URDF and SRDF) from the parameter server, and their meshes.
class RobotSource {
 public:
  /// @param node       private node handle; parameters are searched from its namespace upwards
  /// @param cancelled  called repeatedly during a load; once it returns true, the load is canceled
  RobotSource(ros::NodeHandle node, const Params& params, std::shared_ptr<NarrowPhase> narrow_phase,
              std::function<bool()> cancelled);

  /// Returns the description of a robot. Asks the ROS master, unless a request contained the description.
  /// @throws Refusal not_ready while there is no description
  RobotDescription describe(const RobotSpec& robot) const;
  /// Reads a description. This is slow, because it reads files. Only one thread at a time may call this.
  /// @throws Refusal busy if the load was canceled, or as readUrdf() and readSrdf()
  std::shared_ptr<const ReadDescription> read(const RobotSpec& robot, const RobotDescription& description) const;
  /// Returns whether read() would return the same for a robot of this name, as far as parameters decide it.
  bool fits(const ReadDescription& read, const std::string& robot) const;
  /// Makes a robot from its description.
  LoadedRobot make(const RobotSpec& robot, const std::shared_ptr<const ReadDescription>& read) const;

 private:
  std::string parameter(const std::string& name) const;

  ros::NodeHandle node_;
  const Params& params_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  std::function<bool()> cancelled_;
};

}  // namespace hgrid
