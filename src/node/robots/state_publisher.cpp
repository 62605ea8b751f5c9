// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/robots/state_publisher.h"

#include "hgrid_proximity/refusal.h"
#include "node/text/frame_names.h"

namespace hgrid {

std::set<std::string, std::less<>> freeFrames(const RobotModel& model, const std::string& tf_prefix) {
  std::set<std::string, std::less<>> frames;
  for (const RobotLink& link : model.links) {
    const bool is_free = link.joint_kind == JointKind::planar || link.joint_kind == JointKind::floating;
    if (link.parent >= 0 && is_free) frames.insert(prefixed(tf_prefix, link.name));
  }
  return frames;
}

std::map<std::string, std::string> unsentFrames(const RobotModel& model, const std::string& tf_prefix) {
  std::set<std::string> known;                        // joints whose positions robot_state_publisher has
  std::map<std::string, const RobotLink*> followers;  // by name of the joint
  for (const RobotLink& link : model.links) {
    if (link.parent < 0) continue;
    if (link.mimic.empty()) {
      known.insert(link.joint);
    } else {
      followers[link.joint] = &link;
    }
  }
  std::map<std::string, std::string> unsent;
  for (const auto& [joint, link] : followers) {
    if (known.count(link->mimic) != 0) {
      known.insert(joint);
    } else if (followers.count(link->mimic) != 0) {
      unsent[prefixed(tf_prefix, link->name)] =
          "joint '" + printable(joint) + "' follows '" + printable(link->mimic) +
          "', which itself follows a joint, and robot_state_publisher (1.15.2) computes such joints only in the order "
          "of their names; let '" +
          printable(joint) + "' follow the joint at the end of the chain";
    }
  }
  return unsent;
}

}  // namespace hgrid
