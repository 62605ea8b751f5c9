// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>
#include <random>
#include <sstream>

#include "workload.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kSpacing = 0.12;  // [m] distance between the joints of a chain
constexpr double kApart = 1.5;     // [m] distance between the bases of robots

std::string robotName(std::size_t robot) { return "robot_" + std::to_string(robot); }
std::string linkName(std::size_t link) { return "link_" + std::to_string(link); }

std::string geometryOf(std::size_t link, std::mt19937& random) {
  std::uniform_real_distribution<double> half(0.04, 0.08);
  std::ostringstream xml;
  switch (link % 3) {
    case 0:
      xml << "<box size='" << 2 * half(random) << " " << 2 * half(random) << " " << 2 * half(random) << "'/>";
      break;
    case 1:
      xml << "<cylinder length='" << 2 * half(random) << "' radius='" << half(random) << "'/>";
      break;
    default:
      xml << "<sphere radius='" << half(random) << "'/>";
  }
  return xml.str();
}

std::string urdfOf(std::size_t robot, std::size_t links) {
  std::mt19937 random(static_cast<unsigned>(robot + 1));
  std::ostringstream xml;
  xml << "<robot name='" << robotName(robot) << "'>";
  for (std::size_t link = 0; link < links; ++link) {
    xml << "<link name='" << linkName(link) << "'><collision><origin xyz='0 0 " << 0.5 * kSpacing << "'/><geometry>"
        << geometryOf(link, random) << "</geometry></collision></link>";
    if (link == 0) continue;
    xml << "<joint name='joint_" << link << "' type='revolute'><parent link='" << linkName(link - 1)
        << "'/><child link='" << linkName(link) << "'/><origin xyz='0 0 " << kSpacing << "'/><axis xyz='"
        << (link % 2 == 0 ? "1 0 0" : "0 1 0") << "'/><limit lower='-1' upper='1' effort='1' velocity='2'/></joint>";
  }
  xml << "</robot>";
  return xml.str();
}

geometry_msgs::TransformStamped frame(const std::string& parent, const std::string& child) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.rotation.w = 1.0;
  return transform;
}

tf2_msgs::TFMessage framesOf(std::size_t robot, std::size_t links) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(frame("world", robotName(robot) + "/" + linkName(0)));
  for (std::size_t link = 1; link < links; ++link) {
    message.transforms.push_back(
        frame(robotName(robot) + "/" + linkName(link - 1), robotName(robot) + "/" + linkName(link)));
    message.transforms.back().transform.translation.z = kSpacing;
  }
  return message;
}

void moveRobot(std::size_t robot, std::size_t side, double t, tf2_msgs::TFMessage& message) {
  const auto phase = static_cast<double>(robot);
  geometry_msgs::Transform& base = message.transforms.front().transform;
  base.translation.x = kApart * static_cast<double>(robot % side) + 0.4 * std::sin(0.5 * t + phase);
  base.translation.y = kApart * static_cast<double>(robot / side) + 0.4 * std::cos(0.4 * t + phase);
  base.rotation.z = std::sin(0.1 * t + phase);
  base.rotation.w = std::cos(0.1 * t + phase);
  for (std::size_t link = 1; link < message.transforms.size(); ++link) {
    const double half_angle = 0.15 * std::sin(t + 0.7 * static_cast<double>(link) + phase);
    geometry_msgs::Quaternion& turn = message.transforms[link].transform.rotation;
    (link % 2 == 0 ? turn.x : turn.y) = std::sin(half_angle);
    turn.w = std::cos(half_angle);
  }
}

}  // namespace

Workload robots(std::size_t count, std::size_t links, double rate) {
  Workload workload;
  workload.title = std::to_string(count) + " robots of " + std::to_string(links) + " links";
  workload.bodies = count * links;
  workload.rate = rate;
  workload.params["rate"] = rate;
  workload.params["world_frame"] = "world";
  std::vector<tf2_msgs::TFMessage> messages;
  for (std::size_t robot = 0; robot < count; ++robot) {
    const std::string name = robotName(robot), description = name + "_description";
    workload.descriptions[description] = urdfOf(robot, links);
    XmlRpc::XmlRpcValue& entry = workload.params["robots"][static_cast<int>(robot)];
    entry["name"] = name;
    entry["description"] = description;
    entry["tf_prefix"] = name;
    messages.push_back(framesOf(robot, links));
  }
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  workload.move = [messages, side](double t) mutable {
    for (std::size_t robot = 0; robot < messages.size(); ++robot) moveRobot(robot, side, t, messages[robot]);
    return messages;
  };
  return workload;
}

}  // namespace bench
}  // namespace hgrid
