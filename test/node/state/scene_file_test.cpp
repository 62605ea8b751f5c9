// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/state/scene_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include "src/node/params/obstacle_params.h"
#include "src/node/params/yaml_value.h"
#include "src/node/sources/configured_obstacle.h"
#include "test/node/support/claims.h"
#include "test/node/world/obstacle_world.h"

namespace hgrid {
namespace test {
namespace {

/// Returns the code and the sentence with which `act` is refused; empty if it is not.
template <class Act>
std::string refusalBy(Act&& act) {
  try {
    act();
  } catch (const Refusal& refusal) {
    return std::string(name(refusal.code())) + " " + refusal.what();
  }
  return {};
}

class SceneFile : public Obstacles {
 protected:
  using Numbers = std::mt19937;

  static double number(Numbers& random) { return std::uniform_real_distribution<double>(-3.0, 3.0)(random); }
  static int below(Numbers& random, int count) { return std::uniform_int_distribution<int>(0, count - 1)(random); }

  static geometry_msgs::Pose pose(Numbers& random) {
    geometry_msgs::Pose result;
    result.position.x = number(random);
    result.position.y = 1e-7 * number(random);
    result.position.z = 1e5 * number(random);
    Eigen::Quaterniond q(number(random), number(random), number(random), number(random));
    q.normalize();
    result.orientation.x = q.x();
    result.orientation.y = q.y();
    result.orientation.z = q.z();
    result.orientation.w = q.w();
    return result;
  }
  static msg::Shape shape(Numbers& random) {
    msg::Shape result;
    const auto length = [&] { return 0.1 + std::abs(number(random)); };
    result.kind = static_cast<std::uint8_t>(1 + below(random, 7));
    if (result.kind == msg::ShapeKind::SPHERE) result.dimensions = {length()};
    if (result.kind == msg::ShapeKind::BOX) result.dimensions = {length(), length(), length()};
    if (result.kind >= msg::ShapeKind::CYLINDER && result.kind <= msg::ShapeKind::CAPSULE)
      result.dimensions = {length(), length()};
    if (result.kind >= msg::ShapeKind::HULL) {
      result.mesh.vertices.resize(4);
      for (std::size_t i = 1; i < 4; ++i) result.mesh.vertices[i].x = length();
      result.mesh.vertices[2].y = result.mesh.vertices[3].z = length();
      result.mesh.triangles.resize(2);
      result.mesh.triangles[0].vertex_indices = {0, 1, 2};
      result.mesh.triangles[1].vertex_indices = {1, 3, 2};
    }
    result.pose = pose(random);
    if (below(random, 2) == 0) result.padding = 0.01 * length();
    return result;
  }
  static msg::Obstacle obstacle(Numbers& random) {
    static const char* const names[] = {"part",      "a: b", "123", "true", "\"quoted\"",
                                        "Tür/links", "#",    "- x", "~",    "null"};
    msg::Obstacle result;
    result.name = names[below(random, 10)];
    result.replace = true;
    result.header.frame_id = below(random, 2) == 0 ? "" : "cart";
    result.pose = pose(random);
    result.at_stamp = below(random, 4) == 0;
    const int shapes = 1 + below(random, 3);
    for (int i = 0; i < shapes; ++i) result.shapes.push_back(shape(random));
    result.moving = below(random, 2) == 0;
    if (below(random, 2) == 0) result.margin = std::abs(number(random));
    if (below(random, 2) == 0) result.max_speed = std::abs(number(random));
    if (below(random, 2) == 0) result.lifetime = ros::Duration(100 + below(random, 1000), below(random, 1000000000));
    result.lifetime_end = static_cast<std::uint8_t>(below(random, 2));
    result.owner = below(random, 2) == 0 ? "no" : "/planner: 1";
    return result;
  }

