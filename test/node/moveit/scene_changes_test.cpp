// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Messages of MoveIt, from the message to the snapshot of the next tick. The tests need no ROS master.
#include <limits>

#include "test/node/moveit/scene_messages.h"

namespace hgrid {
namespace test {
namespace {

using Object = CollisionObject;

TEST_F(SceneWorld, ObjectsAreAddedMovedAndRemoved) {
  take(sceneSphere(Object::ADD, "part", 1));
  take(sceneSphere(Object::ADD, "lid", 2));
  EXPECT_EQ(placesIn(tick()), (Places{{"lid", 2}, {"part", 1}, {"post", 3}}));
  EXPECT_EQ(bodyOf(*tick_->snapshot, "obstacle/part").mobility, Mobility::fixed);
  take(sceneMove("part", 1.5));
  take(sceneObject(Object::REMOVE, "lid"));
  EXPECT_EQ(placesIn(tick()), (Places{{"part", 1.5}, {"post", 3}}));
}

TEST_F(SceneWorld, ObjectsStayWhereTheirFrameWas) {
  take(sceneSphere(Object::ADD, "part", 0.5, "/cart"));
  const double at = cart(time_) + 0.5;
  tick();
  EXPECT_EQ(placesIn(tick()), (Places{{"part", at}, {"post", 3}}));
  take(sceneMove("part", 0.25, "cart"));
  const double then = cart(time_) + 0.25;
  EXPECT_EQ(placesIn(tick()), (Places{{"part", then}, {"post", 3}}));
}

TEST_F(SceneWorld, AddReplacesAndAppendAddsShapes) {
  take(sceneSphere(Object::ADD, "part", 1));
  take(sceneSphere(Object::APPEND, "part", 1.5));
  tick();
  const std::vector<BodyShape>& shapes = bodyOf(*tick_->snapshot, "obstacle/part").shapes;
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_NEAR(shapes[1].body_from_shape.translation().x(), 0.5, 1e-12) << "where the message said, in the world";
  take(sceneMove("part", 2));
  EXPECT_EQ(placesIn(tick()), (Places{{"part", 2}, {"post", 3}}));
  EXPECT_EQ(bodyOf(*tick_->snapshot, "obstacle/part").shapes.size(), 2u);
  take(sceneSphere(Object::ADD, "part", 1));
  tick();
  EXPECT_EQ(bodyOf(*tick_->snapshot, "obstacle/part").shapes.size(), 1u);
  take(sceneSphere(Object::APPEND, "new", 4));
  EXPECT_EQ(placesIn(tick()), (Places{{"new", 4}, {"part", 1}, {"post", 3}}));
}

// Claim: the pose of the only shape of an object without a pose is the pose of the object. So a message that moves the
// object by its pose replaces the pose that came with the shape.
TEST_F(SceneWorld, ThePoseOfTheOnlyShapeIsThatOfTheObject) {
  NoeticObject noetic = sceneObject(Object::ADD, "noetic");
  appendSphere(noetic, 1);
  take(noetic);
  EXPECT_EQ(placesIn(tick()), (Places{{"noetic", 1}, {"post", 3}}));
  take(sceneMove("noetic", 1.5));
  EXPECT_EQ(placesIn(tick()), (Places{{"noetic", 1.5}, {"post", 3}}));
}

TEST_F(SceneWorld, MoveWithPosesOfShapesMovesEachShape) {
  NoeticObject pair = sceneObject(Object::ADD, "pair");
  appendSphere(pair, 1);
  appendSphere(pair, 2);
  take(pair);
  NoeticObject move = sceneObject(Object::MOVE, "pair");
  move.primitive_poses = {poseAt(5), poseAt(7)};
  take(move);
  tick();
  const std::vector<BodyShape>& shapes = bodyOf(*tick_->snapshot, "obstacle/pair").shapes;
  EXPECT_EQ(shapes[0].body_from_shape.translation().x(), 5);
  EXPECT_EQ(shapes[1].body_from_shape.translation().x(), 7);
  move.primitive_poses.push_back(poseAt(9));
  EXPECT_EQ(refusedScene(move), Code::bad_geometry);
}

TEST_F(SceneWorld, ShapesOfAllKindsAreRead) {
  NoeticObject object = sceneObject(Object::ADD, "all");
  object.pose = poseAt(1);
  const std::vector<std::pair<int, std::vector<double>>> primitives = {{shape_msgs::SolidPrimitive::BOX, {1, 2, 3}},
                                                                       {shape_msgs::SolidPrimitive::SPHERE, {0.5}},
                                                                       {shape_msgs::SolidPrimitive::CYLINDER, {2, 0.5}},
                                                                       {shape_msgs::SolidPrimitive::CONE, {2, 0.5}}};
  for (const auto& [type, dimensions] : primitives) {
    object.primitives.emplace_back();
    object.primitives.back().type = static_cast<std::uint8_t>(type);
    object.primitives.back().dimensions = dimensions;
  }
  object.primitive_poses = {poseAt(4)};  // the shapes without a pose are at the origin of the object
  object.meshes.emplace_back();
  for (const double x : {0.0, 1.0}) {
    for (const double y : {0.0, 1.0}) {
      geometry_msgs::Point vertex;
      vertex.x = x;
      vertex.y = y;
      object.meshes.back().vertices.push_back(vertex);
    }
  }
  object.meshes.back().triangles.resize(1);
  object.meshes.back().triangles[0].vertex_indices = {0, 1, 2};
  take(object);
  tick();
  const std::vector<BodyShape>& shapes = bodyOf(*tick_->snapshot, "obstacle/all").shapes;
  ASSERT_EQ(shapes.size(), 5u);
  const ShapeKind kinds[] = {ShapeKind::box, ShapeKind::sphere, ShapeKind::cylinder, ShapeKind::cone, ShapeKind::mesh};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(shapes[i].shape.kind(), kinds[i]);
    EXPECT_EQ(shapes[i].body_from_shape.translation().x(), i == 0 ? 4 : 0);
    if (i == 4) continue;
    EXPECT_EQ(shapes[i].shape.dimensions(), primitives[i].second);
  }
}

TEST_F(SceneWorld, RemoveWithoutAnIdRemovesWhatCameFromMoveItAndIsNotAttached) {
  apply({adding("other", 6)});
  for (const char* id : {"a", "b", "held"}) take(sceneSphere(Object::ADD, id, 1));
  take(attachedTo("hand", sceneObject(Object::ADD, "held")));
  take(sceneObject(Object::REMOVE, ""));
  const Places left = placesIn(tick());
  EXPECT_EQ(left.size(), 3u);
  for (const char* id : {"held", "other", "post"}) EXPECT_EQ(left.count(id), 1u) << id;
}

TEST_F(SceneWorld, ObjectsAreAttachedAndDetached) {
  take(sceneSphere(Object::ADD, "part", 11));
  NoeticAttached attach = attachedTo("tool", sceneObject(Object::ADD, "part"));
  attach.touch_links = {"base", "no_such_link"};
  take(attach);
  const double offset = 11 - cart(time_);
  tick();
  EXPECT_EQ(placesIn(*tick_->snapshot).at("part"), cart(time_) + offset);
  for (const char* link : {"arm/hand", "arm/base"}) {
    EXPECT_TRUE(mayTouch(*tick_->snapshot, "obstacle/part", link)) << link;
  }
  EXPECT_EQ(refusedScene(sceneMove("part", 1)), Code::conflict);
  EXPECT_EQ(refusedScene(sceneObject(Object::REMOVE, "part")), Code::conflict) << "it would disappear from the hand";
  take(attachedTo("tool", sceneObject(Object::REMOVE, "part")));
  const double put = cart(time_) + offset;
  tick();
  EXPECT_EQ(placesIn(tick()).at("part"), put);
  EXPECT_FALSE(mayTouch(*tick_->snapshot, "obstacle/part", "arm/base"));
  take(sceneObject(Object::REMOVE, "part"));
  EXPECT_EQ(placesIn(tick()), (Places{{"post", 3}}));
}

TEST_F(SceneWorld, NewObjectsAreAttachedAtTheirPoseInTheFrameOfTheLinkOrInAnother) {
  take(attachedTo("tool", sceneSphere(Object::ADD, "gripped", 0.5, "tool")));  // the tool is at 0.25 of the cart
  take(attachedTo("hand", sceneSphere(Object::ADD, "seen", 20, "world")));
  const double offset = 20 - cart(time_);
  tick();
  tick();
  EXPECT_EQ(placesIn(*tick_->snapshot),
            (Places{{"gripped", cart(time_) + 0.75}, {"post", 3}, {"seen", cart(time_) + offset}}));
}

TEST_F(SceneWorld, DetachWithoutAnIdDetachesWhatMoveItAttachedToTheLink) {
  take(attachedTo("tool", sceneSphere(Object::ADD, "a", 0.5, "tool")));
  take(attachedTo("arm/hand", sceneSphere(Object::ADD, "b", 0.5, "hand")));
  apply({adding("own", 5), attaching("own", "arm/tool", 1.0)});
  tick();
  const auto follows = [&](const char* id) {
    const double before = placesIn(*tick_->snapshot).at(id);
    return placesIn(tick()).at(id) != before;
  };
  EXPECT_EQ(refusedScene(attachedTo("tool", sceneObject(Object::REMOVE, "own"))), std::nullopt) << "by name";
  apply({attaching("own", "arm/tool", 1.0)});
  take(attachedTo("tool", sceneObject(Object::REMOVE, "")));
  tick();
  EXPECT_FALSE(follows("a"));
  EXPECT_TRUE(follows("b"));
  EXPECT_TRUE(follows("own")) << "MoveIt did not attach it";
  take(attachedTo("", sceneObject(Object::REMOVE, "")));
  tick();
  EXPECT_FALSE(follows("b"));
}

TEST_F(SceneWorld, ALinkOfSeveralRobotsNeedsTheNameOfTheRobot) {
  LoadedRobot twin = arm();
  twin.name = "twin";
  for (Body& link : twin.bodies) {
    link.name = "twin" + link.name.substr(3);
    link.robot = "twin";
  }
  twin.links.clear();
  twin.links["twin/hand"] = {1, Pose::Identity()};
  twin.without_collision.clear();
  world_.setRobot(std::make_shared<const LoadedRobot>(twin));
  tick();
  take(sceneSphere(Object::ADD, "part", 1));
  EXPECT_EQ(refusedScene(attachedTo("hand", sceneObject(Object::ADD, "part"))), Code::conflict);
  EXPECT_EQ(refusedScene(attachedTo("twin/hand", sceneObject(Object::ADD, "part"))), std::nullopt);
  EXPECT_EQ(refusedScene(attachedTo("base", sceneObject(Object::ADD, "part"))), std::nullopt) << "only arm has it";
}

TEST_F(SceneWorld, APlanningSceneIsADifferenceOrComplete) {
  apply({adding("other", 6)});
  take(sceneSphere(Object::ADD, "old", 1));
  NoeticScene scene;
  scene.is_diff = true;
  scene.collision_objects = {sceneSphere(Object::ADD, "new", 2)};
  scene.robot_state.attached_collision_objects = {attachedTo("hand", sceneSphere(Object::ADD, "held", 0.5, "hand"))};
  take(scene);
  const double held = cart(time_ + 0.125) + 0.5;
  EXPECT_EQ(placesIn(tick()), (Places{{"held", held}, {"new", 2}, {"old", 1}, {"other", 6}, {"post", 3}}));
  scene.is_diff = false;
  take(scene);
  EXPECT_EQ(placesIn(tick()), (Places{{"held", held + 0.125}, {"new", 2}, {"other", 6}, {"post", 3}}));
  scene.robot_state.attached_collision_objects.clear();
  scene.robot_state.joint_state.name = {"joint"};
  scene.robot_state.is_diff = true;
  take(scene);
  EXPECT_EQ(placesIn(tick()).count("held"), 1u) << "the state of the robot is a difference";
  scene.robot_state.is_diff = false;
  take(scene);
  EXPECT_EQ(placesIn(tick()), (Places{{"new", 2}, {"other", 6}, {"post", 3}}));
}

// The differences that MoveIt itself and its tutorials send.
TEST_F(SceneWorld, ADifferenceDetachesBeforeItChangesObjects) {
  const auto diff = [&](const NoeticObject& object, const NoeticAttached& attached) {
    NoeticScene scene;
    scene.is_diff = true;
    scene.collision_objects = {object};
    scene.robot_state.attached_collision_objects = {attached};
    return refusedScene(scene);
  };
  const NoeticObject remove = sceneObject(Object::REMOVE, "part"), add = sceneSphere(Object::ADD, "part", 2);
  take(sceneSphere(Object::ADD, "part", 1));
  EXPECT_EQ(diff(remove, attachedTo("hand", sceneObject(Object::ADD, "part"))), std::nullopt) << "attach";
  EXPECT_EQ(placesIn(tick()).count("part"), 1u) << "it left MoveIt's world, but the robot carries it";
  EXPECT_EQ(refusedScene(add), Code::conflict) << "it would disappear from the hand";
  EXPECT_EQ(diff(add, attachedTo("hand", remove)), std::nullopt) << "detach and put it there";
  EXPECT_EQ(placesIn(tick()), (Places{{"part", 2}, {"post", 3}}));
  take(attachedTo("hand", sceneObject(Object::ADD, "part")));
  EXPECT_EQ(diff(remove, attachedTo("hand", remove)), std::nullopt) << "detach and remove";
  EXPECT_EQ(placesIn(tick()), (Places{{"post", 3}}));
}

TEST_F(SceneWorld, ACompleteSceneBuildsItsObjectsFromNothing) {
  NoeticScene scene;
  scene.collision_objects = {sceneSphere(Object::APPEND, "pair", 1), sceneSphere(Object::APPEND, "pair", 2)};
  scene.robot_state.joint_state.name = {"joint"};
  for (int i = 0; i < 2; ++i) {
    take(scene);
    EXPECT_EQ(placesIn(tick()), (Places{{"pair", 1}, {"post", 3}}));
    EXPECT_EQ(bodyOf(*tick_->snapshot, "obstacle/pair").shapes.size(), 2u);
  }
  scene.collision_objects.clear();
  scene.robot_state.attached_collision_objects = {attachedTo("hand", sceneObject(Object::ADD, "pair"))};
  take(scene);
  EXPECT_EQ(placesIn(tick()).count("pair"), 1u) << "the scene attaches it";
  NoeticScene many;
  many.collision_objects.assign(101, sceneObject(Object::REMOVE, ""));
  many.is_diff = true;
  EXPECT_EQ(refusedScene(many), Code::limit);
}

// Claim: a program that sends the same scene again and again does not end any pair.
TEST_F(SceneWorld, ARepeatedSceneKeepsItsBodies) {
  NoeticScene scene;
  scene.collision_objects = {sceneSphere(Object::ADD, "part", 2)};
  scene.robot_state.attached_collision_objects = {attachedTo("hand", sceneSphere(Object::ADD, "held", 0.5, "hand"))};
  const auto ids = [&] {
    std::vector<BodyId> found;
    for (const char* name : {"obstacle/part", "obstacle/held"}) {
      found.push_back(tick_->snapshot->structure().ids[indexOf(*tick_->snapshot, name)]);
    }
    return found;
  };
  take(scene);
  tick();
  const std::vector<BodyId> before = ids();
  for (const bool is_diff : {false, true, false}) {
    scene.is_diff = is_diff;
    take(scene);
    tick();
    EXPECT_EQ(ids(), before);
  }
}

TEST_F(SceneWorld, WrongMessagesAreRefusedAsAWhole) {
  take(sceneSphere(Object::ADD, "part", 1));
  const NoeticObject good = sceneSphere(Object::ADD, "good", 2);
  NoeticObject poses = good, plane = good, type = good, flat = good, operation = good, nan = good, far = good,
               turned = good, frame = good, none = good, name = good, lost = sceneMove("lost", 1),
               endless = scenePlane("endless", {{0.0, 0.0, 1.0, std::numeric_limits<double>::infinity()}});
  poses.primitive_poses.resize(2);
  plane.planes.resize(1);
  type.primitives[0].type = 9;
  flat.primitives[0].dimensions = {0.0};
  operation.operation = 4;
  nan.pose.position.y = std::numeric_limits<double>::quiet_NaN();
  far.pose.position.z = 1e7;
  turned.pose.orientation.w = 2.0;
  frame.header.frame_id = "never_seen";
  none.primitives.clear();
  none.primitive_poses.clear();
  name.id = "a\nb";
  const std::vector<std::pair<Code, NoeticObject>> wrong = {{Code::bad_geometry, poses},
                                                            {Code::bad_geometry, plane},
                                                            {Code::unsupported, type},
                                                            {Code::bad_geometry, flat},
                                                            {Code::unsupported, operation},
                                                            {Code::nonfinite, nan},
                                                            {Code::out_of_range, far},
                                                            {Code::bad_rotation, turned},
                                                            {Code::unknown_frame, frame},
                                                            {Code::bad_geometry, none},
                                                            {Code::nonfinite, endless},
                                                            {Code::bad_id, name},
                                                            {Code::bad_id, sceneObject(Object::ADD, "")},
                                                            {Code::unknown_id, lost},
                                                            {Code::unknown_id, sceneObject(Object::REMOVE, "lost")}};
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(refusedScene(wrong[i].second), wrong[i].first);
    NoeticScene scene;
    scene.collision_objects = {good, wrong[i].second};
    EXPECT_EQ(refusedScene(scene), wrong[i].first);
    EXPECT_EQ(placesIn(tick()), (Places{{"part", 1}, {"post", 3}}));
  }
  EXPECT_EQ(refusedScene(attachedTo("no_link", good)), Code::unknown_id);
  EXPECT_EQ(refusedScene(attachedTo("hand", sceneMove("part", 1))), Code::unsupported);
  EXPECT_EQ(refusedScene(attachedTo("hand", sceneObject(Object::REMOVE, "part"))), Code::conflict) << "not attached";
  NoeticScene full;
  full.collision_objects.resize(23);
  EXPECT_EQ(refusedScene(full), Code::limit) << "~limits/max_bodies is 22";
  EXPECT_EQ(placesIn(tick()), (Places{{"part", 1}, {"post", 3}}));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
