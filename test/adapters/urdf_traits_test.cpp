// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Reads test/data/robots/traits.urdf, and compares the model with the content of the file.
#include <gtest/gtest.h>

#include <cmath>

#include "test/adapters/urdf_texts.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

const double kHalfPi = std::acos(0.0);

class UrdfTraits : public ::testing::Test {
 protected:
  const std::string text_ = fileText(ownData() + "/robots/traits.urdf");
  MeshLoader loader_{meshPolicy()};
  const RobotModel model_ = readWith(loader_, text_);

  const RobotLink& link(const std::string& name) const {
    return model_.links.at(static_cast<std::size_t>(model_.find(name)));
  }
};

/// Returns the rotation of roll, pitch and yaw as REP-103 and URDF define it: first about the x axis, then about the y
/// axis, then about the z axis. The axes do not rotate with the body.
Eigen::Matrix3d turned(double roll, double pitch, double yaw) {
  return (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

TEST_F(UrdfTraits, EveryLinkComesAfterItsParent) {
  EXPECT_EQ(model_.name, "traits");
  ASSERT_EQ(model_.links.size(), 10u);
  EXPECT_EQ(model_.links[0].name, "base");
  EXPECT_EQ(model_.links[0].parent, -1);
  EXPECT_TRUE(model_.links[0].joint.empty());
  for (std::size_t i = 1; i < model_.links.size(); ++i) {
    EXPECT_GE(model_.links[i].parent, 0);
    EXPECT_LT(model_.links[i].parent, static_cast<int>(i));
  }
  const std::vector<std::pair<const char*, const char*>> parents = {
      {"plate", "base"},       {"column", "plate"},      {"arm", "column"}, {"turret", "arm"}, {"hand", "turret"},
      {"finger_left", "hand"}, {"finger_right", "hand"}, {"cart", "base"},  {"drone", "base"}};
  for (const auto& [child, parent] : parents) EXPECT_EQ(link(child).parent, model_.find(parent)) << child;
  EXPECT_EQ(model_.find("nobody"), -1);
}

TEST_F(UrdfTraits, EveryCollisionElementIsAShape) {
  EXPECT_EQ(accountedFor(model_), collisionElements(text_));
  for (const RobotLink& link : model_.links) {
    EXPECT_TRUE(link.unreadable.empty()) << link.name << ": " << link.unreadable.at(0).what();
    EXPECT_EQ(link.has_collision, link.name != "plate") << link.name;
    EXPECT_EQ(link.has_collision, !link.shapes.empty()) << link.name;
  }
}

TEST_F(UrdfTraits, PrimitivesHaveTheirSizesAndOrigins) {
  const std::vector<BodyShape>& shapes = link("base").shapes;
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].shape.kind(), ShapeKind::box);
  EXPECT_EQ(shapes[0].shape.dimensions(), std::vector<double>({0.4, 0.5, 0.6}));
  EXPECT_EQ(shapes[0].body_from_shape.translation(), Eigen::Vector3d(0.1, -0.2, 0.3));
  EXPECT_TRUE(shapes[0].body_from_shape.linear().isApprox(turned(0.4, -0.5, 0.6), 1e-14));
  EXPECT_EQ(shapes[1].shape.kind(), ShapeKind::cylinder);
  EXPECT_EQ(shapes[1].shape.dimensions(), std::vector<double>({0.2, 0.05}));
  EXPECT_EQ(shapes[1].body_from_shape.translation(), Eigen::Vector3d(0.1, 0, 0));
  EXPECT_EQ(shapes[2].shape.kind(), ShapeKind::sphere);
  EXPECT_EQ(shapes[2].shape.dimensions(), std::vector<double>({0.125}));
  EXPECT_EQ(shapes[2].body_from_shape.matrix(), Pose::Identity().matrix());
}

