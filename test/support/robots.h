// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hgrid_proximity/adapters/mesh.h"
#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/world/scene.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// The project's own small robots and meshes; known to meshPolicy() as the package hgrid_test.
std::string ownData();
/// Real robots: HGRID_TEST_DATA, else ../shared/data beside the project; empty if neither is there.
std::string sharedData();

/// What follows in a test needs sharedData().
#define HGRID_NEEDS_SHARED_DATA()        \
  if (hgrid::test::sharedData().empty()) \
  GTEST_SKIP() << "no robots: HGRID_TEST_DATA is not set, ../shared/data not there"

/// All bytes of a file. @throws std::runtime_error if it cannot be read.
std::string fileText(const std::string& path);

/// Reads with the helper of this build; knows the packages hgrid_test and example-robot-data.
MeshPolicy meshPolicy();

/// The robot of a URDF's text, its meshes read by `loader`.
RobotModel readWith(MeshLoader& loader, const std::string& urdf);

/// One of the real robots.
struct RealRobot {
  std::string name;  ///< "ur5", "panda" or "pr2"
  std::string urdf;  ///< text
  std::string srdf;  ///< text
};
/// @param name  "ur5", "panda" or "pr2"
RealRobot realRobot(const std::string& name);

/// Random states of a robot's joints: within their limits, mimic joints after their masters.
class RandomStates {
 public:
  /// @param urdf  the text of the model: mimic joints are read from there
  RandomStates(const RobotModel& model, const std::string& urdf, unsigned seed);

  /// The next state's forward kinematics: root_from_link of each link.
  std::vector<Pose> next();

 private:
  struct Mimic {
    std::string master;
    double multiplier = 1.0, offset = 0.0;
  };
  double position(const std::map<std::string, double>& drawn, const std::string& joint) const;
  Pose motion(const RobotLink& link, double position);

  const RobotModel& model_;
  std::map<std::string, Mimic> mimics_;  // by joint
  Random random_;
};

/// A pose evenly turned, at most `far` [m] from the origin on each axis.
Pose randomPose(Random& random, double far);

/// Adds a body `robot/link` for each link with a <collision>. @returns link index and handle of each.
std::vector<std::pair<std::uint32_t, BodyId>> addLinks(Scene& scene, const RobotModel& model,
                                                       const std::shared_ptr<const LinkMatrix>& matrix);

}  // namespace test
}  // namespace hgrid