  std::string text() const { return sceneText(world_.obstacles().all(), {}, params()); }
  /// Loads a scene into this world, in place of all obstacles.
  void load(const SavedScene& scene) {
    ObstacleChanges changes;
    for (const auto& present : world_.obstacles().all()) {
      changes.without_groups = true;
      changes.changes.emplace_back();
      changes.changes.back().kind = ObstacleChange::Kind::remove;
      changes.changes.back().name = present.first;
    }
    for (const ObstacleParams& saved : scene.obstacles) {
      ObstacleChange change;
      change.name = saved.body.name;
      change.added = requestedOf(saved, params(), *phase_);
      changes.changes.push_back(change);
      change.kind = ObstacleChange::Kind::attach;
      change.attachment = attachmentOf(saved);
      if (change.attachment) changes.changes.push_back(change);
    }
    world_.applyObstacles(changes, momentAt(time_).ros);
  }
};

TEST_F(SceneFile, GivesTheSameGroupsAgain) {
  msg::Obstacle free = adding("free", 1), too = adding("too", 2), held = adding("held", 3), tip = adding("tip", 4);
  free.group = too.group = "rack";
  held.group = tip.group = "tool: 1";
  apply({free, too, held, tip, attaching("held", "arm/tool", 0.5)});
  const std::map<std::string, PlacedObstacle> before = world_.obstacles().all();
  const SavedScene scene = readScene(text(), "scene", params());
  load(scene);
  const std::map<std::string, PlacedObstacle> after = world_.obstacles().all();
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [name, old] : before) {
    SCOPED_TRACE(name);
    const PlacedObstacle& now = after.at(name);
    EXPECT_EQ(now.what->body.group, old.what->body.group);
    EXPECT_TRUE(now.frame_from_body.isApprox(old.frame_from_body, 1e-12));
    EXPECT_EQ(now.touch, old.touch);
  }
  SavedScene split = scene;  // by hand
  for (ObstacleParams& obstacle : split.obstacles) {
    if (obstacle.body.name == "obstacle/tip") obstacle.attached.reset();
  }
  EXPECT_THROW(load(split), Refusal);
  EXPECT_EQ(world_.obstacles().all().size(), before.size());
}

TEST_F(SceneFile, GivesTheSameObstaclesAgain) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Numbers random(seed);
    for (int i = 0; i < 6; ++i) {
      const msg::Obstacle added = obstacle(random);
      apply({added});
      if (below(random, 3) != 0) continue;
      msg::Obstacle attached = attaching(added.name, "arm/tool");
      attached.at_attach_pose = true;
      attached.attach_pose = pose(random);
      attached.touch = {"arm/base"};
      apply({attached});
    }
    const std::map<std::string, PlacedObstacle> before = world_.obstacles().all();
    const std::string saved = text();
    load(readScene(saved, "scene", params()));
    const std::map<std::string, PlacedObstacle>& after = world_.obstacles().all();
    ASSERT_EQ(before.size(), after.size());
    for (const auto& [name, old] : before) {
      SCOPED_TRACE(name);
      const PlacedObstacle& now = after.at(name);
      EXPECT_EQ(now.what->lifetime, old.what->lifetime);
      EXPECT_EQ(now.what->body.margin, old.what->body.margin);
      EXPECT_EQ(now.what->body.max_speed, old.what->body.max_speed);
      EXPECT_EQ(now.what->moving, old.what->moving);
      EXPECT_EQ(now.what->lost_at_end, old.what->lost_at_end);
      EXPECT_EQ(now.owner, old.owner);
      EXPECT_EQ(now.what->body.group, old.what->body.group);
      EXPECT_EQ(now.frame, old.frame);
      EXPECT_TRUE(now.frame_from_body.isApprox(old.frame_from_body, 1e-12));
      EXPECT_EQ(now.touch, old.touch);
      EXPECT_EQ(now.carrier_speed, old.carrier_speed);
      ASSERT_EQ(now.attachment != nullptr, old.attachment != nullptr);
      if (now.attachment) {
        EXPECT_EQ(now.attachment->link, old.attachment->link);
        EXPECT_TRUE(now.attachment->link_from_body->isApprox(*old.attachment->link_from_body, 1e-12));
      }
      ASSERT_EQ(now.what->body.shapes.size(), old.what->body.shapes.size());
      for (std::size_t i = 0; i < now.what->body.shapes.size(); ++i) {
        const BodyShape &a = now.what->body.shapes[i], &b = old.what->body.shapes[i];
        EXPECT_EQ(a.shape.kind(), b.shape.kind());
        EXPECT_EQ(a.shape.dimensions(), b.shape.dimensions());
        EXPECT_EQ(a.padding, b.padding);
        EXPECT_TRUE(a.body_from_shape.isApprox(b.body_from_shape, 1e-12));
        ASSERT_EQ(a.shape.mesh() != nullptr, b.shape.mesh() != nullptr);
        if (!a.shape.mesh()) continue;
        EXPECT_EQ(a.shape.mesh()->vertices, b.shape.mesh()->vertices);
        if (a.shape.kind() == ShapeKind::mesh) {
          EXPECT_EQ(a.shape.mesh()->triangles, b.shape.mesh()->triangles);
        }
      }
    }
  }
}

