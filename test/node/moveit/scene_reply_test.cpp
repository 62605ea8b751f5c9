// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/moveit/scene_reply.h"

#include "test/node/moveit/scene_messages.h"

namespace hgrid {
namespace test {
namespace {

using Component = moveit::GetPlanningScene;
constexpr std::uint32_t kAll = Component::attached_objects | Component::object_names | Component::object_geometry;

class SceneReply : public SceneWorld {
 protected:
  NoeticScene sceneOf(std::uint32_t components) const {
    return planningScene(components, *tick_, world_.obstacles().all(), {});
  }
};

TEST_F(SceneReply, ContainsWhatIsAskedFor) {
  take(sceneSphere(CollisionObject::ADD, "part", 1));
  take(attachedTo("tool", sceneSphere(CollisionObject::ADD, "held", 0.5, "tool")));
  apply({adding("lost", 0, 0.1, "never_seen")});
  tick();
  const NoeticScene names = sceneOf(Component::object_names);
  ASSERT_EQ(names.collision_objects.size(), 2u) << "the configured post too, but nothing without a pose";
  EXPECT_EQ(names.collision_objects[0].id, "part");
  EXPECT_EQ(names.collision_objects[1].id, "post");
  EXPECT_TRUE(names.collision_objects[0].primitives.empty());
  EXPECT_TRUE(names.robot_state.attached_collision_objects.empty());
  const NoeticScene geometry = sceneOf(Component::object_geometry);
  ASSERT_EQ(geometry.collision_objects.size(), 2u);
  EXPECT_EQ(geometry.collision_objects[0].primitives.size(), 1u);
  EXPECT_EQ(geometry.collision_objects[0].pose.position.x, 1);
  EXPECT_EQ(geometry.collision_objects[0].header.frame_id, "world");
  const NoeticScene attached = sceneOf(Component::attached_objects);
  EXPECT_TRUE(attached.collision_objects.empty());
  ASSERT_EQ(attached.robot_state.attached_collision_objects.size(), 1u);
  const NoeticAttached& held = attached.robot_state.attached_collision_objects[0];
  EXPECT_EQ(held.link_name, "tool");
  EXPECT_EQ(held.object.id, "held");
  EXPECT_EQ(held.object.header.frame_id, "tool");
  EXPECT_EQ(held.object.pose.position.x, 0.5);
}

TEST_F(SceneReply, GivesTheSameWorldIfItIsSentBack) {
  msg::Obstacle capsule = adding("capsule", 2);
  capsule.shapes[0].kind = msg::ShapeKind::CAPSULE;
  capsule.shapes[0].dimensions = {1.0, 0.25};
  msg::Obstacle hull = adding("hull", 4);
  hull.shapes[0].kind = msg::ShapeKind::HULL;
  hull.shapes[0].dimensions.clear();
  for (const double x : {0.0, 1.0, 2.0, 3.0}) {
    geometry_msgs::Point vertex;
    vertex.x = x;
    vertex.y = x * x;
    vertex.z = x == 1.0 ? 5.0 : 0.0;
    hull.shapes[0].mesh.vertices.push_back(vertex);
  }
  apply({capsule, hull, adding("held", 1), attaching("held", "arm/tool", 0.5)});
  NoeticObject two = sceneSphere(CollisionObject::ADD, "two", 6);
  appendSphere(two, 3.0, 0.5);
  take(two);
  const Places before = placesIn(tick());
  const auto boundsOf = [&](const std::string& name) {
    const Structure& structure = tick_->snapshot->structure();
    const std::uint32_t body = indexOf(*tick_->snapshot, name);
    Eigen::AlignedBox3d box;
    for (const BodyShape& shape : structure.bodies[body].shapes) {
      box.extend(inDouble(boxOf(shape.shape, shape.body_from_shape, 0.0, Eigen::Vector3d::Zero())));
    }
    return box;
  };
  std::map<std::string, Eigen::AlignedBox3d> boxes;
  for (const auto& place : before) boxes[place.first] = boundsOf("obstacle/" + place.first);
  const NoeticScene scene = sceneOf(kAll);
  apply({removing("capsule"), removing("hull"), removing("held"), removing("two"), removing("post")});
  EXPECT_EQ(placesIn(tick()), Places());
  take(scene);
  Places after = placesIn(tick());
  after.at("held") -= 0.25;  // two ticks later
  EXPECT_EQ(after, before);
  for (const auto& place : before) {
    const Eigen::AlignedBox3d box = boundsOf("obstacle/" + place.first), &old = boxes[place.first];
    EXPECT_LT((box.min() - old.min()).norm() + (box.max() - old.max()).norm(), 1e-5) << place.first;
  }
}

TEST_F(SceneReply, GivesPlanesThatAreTheSameIfTheyAreSentBack) {
  NoeticObject wall = scenePlane("wall", {{3.0, 0.0, -4.0, 10.0}});
  wall.pose = poseAt(1);
  appendSphere(wall, 2.0);
  take(wall);
  const auto planeOfWall = [this] {
    const Structure& structure = tick_->snapshot->structure();
    return tick_->snapshot->halfSpaceOf(structure.planes.at(0));
  };
  tick();
  const HalfSpace before = planeOfWall();
  const NoeticScene scene = sceneOf(kAll);
  apply({removing("wall")});
  EXPECT_TRUE(tick().structure().planes.empty());
  take(scene);
  tick();
  EXPECT_TRUE(planeOfWall().normal.isApprox(before.normal, 1e-12));
  EXPECT_NEAR(planeOfWall().offset, before.offset, 1e-12);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
