// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/moveit/scene_message.h"

#include <boost/make_shared.hpp>

#include "test/node/moveit/scene_messages.h"

namespace hgrid {
namespace test {
namespace {

template <class Message>
std::string bytesOf(const Message& message) {
  std::string bytes(ros::serialization::serializationLength(message), '\0');
  ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(&bytes[0]),
                                     static_cast<std::uint32_t>(bytes.size()));
  stream.next(message);
  return bytes;
}

ReceivedScene received(SceneTopic topic, const std::string& md5, const std::string& data) {
  const auto message = boost::make_shared<MessageBytes>();
  message->most_bytes = 1 << 20;
  message->read(reinterpret_cast<const std::uint8_t*>(data.data()), data.size());
  return {topic, md5, "/planner", message};
}

class SceneMessage : public ::testing::Test {
 protected:
  SceneMessage() : phase_(makeCoreNarrowPhase()), reader_(params_, *phase_) {
    held_.link_name = "hand";
    held_.object = sceneSphere(CollisionObject::ADD, "held", 1, "hand");
    scene_.is_diff = true;
    scene_.collision_objects = {sceneSphere(CollisionObject::ADD, "part", 1),
                                sceneObject(CollisionObject::REMOVE, "old")};
    scene_.robot_state.attached_collision_objects = {held_};
  }
  std::optional<Code> refused(SceneTopic topic, const std::string& md5, const std::string& data) const {
    const ReadScene read(received(topic, md5, data), reader_);
    return read.refused() ? std::optional<Code>(read.refused()->code()) : std::nullopt;
  }

