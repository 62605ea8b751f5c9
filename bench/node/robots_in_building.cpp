// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <string>
#include <utility>

#include "workload.h"

namespace hgrid {
namespace bench {
namespace {

/// Returns the pose of the building. The robots of robots() are in the middle of its first room, on the floor.
geometry_msgs::TransformStamped frameOfMap() {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = "world";
  transform.child_frame_id = "map";
  transform.transform.translation.x = transform.transform.translation.y = -2.4;
  transform.transform.translation.z = -0.1;
  transform.transform.rotation.w = 1.0;
  return transform;
}

}  // namespace

Workload inBuilding(Workload workload, const std::string& topic) {
  ++workload.bodies;
  XmlRpc::XmlRpcValue& map = workload.params["maps"][0];
  map["name"] = "building";
  map["topic"] = topic;
  tf2_msgs::TFMessage frame;
  frame.transforms.push_back(frameOfMap());
  workload.move = [move = std::move(workload.move), frame](double t) {
    std::vector<tf2_msgs::TFMessage> messages = move(t);
    messages.push_back(frame);
    return messages;
  };
  return workload;
}

Workload robotsInBuilding(std::size_t count, std::size_t links, double rate, const std::string& topic) {
  Workload workload = robots(count, links, rate);
  workload.title += " in a building of 1,000,000 leaves";
  return inBuilding(std::move(workload), topic);
}

}  // namespace bench
}  // namespace hgrid
