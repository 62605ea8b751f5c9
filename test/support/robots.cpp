// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/support/robots.h"

#include <sys/stat.h>
#include <tinyxml2.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace hgrid {
namespace test {
namespace {

constexpr double kPi = 3.14159265358979323846;

bool isFolder(const std::string& path) {
  struct stat info;
  return stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode);
}

}  // namespace

std::string ownData() { return std::string(HGRID_PROJECT_DIR) + "/test/data"; }

std::string sharedData() {
  const char* told = std::getenv("HGRID_TEST_DATA");
  const std::string folder = told ? told : std::string(HGRID_PROJECT_DIR) + "/../shared/data";
  return isFolder(folder + "/example-robot-data") ? folder : std::string();
}

std::string fileText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

MeshPolicy meshPolicy() {
  MeshPolicy policy;
  policy.reader = HGRID_MESH_READER;
  policy.resources.package_path = [](const std::string& package) -> std::string {
    if (package == "hgrid_test") return ownData();
    if (package == "example-robot-data" && !sharedData().empty()) return sharedData() + "/example-robot-data";
    return "";
  };
  return policy;
}

RobotModel readWith(MeshLoader& loader, const std::string& urdf) {
  return readUrdf(urdf, [&](const std::string& uri, const Eigen::Vector3d& scale) { return loader.load(uri, scale); });
}

RealRobot realRobot(const std::string& name) {
  const std::string robots = sharedData() + "/example-robot-data/robots/";
  if (name == "ur5") {
    return {name, fileText(robots + "ur_description/urdf/ur5_robot.urdf"),
            fileText(robots + "ur_description/srdf/ur5.srdf")};
  }
  if (name == "panda" || name == "pr2") {
    const std::string folder = robots + name + "_description/";
    return {name, fileText(folder + "urdf/" + name + ".urdf"), fileText(folder + "srdf/" + name + ".srdf")};
  }
  throw std::invalid_argument("there is no real robot named " + name + "; use ur5, panda or pr2");
}

RandomStates::RandomStates(const RobotModel& model, const std::string& urdf, unsigned seed)
    : model_(model), random_(seed) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) throw std::runtime_error("URDF is not XML");
  for (const auto* joint = document.RootElement()->FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const auto* tag = joint->FirstChildElement("mimic");
    if (!tag) continue;
    Mimic& mimic = mimics_[joint->Attribute("name")];
    mimic.master = tag->Attribute("joint");
    tag->QueryDoubleAttribute("multiplier", &mimic.multiplier);
    tag->QueryDoubleAttribute("offset", &mimic.offset);
  }
}

std::vector<Pose> RandomStates::next() {
  std::map<std::string, double> drawn;
  for (const RobotLink& link : model_.links) {
    const bool limited = link.lower != 0.0 || link.upper != 0.0;
    const double otherwise = link.joint_kind == JointKind::prismatic ? 0.1 : kPi;
    drawn[link.joint] = limited ? random_.uniform(link.lower, link.upper) : random_.uniform(-otherwise, otherwise);
  }
  std::vector<Pose> root_from_links;
  for (const RobotLink& link : model_.links) {
    const Pose parent_from_link = link.parent_from_joint * motion(link, position(drawn, link.joint));
    root_from_links.push_back(link.parent < 0 ? Pose::Identity() : root_from_links.at(link.parent) * parent_from_link);
  }
  return root_from_links;
}

double RandomStates::position(const std::map<std::string, double>& drawn, const std::string& joint) const {
  const auto found = mimics_.find(joint);
  if (found == mimics_.end()) return drawn.at(joint);
  return found->second.multiplier * position(drawn, found->second.master) + found->second.offset;
}

Pose RandomStates::motion(const RobotLink& link, double position) {
  Pose joint_from_link = Pose::Identity();
  switch (link.joint_kind) {
    case JointKind::fixed:
      break;
    case JointKind::revolute:
      joint_from_link.rotate(Eigen::AngleAxisd(position, link.axis));
      break;
    case JointKind::prismatic:
      joint_from_link.translate(position * link.axis);
      break;
    case JointKind::planar: {
      const Eigen::Vector3d across = link.axis.unitOrthogonal();
      joint_from_link.translate(random_.uniform(-1, 1) * across + random_.uniform(-1, 1) * link.axis.cross(across));
      joint_from_link.rotate(Eigen::AngleAxisd(position, link.axis));
      break;
    }
    case JointKind::floating:
      return uniformPose(random_, 2.0);
  }
  return joint_from_link;
}

Pose uniformPose(Random& random, double far) {
  Eigen::Vector4d xyzw;
  do {
    for (int i = 0; i < 4; ++i) xyzw[i] = random.uniform(-1, 1);
  } while (xyzw.squaredNorm() > 1.0 || xyzw.squaredNorm() < 0.01);
  Pose pose = Pose::Identity();
  for (int i = 0; i < 3; ++i) pose.translation()[i] = random.uniform(-far, far);
  pose.linear() = Eigen::Quaterniond(xyzw.normalized()).toRotationMatrix();
  return pose;
}

std::vector<std::pair<std::uint32_t, BodyId>> addLinks(Scene& scene, const RobotModel& model,
                                                       const std::shared_ptr<const LinkMatrix>& matrix,
                                                       NarrowPhase* narrow_phase, const std::string& robot) {
  std::vector<std::pair<std::uint32_t, BodyId>> bodies;
  for (std::uint32_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].has_collision) continue;
    Body body = linkBody(model, i, robot, matrix);
    if (narrow_phase) {
      for (BodyShape& shape : body.shapes) shape.solid = narrow_phase->solidOf(shape.shape);
    }
    bodies.emplace_back(i, scene.add(std::move(body)));
  }
  return bodies;
}

}  // namespace test
}  // namespace hgrid
