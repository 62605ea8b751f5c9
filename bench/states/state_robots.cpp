// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/states/state_robots.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "bench/meshes/mesh_set.h"
#include "bench/states/sphere_cover.h"
#include "hgrid_proximity/adapters/srdf.h"
#include "hgrid_proximity/adapters/urdf.h"

namespace hgrid {
namespace bench {
namespace {

namespace fs = std::filesystem;

std::string textOf(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Reads the STL files of a robot. Each file becomes one mesh, however often the robot uses it.
class StlFiles {
 public:
  explicit StlFiles(fs::path packages) : packages_(std::move(packages)) {}

  std::shared_ptr<const TriangleMesh> operator()(const std::string& uri, const Eigen::Vector3d& scale) {
    const std::string scheme = "package://";
    auto& mesh = meshes_[{uri, {scale.x(), scale.y(), scale.z()}}];
    if (mesh) return mesh;
    auto scaled = std::make_shared<TriangleMesh>(stlMesh(packages_ / uri.substr(scheme.size())));
    for (Eigen::Vector3d& vertex : scaled->vertices) vertex = vertex.cwiseProduct(scale);
    return mesh = scaled;
  }

 private:
  fs::path packages_;
  std::map<std::pair<std::string, std::vector<double>>, std::shared_ptr<const TriangleMesh>> meshes_;
};

}  // namespace

std::vector<StateRobot> stateRobots() {
  const char* told = std::getenv("HGRID_TEST_DATA");
  const fs::path data = told ? told : HGRID_PROJECT_DIR "/../shared/data",
                 robots = data / "example-robot-data" / "robots";
  const struct {
    const char *name, *urdf, *srdf;
    std::vector<std::string> group;
  } files[] = {
      {"Panda", "panda_description/urdf/panda.urdf", "panda_description/srdf/panda.srdf", {}},
      {"UR5", "ur_description/urdf/ur5_robot.urdf", "ur_description/srdf/ur5.srdf", {}},
      {"PR2 arm",
       "pr2_description/urdf/pr2.urdf",
       "pr2_description/srdf/pr2.srdf",
       {"r_shoulder_pan_joint", "r_shoulder_lift_joint", "r_upper_arm_roll_joint", "r_elbow_flex_joint",
        "r_forearm_roll_joint", "r_wrist_flex_joint", "r_wrist_roll_joint"}},
  };
  std::vector<StateRobot> all;
  StlFiles meshes(data);
  for (const auto& file : files) {
    if (!fs::exists(robots / file.urdf)) return {};
    StateRobot robot{file.name, readUrdf(textOf(robots / file.urdf), std::ref(meshes)),
                     readSrdf(textOf(robots / file.srdf)), file.group};
    if (robot.group.empty()) {
      const Kinematics kinematics(robot.model);
      for (const JointVariable& variable : kinematics.variables()) robot.group.push_back(variable.name);
    }
    all.push_back(std::move(robot));
  }
  StateRobot covered = all.front();
  covered.name += " of " + std::to_string(coverBySpheres(covered.model)) + " spheres";
  all.push_back(std::move(covered));
  return all;
}

}  // namespace bench
}  // namespace hgrid
