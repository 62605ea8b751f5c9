// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/guard/path_message.h"

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "node/guard/path_message_types.h"
#include "node/time/ros_time.h"

namespace hgrid {
namespace {

using moveit::JointTrajectory;

constexpr const char* kJointTrajectory = "65b4f94a94d1ed67169da35a02f33d3f";
constexpr const char* kDisplayNoetic = "41936b74e168ba754279ae683ce3f121";

/// Makes one path from trajectories that follow one another, and that may have different joints.
class Chain {
 public:
  explicit Chain(const std::vector<const JointTrajectory*>& parts) {
    std::size_t points = 0;
    for (const JointTrajectory* part : parts) {
      addJoints(*part);
      points += part->points.size();
    }
    if (points * row_.size() > kMostPositions) {
      throw Refusal(Code::limit, "it has " + std::to_string(points) + " points of " + std::to_string(row_.size()) +
                                     " joints; at most " + std::to_string(kMostPositions) + " positions are allowed");
    }
    for (const JointTrajectory* part : parts) addPoints(*part);
  }
  RobotPath take() { return std::move(path_); }

 private:
  /// A joint stands at its first position until the first part that has it.
  void addJoints(const JointTrajectory& part) {
    if (part.points.empty()) return;
    checkRow(part, 0);
    std::set<std::string> names;
    for (std::size_t i = 0; i < part.joint_names.size(); ++i) {
      const std::string& joint = part.joint_names[i];
      if (!names.insert(joint).second) {
        throw Refusal(Code::conflict, "it names joint '" + printable(joint) + "' twice; name each joint once");
      }
      if (!columns_.emplace(joint, path_.joints.size()).second) continue;
      path_.joints.push_back(joint);
      row_.push_back(part.points.front().positions[i]);
    }
  }

  void addPoints(const JointTrajectory& part) {
    const Time begin = path_.times.empty() ? Time(0) : path_.times.back();
    for (std::size_t k = 0; k < part.points.size(); ++k) {
      checkRow(part, k);
      for (std::size_t i = 0; i < part.joint_names.size(); ++i) {
        row_[columns_.at(part.joint_names[i])] = part.points[k].positions[i];
      }
      const Time time = timeOfPoint(begin, part.points[k].time_from_start, k);
      if (seconds(time) > kLongestPath) {
        throw Refusal(Code::out_of_range, "the parts of the plan take " + text(seconds(time)) +
                                              " s together; at most " + text(kLongestPath) + " s are allowed");
      }
      // A part may begin when the one before it ends. If it begins elsewhere, the robot must get there.
      const bool begins = k == 0 && !path_.times.empty() && time == path_.times.back();
      path_.times.push_back(begins ? time + Time(1) : time);
      path_.positions.insert(path_.positions.end(), row_.begin(), row_.end());
    }
  }

  static void checkRow(const JointTrajectory& part, std::size_t point) {
    if (part.points[point].positions.size() == part.joint_names.size()) return;
    throw Refusal(Code::out_of_range, "point " + std::to_string(point) + " has " +
                                          std::to_string(part.points[point].positions.size()) +
                                          " positions; it must have one for each of the " +
                                          std::to_string(part.joint_names.size()) + " joints");
  }

  RobotPath path_;                              // its times begin with 0
  std::map<std::string, std::size_t> columns_;  // of the joints
  std::vector<double> row_;                     // positions of all joints at the newest point
};

PathCommand startedAt(Time start, RobotPath path) {
  for (Time& time : path.times) time += start;
  PathCommand command;
  command.path = std::move(path);
  command.start = start;
  return command;
}

PathCommand commandOf(const JointTrajectory& trajectory, Time arrival) {
  const ros::Time stamp = trajectory.header.stamp;
  PathCommand command = startedAt(stamp.isZero() ? arrival : fromRos(stamp), Chain({&trajectory}).take());
  command.is_stamped = !stamp.isZero();
  return command;
}

PathCommand commandOf(const moveit::DisplayTrajectory& display, Time arrival) {
  std::vector<const JointTrajectory*> parts;
  for (const moveit::RobotTrajectory& part : display.trajectory) {
    if (!part.multi_dof_joint_trajectory.points.empty()) {
      throw Refusal(Code::unsupported,
                    "it has points in multi_dof_joint_trajectory; only those of joint_trajectory can be checked");
    }
    parts.push_back(&part.joint_trajectory);
  }
  PathCommand command = startedAt(arrival, Chain(parts).take());
  command.is_plan = true;
  return command;
}

}  // namespace

Time timeOfPoint(Time start, const ros::Duration& from_start, std::size_t index) {
  const double seconds = from_start.toSec();
  if (seconds >= 0.0 && seconds <= kLongestPath) return start + Time(from_start.toNSec());
  throw Refusal(Code::out_of_range, "time_from_start of point " + std::to_string(index) + " is " + text(seconds) +
                                        " s; it must be from 0 to " + text(kLongestPath) + " s");
}

PathCommand readPathMessage(const std::string& bytes, const std::string& md5, Time arrival) {
  if (md5 == kJointTrajectory) return commandOf(readMessage<JointTrajectory>(bytes), arrival);
  if (md5 == kActionGoal)
    return commandOf(readMessage<moveit::FollowJointTrajectoryActionGoal>(bytes).trajectory, arrival);
  if (md5 == kDisplayNoetic) return commandOf(readMessage<moveit::DisplayTrajectory>(bytes), arrival);
  throw Refusal(Code::unsupported,
                "its type has the MD5 " + printable(md5) +
                    "; it must be trajectory_msgs/JointTrajectory, control_msgs/FollowJointTrajectoryActionGoal or "
                    "moveit_msgs/DisplayTrajectory of Noetic");
}

}  // namespace hgrid
