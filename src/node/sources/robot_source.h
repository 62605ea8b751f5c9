// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/robot_model.h"
#include "hgrid_proximity/bodies/self_pairs.h"
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "node/params/params.h"

namespace hgrid {

/// A robot that was read and can be put into the world.
struct LoadedRobot {
  /// Links that move as one, and the tf frame that places them all.
  struct Group {
    std::string frame;
    std::vector<std::pair<std::size_t, Pose>> members;  // index into bodies, and its pose in the frame
  };

  std::string name;
  std::string root_frame;
  std::vector<Body> bodies;  // of the links that have geometry
  std::vector<Group> groups;
  std::vector<std::string> without_collision;  // names of the other links
  std::vector<std::string> uses_visual;        // names of the bodies whose shapes are the link's visual geometry
  std::string gap;                             // why the robot as a whole is incomplete; empty: it is not
  std::string waived_gap;  // why it would be incomplete without ~accept_uncovered, and the waiver's reason; empty:
                           // nothing is waived
  SelfPairs self_pairs;    // how many pairs of its own links its model switches off
  std::vector<std::string> warnings;
};

/// Reads robots from the parameter server: description, meshes, SRDF.
class RobotSource {
 public:
  /// @param node  private node handle: parameters are searched from here upwards
  /// @param cancelled  called again and again during a load; once it returns true, the load is given up
  RobotSource(ros::NodeHandle node, const Params& params, std::shared_ptr<NarrowPhase> narrow_phase,
              std::function<bool()> cancelled);

  /// Slow (it reads files and asks the master); any one thread.
  /// @throws Refusal not_ready while there is no description, busy if it was cancelled, or as readUrdf() and
  /// readSrdf().
  LoadedRobot load(const RobotParams& robot) const;

 private:
  std::string description(const std::string& name) const;

  ros::NodeHandle node_;
  const Params& params_;
  std::shared_ptr<NarrowPhase> narrow_phase_;
  std::function<bool()> cancelled_;
};

}  // namespace hgrid