  Params params_;
  std::shared_ptr<NarrowPhase> phase_;
  SceneReader reader_;
  NoeticAttached held_;
  NoeticScene scene_;
};

TEST_F(SceneMessage, IsReadWithItsOctomap) {
  const ReadScene read(received(SceneTopic::planning_scene, moveit::kMd5<NoeticScene>, bytesOf(scene_)), reader_);
  EXPECT_FALSE(read.refused());
  EXPECT_EQ(read.changes().changes.size(), 4u) << "the held object is added, then attached";
  EXPECT_FALSE(read.octomap()) << "a difference without an octomap";
  scene_.octomap.id = "cleared";
  EXPECT_TRUE(ReadScene(scene_, reader_).octomap());
  scene_.octomap.id.clear();
  scene_.is_diff = false;
  EXPECT_TRUE(ReadScene(scene_, reader_).octomap()) << "a complete scene without an octomap removes it";
}

TEST_F(SceneMessage, ThatIsRefusedLeavesAGapOfWhatItAddsOrMoves) {
  const auto gapOf = [&](const ReadScene& read) {
    SceneGaps gaps;
    read.noteIn(gaps);
    return gaps.sentence().value_or("none");
  };
  scene_.collision_objects[0].primitives[0].dimensions = {-1.0};
  const std::string why =
      gapOf({received(SceneTopic::planning_scene, moveit::kMd5<NoeticScene>, bytesOf(scene_)), reader_});
  EXPECT_NE(why.find("REFUSED 2 objects"), std::string::npos) << why;
  EXPECT_NE(why.find("obstacle/held"), std::string::npos) << why;
  const std::string cut = gapOf({received(SceneTopic::planning_scene, moveit::kMd5<NoeticScene>, "x"), reader_});
  EXPECT_NE(cut.find("REFUSED objects"), std::string::npos) << cut;
  NoeticObject removal = sceneObject(CollisionObject::REMOVE, "a\nb");
  EXPECT_EQ(gapOf({received(SceneTopic::collision_object, moveit::kMd5<NoeticObject>, bytesOf(removal)), reader_}),
            "none")
      << "nothing is missing if a removal is refused";
}

// Claim: while an object that should lie in the world may still follow the robot, there is a gap.
TEST_F(SceneWorld, ARefusedDetachLeavesAGapUntilTheObjectIsDetached) {
  take(attachedTo("hand", sceneSphere(CollisionObject::ADD, "held", 0.5, "hand")));
  tick();
  const NoeticAttached detach = attachedTo("hand", sceneObject(CollisionObject::REMOVE, "held"));
  const ReceivedScene message =
      received(SceneTopic::attached_collision_object, moveit::kMd5<NoeticAttached>, bytesOf(detach));
  SceneGaps gaps;
  const auto apply = [&](double time) {
    ReadScene read(message, reader_);
    read.applyTo(world_, momentAt(time).ros);
    read.noteIn(gaps);
    return read.refused() ? read.refused()->code() : Code::ok;
  };
  EXPECT_EQ(apply(time_ + 1.0), Code::extrapolation) << "the pose of the hand is older than ~stale_after";
  EXPECT_NE(gaps.sentence().value_or("").find("obstacle/held"), std::string::npos);
  EXPECT_EQ(apply(time_), Code::ok);
  EXPECT_FALSE(gaps.sentence());
  EXPECT_EQ(apply(time_), Code::conflict) << "it is not attached any more";
  EXPECT_FALSE(gaps.sentence());
}

// Claim: the reason why a scene is refused says nothing about the objects that its other parts would have detached.
TEST_F(SceneWorld, ARefusedSceneLeavesAGapOfEachObjectThatItWouldHaveDetached) {
  take(attachedTo("hand", sceneSphere(CollisionObject::ADD, "held", 0.5, "hand")));
  tick();
  NoeticScene scene;
  scene.is_diff = true;
  scene.robot_state.attached_collision_objects = {attachedTo("hand", sceneObject(CollisionObject::REMOVE, "held"))};
  scene.collision_objects = {sceneObject(CollisionObject::REMOVE, "never_added")};
  ReadScene read(scene, reader_);
  read.applyTo(world_, momentAt(time_).ros);
  ASSERT_EQ(read.refused()->code(), Code::unknown_id);
  SceneGaps gaps;
  read.noteIn(gaps);
  EXPECT_NE(gaps.sentence().value_or("").find("obstacle/held"), std::string::npos) << "it is still attached";
}

TEST_F(SceneMessage, ThatCannotBeReadMayHaveAnOctomap) {
  const auto hidden = [&](SceneTopic topic, const std::string& md5, const std::string& data) {
    return ReadScene(received(topic, md5, data), reader_).hidesOctomap();
  };
  EXPECT_TRUE(hidden(SceneTopic::planning_scene, moveit::kMd5<NoeticScene>, "x"));
  EXPECT_TRUE(hidden(SceneTopic::planning_scene, "other", bytesOf(scene_)));
  EXPECT_FALSE(hidden(SceneTopic::planning_scene, moveit::kMd5<NoeticScene>, bytesOf(scene_)));
  EXPECT_FALSE(hidden(SceneTopic::collision_object, moveit::kMd5<NoeticObject>, "x"));
  scene_.collision_objects[0].primitives[0].dimensions = {-1.0};
  EXPECT_FALSE(hidden(SceneTopic::planning_scene, moveit::kMd5<NoeticScene>, bytesOf(scene_)))
      << "it is refused, but it could be read, and has none";
  EXPECT_TRUE(ReadScene(Refusal(Code::limit, "too long"), true).hidesOctomap());
  EXPECT_FALSE(ReadScene(Refusal(Code::limit, "too long"), false).hidesOctomap());
}

TEST_F(SceneMessage, OfAnotherTypeIsRefused) {
  const std::string object = bytesOf(scene_.collision_objects[0]);
  for (const std::string& md5 :
       {std::string(), std::string("*"), std::string(32, '0'), std::string(moveit::kMd5<NoeticScene>)}) {
    EXPECT_EQ(refused(SceneTopic::collision_object, md5, object), Code::version) << md5;
  }
  const char* const melodic = "568a161b26dc46c54a5a07621ce82cf3";  // of moveit_msgs/CollisionObject in Melodic
  EXPECT_EQ(refused(SceneTopic::collision_object, melodic, object), Code::version);
}

TEST_F(SceneMessage, ThatIsCutOffAnywhereIsRefused) {
  const std::string object = bytesOf(scene_.collision_objects[0]), held = bytesOf(held_), scene = bytesOf(scene_);
  const auto check = [&](SceneTopic topic, const char* md5, const std::string& whole) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      ASSERT_EQ(refused(topic, md5, whole.substr(0, size)), Code::truncated) << size << " of " << whole.size();
    }
    EXPECT_EQ(refused(topic, md5, whole), std::nullopt);
    EXPECT_EQ(refused(topic, md5, whole + "x"), Code::truncated);
  };
  check(SceneTopic::collision_object, moveit::kMd5<NoeticObject>, object);
  check(SceneTopic::attached_collision_object, moveit::kMd5<NoeticAttached>, held);
  check(SceneTopic::planning_scene, moveit::kMd5<NoeticScene>, scene);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