TEST_F(SceneFile, GivesTheSamePlanesAgain) {
  Numbers random(7);
  msg::Obstacle floor = adding("floor", 1);
  floor.pose = pose(random);
  floor.shapes[0].kind = msg::ShapeKind::PLANE;
  floor.shapes[0].dimensions.clear();
  floor.shapes[0].pose = pose(random);
  floor.shapes[0].padding = 0.25;
  apply({floor});
  const PlacedObstacle before = world_.obstacles().all().at("obstacle/floor");
  load(readScene(text(), "scene", params()));
  const BodyShape &a = before.what->body.shapes[0],
                  &b = world_.obstacles().all().at("obstacle/floor").what->body.shapes[0];
  EXPECT_EQ(b.shape.kind(), ShapeKind::plane);
  EXPECT_EQ(b.padding, 0.25);
  EXPECT_TRUE(a.body_from_shape.isApprox(b.body_from_shape, 1e-12));
}

TEST_F(SceneFile, KeepsRulesThatNeverEnd) {
  PairRule kept{"arm/*", "obstacle/a: b", "it must"}, strict{"arm/hand", "obstacle/*", ""}, brief = kept, fixed = kept;
  kept.origin = strict.origin = brief.origin = Origin::service;
  strict.allowed = false;
  brief.ends = PairRule::Clock::now() + std::chrono::hours(1);
  const SavedScene read = readScene(sceneText({}, {fixed, kept, brief, strict}, params()), "scene", params());
  EXPECT_TRUE(read.obstacles.empty());
  ASSERT_EQ(read.rules.size(), 2u);
  EXPECT_EQ(read.rules[0].first + read.rules[0].second + read.rules[0].reason, "arm/*obstacle/a: bit must");
  EXPECT_TRUE(read.rules[0].allowed);
  EXPECT_EQ(read.rules[1].first + read.rules[1].second + read.rules[1].reason, "arm/handobstacle/*");
  EXPECT_FALSE(read.rules[1].allowed);
}

TEST_F(SceneFile, DoesNotMakeGlobsOfNamesOfLinks) {
  apply({adding("part", 1), attaching("part", "arm/tool", 0.0)});
  std::map<std::string, PlacedObstacle> obstacles = world_.obstacles().all();
  PlacedObstacle& part = obstacles.at("obstacle/part");
  Attachment attachment = *part.attachment;
  attachment.touch_links = {"base", "h*"};  // as in a message of MoveIt; no link is called "h*", so it has no effect
  part.attachment = std::make_shared<const Attachment>(attachment);
  const SavedScene read = readScene(sceneText(obstacles, {}, params()), "scene", params());
  EXPECT_EQ(read.obstacles[0].attached->touch, std::vector<std::string>({"arm/base"}));
}

TEST_F(SceneFile, IsAListOfObstaclesForTheParameters) {
  Numbers random(7);
  apply({obstacle(random)});
  XmlRpc::XmlRpcValue values = valueOfYaml(text(), "scene");
  values["world_frame"] = "world";
  EXPECT_EQ(readParams(values).obstacles.size(), 2u);
}

TEST_F(SceneFile, ADamagedTextIsRefusedOrReadWithoutItsEnd) {
  Numbers random(3);
  for (int i = 0; i < 4; ++i) apply({obstacle(random)});
  const std::string whole = text();
  const std::size_t count = world_.obstacles().all().size();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    try {
      EXPECT_LE(readScene(whole.substr(0, length), "scene", params()).obstacles.size(), count);
    } catch (const Refusal& refusal) {
      EXPECT_EQ(refusal.code(), Code::parse) << refusal.what();
    }
  }
}

