// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/joint_groups.h"

#include <algorithm>
#include <map>
#include <set>

#include "hgrid_proximity/bodies/kinematics.h"

namespace hgrid {
namespace {

/// Collects the joints of a group, and of the groups in it.
class Collector {
 public:
  Collector(const JointGroups& groups, const RobotModel& model)
      : groups_(groups), model_(model), in_group_(model.links.size(), false) {
    for (const JointGroup& group : groups.groups) by_name_.emplace(group.name, &group);
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      link_named_.emplace(model.links[i].name, i);
      if (model.links[i].parent >= 0) link_of_joint_.emplace(model.links[i].joint, i);
    }
  }

  void add(const std::string& name) {
    std::vector<std::string> open{name};
    std::set<std::string> seen{name};
    while (!open.empty()) {
      const JointGroup& group = find(open.back());
      open.pop_back();
      for (const std::string& joint : group.joints) addJoint(group.name, joint);
      for (const std::string& link : group.links) addJointTo(indexOf(group.name, link));
      for (const JointGroup::Chain& chain : group.chains) addChain(group.name, chain);
      for (const std::string& inner : group.groups) {
        if (seen.insert(inner).second) open.push_back(inner);
      }
    }
  }

  bool movesRobot() const { return moves_robot_; }
  /// Returns the variables of the joints that were added.
  std::vector<std::string> variables() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < model_.links.size(); ++i) {
      if (!in_group_[i] || !model_.links[i].mimic.empty()) continue;
      std::vector<JointVariable> own;
      appendVariables(model_.links[i], own);
      for (const JointVariable& variable : own) names.push_back(variable.name);
    }
    return names;
  }

 private:
  const JointGroup& find(const std::string& name) const {
    constexpr std::size_t kMostListed = 10;
    const auto found = by_name_.find(name);
    if (found != by_name_.end()) return *found->second;
    std::string known;
    for (std::size_t i = 0; i < std::min(groups_.groups.size(), kMostListed); ++i) {
      known += (known.empty() ? "" : ", ") + printable(groups_.groups[i].name);
    }
    if (groups_.groups.size() > kMostListed) {
      known += " and " + std::to_string(groups_.groups.size() - kMostListed) + " more";
    }
    throw Refusal(Code::unknown_id, "the SRDF has no group '" + printable(name) + "'; " +
                                        (known.empty() ? "it has no groups" : "its groups are " + known));
  }
  std::size_t indexOf(const std::string& group, const std::string& link) const {
    const auto found = link_named_.find(link);
    if (found != link_named_.end()) return found->second;
    throw Refusal(Code::unknown_id, "group '" + printable(group) + "' of the SRDF has the link '" + printable(link) +
                                        "', which the robot does not have");
  }
  /// Adds the joint between a link and its parent. The joint of the root link is the virtual one.
  void addJointTo(std::size_t link) {
    in_group_[link] = true;
    if (model_.links[link].parent >= 0) return;
    for (const VirtualJoint& joint : groups_.virtual_joints) moves_robot_ |= joint.kind != JointKind::fixed;
  }
  void addJoint(const std::string& group, const std::string& name) {
    if (const VirtualJoint* joint = groups_.findVirtual(name)) {
      moves_robot_ |= joint->kind != JointKind::fixed;
      return;
    }
    const auto found = link_of_joint_.find(name);
    if (found != link_of_joint_.end()) {
      in_group_[found->second] = true;
      return;
    }
    throw Refusal(Code::unknown_id, "group '" + printable(group) + "' of the SRDF has the joint '" + printable(name) +
                                        "', which the robot does not have");
  }
  void addChain(const std::string& group, const JointGroup::Chain& chain) {
    std::vector<std::size_t> from_base = pathToRoot(indexOf(group, chain.base));
    std::vector<std::size_t> from_tip = pathToRoot(indexOf(group, chain.tip));
    while (!from_base.empty() && !from_tip.empty() && from_base.back() == from_tip.back()) {
      from_base.pop_back();
      from_tip.pop_back();
    }
    for (const std::size_t link : from_base) addJointTo(link);
    for (const std::size_t link : from_tip) addJointTo(link);
  }
  /// Returns a link and all links between it and the root, the root last.
  std::vector<std::size_t> pathToRoot(std::size_t link) const {
    std::vector<std::size_t> path{link};
    while (model_.links[path.back()].parent >= 0) {
      path.push_back(static_cast<std::size_t>(model_.links[path.back()].parent));
    }
    return path;
  }

  const JointGroups& groups_;
  const RobotModel& model_;
  std::map<std::string, const JointGroup*> by_name_;
  std::map<std::string, std::size_t> link_named_, link_of_joint_;  // by name: index of the link
  std::vector<bool> in_group_;  // for each link: whether the joint to its parent belongs to the group
  bool moves_robot_ = false;
};

}  // namespace

const VirtualJoint* JointGroups::findVirtual(const std::string& name) const {
  const auto found = std::find_if(virtual_joints.begin(), virtual_joints.end(),
                                  [&](const VirtualJoint& joint) { return joint.name == name; });
  return found == virtual_joints.end() ? nullptr : &*found;
}

std::optional<std::vector<std::string>> variablesOf(const std::string& group, const JointGroups& groups,
                                                    const RobotModel& model) {
  Collector collector(groups, model);
  collector.add(group);
  if (collector.movesRobot()) return std::nullopt;
  std::vector<std::string> variables = collector.variables();
  if (!variables.empty()) return variables;
  throw Refusal(Code::unsupported,
                "group '" + printable(group) + "' of the SRDF has no joint that can move; it must have one");
}

}  // namespace hgrid
