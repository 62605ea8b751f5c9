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
#include "hgrid_proximity/narrow/narrow_phase.h"
#include "hgrid_proximity/world/scene.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {

/// Returns the folder of the project's own small robots and meshes. In meshPolicy() it is the package "hgrid_test".
std::string ownData();
/// Returns the folder of the real robots: the value of HGRID_TEST_DATA, or ../shared/data beside the project if
/// HGRID_TEST_DATA is not set. Returns an empty string if the folder does not contain the robots.
std::string sharedData();

/// Skips the rest of a test if sharedData() finds no real robots.
#define HGRID_NEEDS_SHARED_DATA()        \
  if (hgrid::test::sharedData().empty()) \
  GTEST_SKIP() << "there are no real robots: set HGRID_TEST_DATA to a folder with example-robot-data"

/// Returns all bytes of a file. @throws std::runtime_error if the file cannot be read
std::string fileText(const std::string& path);

/// Returns a policy that reads meshes with the mesh reader of this build. It knows the packages "hgrid_test" and
/// "example-robot-data".
MeshPolicy meshPolicy();

/// Reads a robot from the text of a URDF. `loader` reads the meshes of the robot.
RobotModel readWith(MeshLoader& loader, const std::string& urdf);

/// The texts that describe a real robot.
struct RealRobot {
  std::string name;  ///< "ur5", "panda" or "pr2"
  std::string urdf;  ///< text of the URDF
  std::string srdf;  ///< text of the SRDF
};
/// Reads a real robot from sharedData(). @param name  "ur5", "panda" or "pr2"
RealRobot realRobot(const std::string& name);

/// Generates random joint states of a robot. Joints stay within their limits. Mimic joints follow their master joint.
class RandomStates {
 public:
  /// @param urdf  text of the URDF of `model`; mimic joints are read from it
  RandomStates(const RobotModel& model, const std::string& urdf, unsigned seed);

  /// Returns the next random state as the poses of all links: root_from_link by link index.
  std::vector<Pose> next();

 private:
  struct Mimic {
    std::string master;
    double multiplier = 1.0, offset = 0.0;
  };
  double position(const std::map<std::string, double>& drawn, const std::string& joint) const;
  Pose motion(const RobotLink& link, double position);

  const RobotModel& model_;
  std::map<std::string, Mimic> mimics_;  // by name of the mimic joint
  Random random_;
};

/// Returns a random pose. Its rotation is uniformly distributed. It is at most `far` [m] from the origin along each
/// axis.
Pose uniformPose(Random& random, double far);

/// Adds a body `<robot>/<link>` for each link with a <collision>. @returns the link index and the id of each body
/// @param narrow_phase  makes the solids of the shapes; null: the bodies have no solids, so no distance can be measured
std::vector<std::pair<std::uint32_t, BodyId>> addLinks(Scene& scene, const RobotModel& model,
                                                       const std::shared_ptr<const LinkMatrix>& matrix,
                                                       NarrowPhase* narrow_phase = nullptr,
                                                       const std::string& robot = "robot");

}  // namespace test
}  // namespace hgrid