TEST(YamlValues, AreReadAsRosparamReadsThem) {
  XmlRpc::XmlRpcValue value =
      valueOfYaml("{i: 3, n: -4, d: 0.5, e: 1.0e-05, b: true, s: text, q: '3', l: [1, two], big: 3000000000}", "it");
  using Type = XmlRpc::XmlRpcValue;
  EXPECT_EQ(static_cast<int>(value["i"]), 3);
  EXPECT_EQ(static_cast<int>(value["n"]), -4);
  EXPECT_EQ(static_cast<double>(value["d"]), 0.5);
  EXPECT_EQ(static_cast<double>(value["e"]), 1e-5);
  EXPECT_EQ(static_cast<double>(value["big"]), 3e9);
  EXPECT_EQ(value["b"].getType(), Type::TypeBoolean);
  EXPECT_EQ(static_cast<std::string>(value["s"]), "text");
  EXPECT_EQ(value["q"].getType(), Type::TypeString);
  EXPECT_EQ(value["l"].size(), 2);
}

TEST(YamlValues, WhatIsWrongIsNamedWithItsLine) {
  const auto said = [](const std::string& text) { return refusalBy([&] { valueOfYaml(text, "night.yaml"); }); };
  EXPECT_TRUE(says(said("a: 1\na: 2\n"), "PARSE night.yaml, line 2: 'a' is there twice"));
  EXPECT_TRUE(says(said("a: 1\nb:\n"), "there is an empty value"));
  EXPECT_TRUE(says(said("a: &x 1\nb: *x\n"), "PARSE night.yaml, line 2: there is an alias"));
  EXPECT_TRUE(says(said("a: [1\nb: 2"), "is not valid YAML"));
  EXPECT_TRUE(says(said("? [1]\n: 2"), "a key is a list or a dictionary"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "- ";
  EXPECT_TRUE(says(said(deep + "1"), "there are more than 32 levels of lists and dictionaries"));
  for (const char bracket : {'[', '{'})
    EXPECT_TRUE(says(said(std::string(100000, bracket)), "PARSE night.yaml, line 1"));
  EXPECT_TRUE(says(said(""), "night.yaml is empty"));
  EXPECT_TRUE(says(said("a: 1\n---\nb: 2\n"), "PARSE night.yaml has more than one document"));
  EXPECT_EQ(said("---\na: 1\n...\n"), "");
  for (const std::string number : {"010", "-07", "00"})
    EXPECT_TRUE(says(said("a: [1, " + number + "]\n"), "'" + number + "' begins with a zero")) << number;
  EXPECT_EQ(said("{a: 0, b: 0.5, c: -0, d: '010', e: 0x, f: 1e05}\n"), "");
}

/// Claim: the path in the answer of ~save_scene is a full one, also if ~state_folder is not.
TEST(SceneFolders, HaveFullPaths) {
  EXPECT_EQ(SceneFolder("/tmp", "x").path(), "/tmp/scenes/x.yaml");
  EXPECT_EQ(SceneFolder("state", "x").path(), (std::filesystem::current_path() / "state/scenes/x.yaml").string());
}

/// Tests with a folder of their own, which stands for ~state_folder.
class ScenesOfAFolder : public ::testing::Test {
 protected:
  ScenesOfAFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "scenes_XXXXXX").string();
    state_ = mkdtemp(pattern.data());
    scenes_ = state_ / "scenes";
    listScenes(state_.string());  // makes the folder
  }
  ~ScenesOfAFolder() override { std::filesystem::remove_all(state_); }

  void write(const std::string& file, const std::string& text) const { std::ofstream(scenes_ / file) << text; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const SceneList::Entry& scene : listScenes(state_.string()).scenes) names.push_back(scene.name);
    return names;
  }

  std::filesystem::path state_, scenes_;
};

TEST_F(ScenesOfAFolder, AreListedByNameWithTheTimeOfTheLastWrite) {
  EXPECT_TRUE(names().empty());
  for (const char* name : {"b", "a-b", "a"}) SceneFolder(state_.string(), name).write("obstacles: []\n", false);
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "a-b", "b"}));
  const timespec times[] = {{0, 0}, {1700000000, 250000000}};  // of the last access and of the last write
  ASSERT_EQ(utimensat(AT_FDCWD, (scenes_ / "a.yaml").c_str(), times, 0), 0);
  const SceneList list = listScenes(state_.string());
  EXPECT_EQ(list.scenes[0].last_write.tv_sec, 1700000000);
  EXPECT_EQ(list.scenes[0].last_write.tv_nsec, 250000000);
  EXPECT_TRUE(list.unusable.empty());
}

