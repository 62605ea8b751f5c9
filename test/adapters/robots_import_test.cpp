// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Imports UR5, Panda and PR2. All shapes must be there. Their bounding boxes must be as tight as floats allow.
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cmath>
#include <sstream>

#include "test/adapters/urdf_texts.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

using Real = long double;

struct Extent {
  Real low, high;
};

/// Returns the extent of a shape along a world axis. Uses extended precision and other formulas than the product uses.
Extent extentOf(const Shape& shape, const Pose& world_from_shape, int axis) {
  const Real row[3] = {world_from_shape.linear()(axis, 0), world_from_shape.linear()(axis, 1),
                       world_from_shape.linear()(axis, 2)};
  const Real center = world_from_shape.translation()[axis];
  if (shape.mesh()) {
    Extent extent{std::numeric_limits<Real>::infinity(), -std::numeric_limits<Real>::infinity()};
    for (const Eigen::Vector3d& v : shape.mesh()->vertices) {
      const Real x = center + row[0] * v.x() + row[1] * v.y() + row[2] * v.z();
      extent.low = std::min(extent.low, x);
      extent.high = std::max(extent.high, x);
    }
    return extent;
  }
  const std::vector<double> size = shape.dimensions();
  Real half = 0;
  switch (shape.kind()) {
    case ShapeKind::sphere:
      half = size[0];
      break;
    case ShapeKind::box:
      for (int i = 0; i < 3; ++i) half += std::fabs(row[i]) * size[static_cast<std::size_t>(i)] / 2;
      break;
    case ShapeKind::cylinder:
      half = std::fabs(row[2]) * size[0] / 2 + std::hypot(row[0], row[1]) * size[1];
      break;
    default:
      ADD_FAILURE() << "a URDF cannot contain a " << name(shape.kind());
  }
  return {center - half, center + half};
}

void expectTight(const BodyShape& shape, Random& random) {
  const double reach = shape.shape.reach();
  for (int i = 0; i < 1000; ++i) {
    const Pose world_from_shape = uniformPose(random, 10.0) * shape.body_from_shape;
    const Aabb box = boxOf(shape.shape, world_from_shape, 0.0, Eigen::Vector3d::Zero());
    for (int axis = 0; axis < 3; ++axis) {
      const Extent exact = extentOf(shape.shape, world_from_shape, axis);
      // A rotation matrix has rounding errors in its last bits. They change the extent of all shapes except spheres.
      const Real slack = shape.shape.kind() == ShapeKind::sphere ? 1e-15L : 0;
      ASSERT_LE(box.min[axis], exact.low + slack);
      ASSERT_GE(box.max[axis], exact.high - slack);
      const double rounding = 1e-13 * (reach + world_from_shape.translation().cwiseAbs().sum());
      ASSERT_GE(box.min[axis], roundedDown(static_cast<double>(exact.low) - rounding));
      ASSERT_LE(box.max[axis], roundedUp(static_cast<double>(exact.high) + rounding));
    }
  }
}

class RobotImport : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { HGRID_NEEDS_SHARED_DATA(); }
};

TEST_P(RobotImport, EveryCollisionShapeIsThere) {
  const RealRobot robot = realRobot(GetParam());
  MeshLoader loader(meshPolicy());
  const RobotModel model = readWith(loader, robot.urdf);
  std::size_t meshes = 0, primitives = 0;
  for (const RobotLink& link : model.links) {
    EXPECT_TRUE(link.unreadable.empty()) << link.name << ": " << link.unreadable.at(0).what();
    for (const BodyShape& shape : link.shapes) ++(shape.shape.mesh() ? meshes : primitives);
  }
  EXPECT_EQ(meshes + primitives, collisionElements(robot.urdf));
  if (robot.name == "ur5") {
    EXPECT_EQ(meshes, 7u);
    EXPECT_EQ(primitives, 1u);
  } else if (robot.name == "panda") {
    EXPECT_EQ(meshes + primitives, 17u);
  } else {
    EXPECT_EQ(model.links.size(), 82u);
    EXPECT_EQ(meshes, 31u);
    EXPECT_EQ(primitives, 1u);
  }
}

TEST_P(RobotImport, BoxesHoldAllVerticesAndTouchThemOnAllSixFaces) {
  MeshLoader loader(meshPolicy());
  const RobotModel model = readWith(loader, realRobot(GetParam()).urdf);
  Random random(1);
  for (const RobotLink& link : model.links) {
    for (const BodyShape& shape : link.shapes) {
      SCOPED_TRACE(link.name + " " + shape.resource);
      expectTight(shape, random);
      if (HasFatalFailure()) return;
    }
  }
}

/// Returns the vertices of a binary STL file, read without the product.
std::vector<Eigen::Vector3d> verticesOfStl(const std::string& bytes) {
  std::vector<Eigen::Vector3d> vertices;
  for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
    float numbers[9];
    bytes.copy(reinterpret_cast<char*>(numbers), sizeof numbers, at + 12);
    for (int i = 0; i < 9; i += 3) vertices.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  return vertices;
}

