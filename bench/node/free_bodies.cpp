// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <cmath>
#include <random>

#include "workload.h"

namespace hgrid {
namespace bench {
namespace {

constexpr double kEdge = 0.2;  // [m] average edge of a body

XmlRpc::XmlRpcValue obstacle(const std::string& name, std::mt19937& random) {
  std::uniform_real_distribution<double> edge(0.8 * kEdge, 1.2 * kEdge);
  XmlRpc::XmlRpcValue value;
  value["name"] = name;
  value["frame"] = name;
  XmlRpc::XmlRpcValue& shape = value["shapes"][0];
  shape["type"] = "box";
  for (int axis = 0; axis < 3; ++axis) shape["size"][axis] = edge(random);
  return value;
}

void moveBody(double t, double phase, const geometry_msgs::Vector3& home, geometry_msgs::Transform& transform) {
  transform.translation.x = home.x + 0.3 * std::sin(0.9 * t + phase);
  transform.translation.y = home.y + 0.3 * std::sin(0.7 * t + 2.0 * phase);
  transform.translation.z = home.z + 0.3 * std::sin(0.8 * t + 3.0 * phase);
  transform.rotation.z = std::sin(0.5 * t + phase);
  transform.rotation.w = std::cos(0.5 * t + phase);
}

}  // namespace

Workload freeBodies(std::size_t count, double rate) { return freeBodies(count, count, rate); }

Workload freeBodiesByPoses(std::size_t count, double rate) {
  Workload workload = freeBodies(count, rate);
  workload.title = std::to_string(count) + " obstacles moved by ~poses";
  workload.by_poses = true;
  for (int i = 0; i < static_cast<int>(count); ++i) workload.params["obstacles"][i]["frame"] = "~poses";
  return workload;
}

Workload freeBodies(std::size_t count, std::size_t moving, double rate) {
  Workload workload;
  workload.title =
      std::to_string(count) + (moving < count ? " bodies, of which " + std::to_string(moving) + " fly freely"
                                              : std::string(" free-flying bodies"));
  workload.bodies = count;
  workload.rate = rate;
  workload.params["rate"] = rate;
  workload.params["heartbeat"] = std::min(20.0, 0.5 * rate);  // at ~rate, ticks would not wait for the data
  workload.params["valid_for"] = 1.0;                         // longer than the pauses between heartbeats
  workload.params["limits"]["max_frames"] = static_cast<int>(count + 10);
  workload.params["accept_uncovered"][0]["pattern"] = "robot/*";  // the robot has no shapes
  workload.params["accept_uncovered"][0]["reason"] = "it has no geometry";
  workload.descriptions["robot_description"] = "<robot name='nobody'><link name='world'/></robot>";
  const double side = kEdge * 2.0 * std::cbrt(4.0 * static_cast<double>(count));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(0.0, side), any(0.0, 6.283);
  std::vector<geometry_msgs::Vector3> homes(count);
  std::vector<double> phases(count);
  tf2_msgs::TFMessage message;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "body_" + std::to_string(i);
    workload.params["obstacles"][static_cast<int>(i)] = obstacle(name, random);
    homes[i].x = place(random);
    homes[i].y = place(random);
    homes[i].z = place(random);
    phases[i] = any(random);
    if (i >= moving) {  // an obstacle that is fixed in the world
      XmlRpc::XmlRpcValue& fixed = workload.params["obstacles"][static_cast<int>(i)];
      fixed["frame"] = "";
      fixed["pose"]["xyz"][0] = homes[i].x;
      fixed["pose"]["xyz"][1] = homes[i].y;
      fixed["pose"]["xyz"][2] = homes[i].z;
      continue;
    }
    message.transforms.emplace_back();
    message.transforms.back().header.frame_id = "world";
    message.transforms.back().child_frame_id = name;
  }
  workload.move = [message, homes, phases](double t) mutable {
    for (std::size_t i = 0; i < message.transforms.size(); ++i)
      moveBody(t, phases[i], homes[i], message.transforms[i].transform);
    return std::vector<tf2_msgs::TFMessage>{message};
  };
  return workload;
}

}  // namespace bench
}  // namespace hgrid
