// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/robots/robot_entry.h"

#include "node/text/frame_names.h"

namespace hgrid {

const LoadedRobot* findLink(const RobotEntries& robots, const std::string& link) {
  const auto robot = robots.find(link.substr(0, link.find('/')));
  if (robot == robots.end() || !robot->second.inWorld()) return nullptr;
  const LoadedRobot& model = *robot->second.model;
  return model.links.count(link) != 0 ? &model : nullptr;
}

std::vector<std::string> linksNamed(const RobotEntries& robots, const std::string& name) {
  std::vector<std::string> links;
  for (const auto& [robot, entry] : robots) {
    const std::string link = robot + "/" + name;
    if (entry.inWorld() && entry.model->links.count(link) != 0) links.push_back(link);
  }
  return links;
}

std::set<std::string, std::less<>> freeFrames(const RobotEntries& robots) {
  std::set<std::string, std::less<>> frames;
  for (const auto& [name, robot] : robots) {
    if (robot.inWorld()) frames.insert(robot.model->free_frames.begin(), robot.model->free_frames.end());
  }
  return frames;
}

std::vector<std::string> linksAt(const RobotEntries& robots, const std::string& frame) {
  std::vector<std::string> links;
  for (const auto& [robot, entry] : robots) {
    if (!entry.inWorld()) continue;
    const std::string prefix = prefixed(entry.spec->params.tf_prefix, "");
    if (frame.compare(0, prefix.size(), prefix) != 0) continue;
    const std::string link = robot + "/" + frame.substr(prefix.size());
    if (entry.model->links.count(link) != 0) links.push_back(link);
  }
  return links;
}

}  // namespace hgrid