TEST_P(RobotImport, MeshesHaveTheVerticesOfTheirFiles) {
  MeshLoader loader(meshPolicy());
  const RobotModel model = readWith(loader, realRobot(GetParam()).urdf);
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  for (const RobotLink& link : model.links) {
    for (const BodyShape& shape : link.shapes) {
      if (!shape.shape.mesh()) continue;
      ASSERT_EQ(shape.scale, Eigen::Vector3d::Ones());
      const std::string path = sharedData() + "/" + shape.resource.substr(std::string("package://").size());
      std::vector<Eigen::Vector3d> in_file = verticesOfStl(fileText(path)), read;
      for (const auto& t : shape.shape.mesh()->triangles) {
        for (const std::uint32_t index : t) read.push_back(shape.shape.mesh()->vertices.at(index));
      }
      std::sort(in_file.begin(), in_file.end(), less);
      std::sort(read.begin(), read.end(), less);
      EXPECT_EQ(in_file.size(), read.size()) << shape.resource;
      EXPECT_TRUE(in_file == read) << shape.resource;
    }
  }
}

Eigen::Vector3d numbers(const tinyxml2::XMLElement* element, const char* attribute) {
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  if (element && element->Attribute(attribute)) {
    std::istringstream text(element->Attribute(attribute));
    text >> v[0] >> v[1] >> v[2];
  }
  return v;
}

TEST_P(RobotImport, JointsEqualThoseOfTheText) {
  const RealRobot robot = realRobot(GetParam());
  const RobotModel model = readUrdf(robot.urdf, knowsOneMesh);  // skips the meshes, because the test needs only joints
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(robot.urdf.data(), robot.urdf.size()), tinyxml2::XML_SUCCESS);
  std::size_t joints = 0;
  for (const auto* joint = document.RootElement()->FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    ++joints;
    SCOPED_TRACE(joint->Attribute("name"));
    const RobotLink& link = model.links.at(model.find(joint->FirstChildElement("child")->Attribute("link")));
    EXPECT_EQ(link.joint, joint->Attribute("name"));
    EXPECT_EQ(link.parent, model.find(joint->FirstChildElement("parent")->Attribute("link")));
    const auto* origin = joint->FirstChildElement("origin");
    const Eigen::Vector3d rpy = numbers(origin, "rpy");
    EXPECT_EQ(link.parent_from_joint.translation(), numbers(origin, "xyz"));
    const Eigen::Matrix3d turn =
        (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    EXPECT_TRUE(link.parent_from_joint.linear().isApprox(turn, 1e-12));
    const std::string type = joint->Attribute("type");
    EXPECT_EQ(link.joint_kind == JointKind::fixed, type == "fixed");
    EXPECT_EQ(link.joint_kind == JointKind::prismatic, type == "prismatic");
    EXPECT_EQ(link.joint_kind == JointKind::revolute, type == "revolute" || type == "continuous");
    EXPECT_EQ(link.continuous, type == "continuous");
    const auto* mimic = joint->FirstChildElement("mimic");
    EXPECT_EQ(link.mimic, mimic ? mimic->Attribute("joint") : "");
    if (type == "fixed") continue;
    EXPECT_TRUE(link.axis.isApprox(numbers(joint->FirstChildElement("axis"), "xyz").normalized(), 1e-12));
    const auto* limit = joint->FirstChildElement("limit");
    EXPECT_EQ(link.lower, type == "continuous" || !limit ? 0.0 : limit->DoubleAttribute("lower"));
    EXPECT_EQ(link.upper, type == "continuous" || !limit ? 0.0 : limit->DoubleAttribute("upper"));
  }
  EXPECT_EQ(model.links.size(), joints + 1);
}

TEST(RobotImportOthers, OtherDescriptionsAreReadCompletely) {
  HGRID_NEEDS_SHARED_DATA();
  const std::string robots = sharedData() + "/example-robot-data/robots/";
  MeshLoader loader(meshPolicy());
  for (const auto& [file, shapes] :
       std::vector<std::pair<std::string, std::size_t>>{{"ur_description/urdf/ur5_joint_limited_robot.urdf", 8},
                                                        {"ur_description/urdf/ur5_gripper.urdf", 11},
                                                        {"panda_description/urdf/panda_collision.urdf", 39}}) {
    const RobotModel model = readWith(loader, fileText(robots + file));
    EXPECT_EQ(accountedFor(model), shapes) << file;
    for (const RobotLink& link : model.links) {
      for (const Refusal& refusal : link.unreadable) ADD_FAILURE() << file << ": " << refusal.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Real, RobotImport, ::testing::Values("ur5", "panda", "pr2"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace test
}  // namespace hgrid