TEST_F(ScenesOfAFolder, AreNamedWithTheReasonIfTheyCannotBeLoaded) {
  write("good.yaml", "obstacles: []\n");
  write("empty.yaml", "");
  write("my scene.yaml", "obstacles: []\n");
  write(".yaml", "obstacles: []\n");
  write("notes.txt", "not a scene");
  write("good.yaml.new", "the rest of a save that was interrupted");
  std::filesystem::create_directory(scenes_ / "folder.yaml");
  std::filesystem::create_symlink(scenes_ / "good.yaml", scenes_ / "link.yaml");
  ASSERT_EQ(mkfifo((scenes_ / "pipe.yaml").c_str(), 0600), 0);
  write("long.yaml", "");
  std::filesystem::resize_file(scenes_ / "long.yaml", (256 << 20) + 1);
  const SceneList list = listScenes(state_.string());
  EXPECT_EQ(names(), std::vector<std::string>{"good"});
  ASSERT_EQ(list.unusable.size(), 7u);
  const char* const reasons[] = {"the name of the scene is ''",
                                 "empty.yaml' is empty",
                                 "folder.yaml' is no regular file",
                                 "link.yaml' is a link",
                                 "long.yaml' has more than 268435456 bytes",
                                 "the name of the scene is 'my scene'",
                                 "pipe.yaml' is no regular file"};
  for (std::size_t i = 0; i < 7; ++i) EXPECT_TRUE(says(list.unusable[i], reasons[i]));
  for (const char* name : {"folder", "link", "pipe", "long"}) {
    EXPECT_NE(refusalBy([&] { SceneFolder(state_.string(), name).read(); }), "") << name << " is not listed";
  }
}

TEST_F(ScenesOfAFolder, AreNamedIfTheUserMayNotReadThem) {
  if (geteuid() == 0) {  // root may read everything, so act as another user
    ASSERT_EQ(chown(state_.c_str(), 65534, 65534), 0);
    ASSERT_EQ(chown(scenes_.c_str(), 65534, 65534), 0);
    ASSERT_EQ(seteuid(65534), 0);
  }
  write("secret.yaml", "obstacles: []\n");
  std::filesystem::permissions(scenes_ / "secret.yaml", std::filesystem::perms::none);
  const SceneList list = listScenes(state_.string());
  ASSERT_EQ(seteuid(getuid()), 0);
  EXPECT_TRUE(list.scenes.empty());
  ASSERT_EQ(list.unusable.size(), 1u);
  EXPECT_TRUE(says(list.unusable[0], "secret.yaml': Permission denied"));
}

TEST_F(ScenesOfAFolder, AreRefusedIfThereAreTooManyFiles) {
  for (int i = 0; i < 10000; ++i) write("note_" + std::to_string(i), "");
  EXPECT_TRUE(names().empty());
  write("one_more", "");
  EXPECT_TRUE(says(refusalBy([&] { names(); }), "has more than 10000 files; move some of them"));
}

TEST_F(ScenesOfAFolder, AreRefusedWithoutAFolder) {
  EXPECT_TRUE(says(refusalBy([] { listScenes(""); }), "RESOURCE_DENIED scenes are stored in ~state_folder"));
  std::filesystem::permissions(scenes_, std::filesystem::perms::all);
  EXPECT_TRUE(says(refusalBy([&] { names(); }), "chmod go-w"));
}

TEST(SceneFolders, TakeOnlyPlainNames) {
  for (const char* bad : {"", ".", "..", "../up", "a/b", ".hidden", "a b", "ä"}) {
    EXPECT_TRUE(says(refusalBy([&] { SceneFolder("/tmp", bad); }), "BAD_ID the name of the scene is '")) << bad;
  }
  EXPECT_TRUE(says(refusalBy([&] { SceneFolder("/tmp", std::string(65, 'x')); }), "BAD_ID"));
  EXPECT_TRUE(says(refusalBy([&] { SceneFolder("", "x"); }), "RESOURCE_DENIED scenes are stored in ~state_folder"));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