TEST_F(UrdfTraits, MeshesKeepTheirUriAndScale) {
  const std::vector<BodyShape>& shapes = link("hand").shapes;
  ASSERT_EQ(shapes.size(), 3u);
  for (const BodyShape& shape : shapes) {
    EXPECT_EQ(shape.shape.kind(), ShapeKind::mesh);
    EXPECT_EQ(shape.shape.mesh()->triangles.size(), 4u) << shape.resource;
  }
  EXPECT_EQ(shapes[0].resource, "package://hgrid_test/meshes/corner.obj");
  EXPECT_EQ(shapes[0].scale, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(shapes[1].scale, Eigen::Vector3d(1, 2, 4));
  EXPECT_EQ(shapes[1].body_from_shape.translation(), Eigen::Vector3d(0, 0, 0.1));
  EXPECT_TRUE(shapes[1].body_from_shape.linear().isApprox(turned(0, 0, kHalfPi), 1e-14));
  EXPECT_EQ(shapes[2].scale, Eigen::Vector3d(-1, 1, 1));
}

TEST_F(UrdfTraits, JointsHaveTheirKindsAxesAndLimits) {
  EXPECT_EQ(link("plate").joint_kind, JointKind::fixed);
  EXPECT_EQ(link("plate").joint, "base_plate");
  EXPECT_TRUE(link("column").parent_from_joint.linear().isApprox(turned(0, kHalfPi, 0), 1e-14));
  EXPECT_EQ(link("column").parent_from_joint.translation(), Eigen::Vector3d(0, 0.25, 0));

  const RobotLink& arm = link("arm");
  EXPECT_EQ(arm.joint_kind, JointKind::revolute);
  EXPECT_TRUE(arm.axis.isApprox(Eigen::Vector3d(0, 0.6, 0.8), 1e-15)) << "the axis must be normalized";
  EXPECT_EQ(arm.lower, -1.5);
  EXPECT_EQ(arm.upper, 0.5);
  EXPECT_EQ(arm.max_velocity, 2.0);

  const RobotLink& turret = link("turret");
  EXPECT_EQ(turret.joint_kind, JointKind::revolute);
  EXPECT_EQ(turret.axis, Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(turret.lower, 0.0);
  EXPECT_EQ(turret.upper, 0.0);
  EXPECT_EQ(turret.max_velocity, 0.0);

  const RobotLink& finger = link("finger_right");
  EXPECT_EQ(finger.joint_kind, JointKind::prismatic);
  EXPECT_EQ(finger.axis, Eigen::Vector3d(1, 0, 0)) << "the default axis must be x";
  EXPECT_EQ(finger.lower, -0.08);
  EXPECT_EQ(link("cart").joint_kind, JointKind::planar);
  EXPECT_EQ(link("cart").axis, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(link("drone").joint_kind, JointKind::floating);
}

TEST_F(UrdfTraits, LinksOfFixedJointsAreOneGroup) {
  ASSERT_EQ(model_.group_roots.size(), 7u);
  EXPECT_EQ(link("plate").rigid_group, link("base").rigid_group);
  EXPECT_EQ(link("column").rigid_group, link("base").rigid_group);
  EXPECT_EQ(link("hand").rigid_group, link("turret").rigid_group);
  for (const char* name : {"arm", "turret", "finger_left", "finger_right", "cart", "drone"}) {
    EXPECT_NE(link(name).rigid_group, link("base").rigid_group) << name;
    EXPECT_EQ(model_.group_roots.at(link(name).rigid_group), static_cast<std::uint32_t>(model_.find(name)));
    EXPECT_EQ(link(name).group_from_link.matrix(), Pose::Identity().matrix()) << name;
  }
  EXPECT_TRUE(link("column").group_from_link.translation().isApprox(Eigen::Vector3d(0, 0.25, 0.5)));
}

TEST_F(UrdfTraits, RigidGroupsStayRigidInEveryState) {
  RandomStates states(model_, text_, 1);
  for (int i = 0; i < 100; ++i) {
    const std::vector<Pose> poses = states.next();
    for (std::size_t k = 0; k < poses.size(); ++k) {
      const RobotLink& link = model_.links[k];
      const Pose& root_from_group = poses[model_.group_roots.at(link.rigid_group)];
      EXPECT_TRUE(poses[k].isApprox(root_from_group * link.group_from_link, 1e-12)) << link.name;
    }
    const auto opening = [&](const char* finger) {
      const Pose hand_from_finger = poses[model_.find("hand")].inverse() * poses[model_.find(finger)];
      return hand_from_finger.translation().x();
    };
    EXPECT_NEAR(opening("finger_right"), -2 * opening("finger_left") + 0.01, 1e-12)
        << "the mimic joint must follow its master";
  }
}

TEST_F(UrdfTraits, ReadingTwiceGivesTheSameShapes) {
  const RobotModel again = readWith(loader_, text_);
  for (std::size_t i = 0; i < model_.links.size(); ++i) {
    ASSERT_EQ(again.links[i].shapes.size(), model_.links[i].shapes.size());
    for (std::size_t k = 0; k < model_.links[i].shapes.size(); ++k) {
      const Shape &a = again.links[i].shapes[k].shape, &b = model_.links[i].shapes[k].shape;
      EXPECT_EQ(a.dimensions(), b.dimensions());
      if (a.mesh()) {
        EXPECT_EQ(a.mesh()->vertices, b.mesh()->vertices);
      }
    }
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
