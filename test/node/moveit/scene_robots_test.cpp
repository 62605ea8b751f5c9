// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// What planning scenes of MoveIt say about robots and allowed pairs: paddings of links, and the allowed collision
// matrix.
#include <limits>
#include <map>

#include "src/node/moveit/scene_matrix.h"
#include "src/node/moveit/scene_message.h"
#include "src/node/moveit/scene_reply.h"
#include "test/node/moveit/scene_messages.h"
#include "test/support/random.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {
namespace {

using moveit::AllowedCollisionMatrix;

AllowedCollisionMatrix matrixOf(const std::vector<std::string>& names,
                                const std::vector<std::pair<std::size_t, std::size_t>>& enabled) {
  AllowedCollisionMatrix matrix;
  matrix.entry_names = names;
  matrix.entry_values.resize(names.size());
  for (auto& row : matrix.entry_values) row.enabled.resize(names.size());
  for (const auto& [i, j] : enabled) matrix.entry_values[i].enabled[j] = matrix.entry_values[j].enabled[i] = 1;
  return matrix;
}

/// A world with an arm (see Obstacles) that takes whole planning scenes, with the matrix turned on.
class SceneRobots : public Obstacles {
 protected:
  /// @returns why the scene is refused; Code::ok if it is applied
  Code take(const NoeticScene& scene) {
    ReadScene read(scene, reader_);
    const PrepareObstacles prepare = [this](const ObstacleChanges& changes, const std::vector<PairRule>* rules) {
      return world_.prepareObstacles(changes, tick_, momentAt(time_).ros, rules);
    };
    prepares_ = !prepares_;
    const auto prepared = prepares_ ? read.prepare(prepare, tick_.get()) : nullptr;
    read.applyTo(world_, momentAt(time_).ros, prepared.get());
    return read.applied() ? Code::ok : read.refused()->code();
  }
  static NoeticScene diff() {
    NoeticScene scene;
    scene.is_diff = 1;
    return scene;
  }
  Code pad(const std::vector<moveit::LinkNumber>& paddings, bool is_diff = true) {
    NoeticScene scene;
    scene.is_diff = is_diff ? 1 : 0;
    scene.link_padding = paddings;
    return take(scene);
  }
  Code allow(const AllowedCollisionMatrix& matrix) {
    NoeticScene scene = diff();
    scene.allowed_collision_matrix = matrix;
    return take(scene);
  }
  double paddingOf(const std::string& link) { return bodyOf(tick(), link).shapes[0].padding; }
  std::size_t matrixRules() {
    const std::vector<PairRule>& rules = tick().structure().filter.rules();
    return static_cast<std::size_t>(
        std::count_if(rules.begin(), rules.end(), [](const PairRule& rule) { return rule.origin == Origin::moveit; }));
  }

  Params reader_params_ = [] {
    Params with_matrix = params();
    with_matrix.moveit_matrix = true;
    return with_matrix;
  }();
  SceneReader reader_{reader_params_, *phase_};
};

TEST_F(SceneRobots, APaddingHoldsUntilAnotherOneIsSent) {
  EXPECT_EQ(pad({{"hand", 0.25}, {"nobody", 1.0}}), Code::ok);
  EXPECT_EQ(paddingOf("arm/hand"), 0.25);
  EXPECT_EQ(paddingOf("arm/base"), 0.0);
  const std::uint64_t revision = tick().structure().revision;
  EXPECT_EQ(pad({{"hand", 0.25}, {"base", 0.0}}), Code::ok);
  EXPECT_EQ(tick().structure().revision, revision) << "a message that repeats the paddings must change nothing";
  world_.setRobot(std::make_shared<const LoadedRobot>(arm()));
  EXPECT_EQ(paddingOf("arm/hand"), 0.25) << "also after the robot was loaded again";
  EXPECT_EQ(pad({{"arm/base", 0.5}}), Code::ok);
  EXPECT_EQ(paddingOf("arm/hand"), 0.25) << "a difference keeps the other paddings";
  EXPECT_EQ(paddingOf("arm/base"), 0.5);
  EXPECT_EQ(pad({{"hand", 0.0}}), Code::ok);
  EXPECT_EQ(paddingOf("arm/hand"), 0.0);
  EXPECT_EQ(pad({{"hand", 0.125}}, false), Code::ok);
  EXPECT_EQ(paddingOf("arm/hand"), 0.125);
  EXPECT_EQ(paddingOf("arm/base"), 0.0) << "a complete scene replaces all paddings";
  world_.reset();
  EXPECT_EQ(paddingOf("arm/hand"), 0.0);
}

TEST_F(SceneRobots, TheLargerOneOfTwoPaddingsCounts) {
  LoadedRobot robot = arm();
  robot.bodies[1].shapes[0].padding = 0.25;  // as ~padding says
  world_.setRobot(std::make_shared<const LoadedRobot>(robot));
  for (const auto& [sent, counts] : {std::pair(0.125, 0.25), std::pair(0.5, 0.5), std::pair(0.0, 0.25)}) {
    EXPECT_EQ(pad({{"hand", sent}}), Code::ok);
    EXPECT_EQ(paddingOf("arm/hand"), counts);
  }
}

TEST_F(SceneRobots, AnAttachedObjectStaysAttachedWhenThePaddingChanges) {
  msg::Obstacle add = adding("held", 0.5, 0.1, "cart");
  apply({add, attaching("held", "arm/tool", 0.25)});
  const double before = placesIn(tick())["held"] - cart(time_);
  EXPECT_EQ(pad({{"hand", 0.25}}), Code::ok);
  tick();
  EXPECT_NEAR(placesIn(tick())["held"] - cart(time_), before, 1e-6);
  EXPECT_TRUE(mayTouch(*tick_->snapshot, "obstacle/held", "arm/hand"));
}

TEST_F(SceneRobots, ARefusedSceneChangesNoPadding) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(pad({{"hand", -0.5}}), Code::out_of_range);
  EXPECT_EQ(pad({{"hand", nan}}), Code::out_of_range);
  EXPECT_EQ(pad({{"hand", 2000.0}}), Code::out_of_range);
  EXPECT_EQ(pad({{"hand", 0.5}, {"hand", 0.25}}), Code::dup_id);
  EXPECT_EQ(pad({{"", 0.5}}), Code::bad_id);
  NoeticScene scene = diff();
  scene.link_padding = {{"hand", 0.5}};
  scene.allowed_collision_matrix = matrixOf({"hand", "base"}, {{0, 1}});
  scene.collision_objects = {sceneMove("nothing", 1)};
  EXPECT_EQ(take(scene), Code::unknown_id);
  std::vector<moveit::LinkNumber> many;
  for (int i = 0; i <= params().max_links; ++i) many.push_back({"link" + std::to_string(i), 0.5});
  EXPECT_EQ(pad(many), Code::limit);
  EXPECT_EQ(paddingOf("arm/hand"), 0.0);
  EXPECT_EQ(matrixRules(), 0u);
}

TEST_F(SceneRobots, TheMatrixSwitchesOffPairsUntilTheNextMatrix) {
  ASSERT_FALSE(mayTouch(tick(), "arm/hand", "obstacle/post"));
  EXPECT_EQ(allow(matrixOf({"hand", "post", "base"}, {{0, 1}})), Code::ok);
  EXPECT_TRUE(mayTouch(tick(), "arm/hand", "obstacle/post"));
  EXPECT_FALSE(mayTouch(*tick_->snapshot, "arm/hand", "arm/base"));
  EXPECT_EQ(take(diff()), Code::ok);
  EXPECT_TRUE(mayTouch(tick(), "arm/hand", "obstacle/post")) << "a difference without a matrix changes nothing";
  EXPECT_EQ(allow(matrixOf({"hand", "base"}, {{0, 1}})), Code::ok);
  EXPECT_FALSE(mayTouch(tick(), "arm/hand", "obstacle/post"));
  EXPECT_TRUE(mayTouch(*tick_->snapshot, "arm/hand", "arm/base"));
  EXPECT_EQ(take(NoeticScene()), Code::ok);
  EXPECT_EQ(matrixRules(), 0u) << "a complete scene has a complete matrix";
  EXPECT_EQ(allow(matrixOf({"hand", "base"}, {{0, 1}})), Code::ok);
  EXPECT_EQ(matrixRules(), 1u);
  world_.reset();
  EXPECT_EQ(matrixRules(), 0u);
}

TEST_F(SceneRobots, OtherRulesTakePrecedenceOverTheMatrix) {
  EXPECT_EQ(allow(matrixOf({"hand", "post"}, {{0, 1}})), Code::ok);
  PairRule rule{"arm/hand", "obstacle/post", "", false};
  rule.origin = Origin::service;
  const Structure& structure = tick().structure();
  std::vector<PairRule> rules = structure.filter.rules();
  rules.push_back(rule);
  world_.setRules({PairFilter(structure.bodies, PairKinds(), rules), structure.revision});
  EXPECT_FALSE(mayTouch(tick(), "arm/hand", "obstacle/post"));
  EXPECT_EQ(matrixRules(), 1u);
  EXPECT_EQ(allow(matrixOf({"hand", "base"}, {{0, 1}})), Code::ok);
  EXPECT_EQ(tick().structure().filter.rules().size(), 2u) << "the rule of the service stays";
  EXPECT_TRUE(mayTouch(*tick_->snapshot, "arm/hand", "arm/base"));
}

TEST_F(SceneRobots, NamesOfTheMatrixAreThoseOfTheRobotsInTheWorld) {
  const AllowedCollisionMatrix matrix =
      matrixOf({"hand", "second/hand", "post", "<octomap>"}, {{0, 2}, {1, 2}, {2, 3}});
  EXPECT_EQ(allow(matrix), Code::ok);
  EXPECT_TRUE(mayTouch(tick(), "arm/hand", "obstacle/post"));
  LoadedRobot second = arm();
  second.name = "second";
  second.links.clear();
  for (Body& body : second.bodies) {
    body.robot = second.name;
    body.name = "second" + body.name.substr(3);
    second.links[body.name] = {0, Pose::Identity()};
  }
  world_.setRobot(std::make_shared<const LoadedRobot>(second));
  EXPECT_FALSE(mayTouch(tick(), "arm/hand", "obstacle/post")) << "two robots have such a link";
  EXPECT_TRUE(mayTouch(*tick_->snapshot, "second/hand", "obstacle/post"));
  bool has_map = false;
  for (const PairRule& rule : tick_->snapshot->structure().filter.rules()) {
    has_map = has_map || rule.second == "map/planning_scene" || rule.first == "map/planning_scene";
  }
  EXPECT_TRUE(has_map);
}

TEST_F(SceneRobots, ReadersThatDoNotUseTheMatrixSaySo) {
  NoeticScene scene = diff();
  scene.allowed_collision_matrix = matrixOf({"hand", "base"}, {{0, 1}});
  scene.link_scale = {{"hand", 1.5}};
  scene.link_padding = {{"hand", 0.5}};
  using Parts = std::vector<std::string>;
  const auto unused = [&](const Params& with) {
    const auto parts = unusedPartsOf(scene, with);
    return Parts(parts.begin(), parts.end());
  };
  EXPECT_EQ(unused(params()), Parts({"link_scale", "allowed_collision_matrix"}));
  EXPECT_EQ(unused(reader_params_), Parts({"link_scale"}));
  EXPECT_FALSE(SceneReader(params(), *phase_).extrasOf(scene).matrix.has_value());
}

TEST_F(SceneRobots, AReplyHasThePaddingsAndTheMatrix) {
  using Component = moveit::GetPlanningScene;
  EXPECT_EQ(pad({{"hand", 0.25}}), Code::ok);
  AllowedCollisionMatrix sent = matrixOf({"hand", "post", "base"}, {{0, 1}});
  sent.default_entry_names = {"post"};
  sent.default_entry_values = {1};
  EXPECT_EQ(allow(sent), Code::ok);
  tick();
  const NoeticScene none = planningScene(Component::object_names, *tick_, {}, world_.matrix());
  EXPECT_TRUE(none.link_padding.empty());
  EXPECT_TRUE(none.allowed_collision_matrix.entry_names.empty());
  const NoeticScene scene =
      planningScene(Component::allowed_collision_matrix | Component::padding_and_scale, *tick_, {}, world_.matrix());
  ASSERT_EQ(scene.link_padding.size(), 2u);
  EXPECT_EQ(scene.link_padding[1].link_name, "hand");
  EXPECT_EQ(scene.link_padding[1].value, 0.25);
  EXPECT_EQ(scene.link_scale[1].value, 1.0);
  EXPECT_EQ(matrixRulesOf(scene.allowed_collision_matrix, 100), world_.matrix()) << "sent back, it means the same";
}

/// Returns whether a matrix allows two of its names to touch, as MoveIt reads it.
bool mayTouch(const AllowedCollisionMatrix& matrix, const std::string& a, const std::string& b) {
  const auto indexOf = [](const std::vector<std::string>& names, const std::string& name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const std::size_t i = indexOf(matrix.entry_names, a), j = indexOf(matrix.entry_names, b);
  if (std::max(i, j) < matrix.entry_names.size()) {
    return matrix.entry_values[i].enabled[j] != 0 && matrix.entry_values[j].enabled[i] != 0;
  }
  bool known = false, all = true;
  for (const std::string& name : {a, b}) {
    const std::size_t entry = indexOf(matrix.default_entry_names, name);
    if (entry == matrix.default_entry_names.size()) continue;
    known = true;
    all = all && matrix.default_entry_values[entry] != 0;
  }
  return known && all;
}

TEST(MatrixRulesOf, MeanWhatTheMatrixMeans) {
  const std::vector<std::string> names{"a", "b", "c", "d", "e"};
  BodyList bodies;
  for (const std::string& name : names) {
    Body body;
    body.name = name;
    bodies.push_back(std::make_shared<const Body>(body));
  }
  std::size_t allowed = 0, pairs = 0;
  for (unsigned seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    AllowedCollisionMatrix matrix;
    for (const std::string& name : names) {
      if (random.chance(0.7)) matrix.entry_names.insert(matrix.entry_names.begin(), name);
      if (!random.chance(0.4)) continue;
      matrix.default_entry_names.push_back(name);
      matrix.default_entry_values.push_back(random.chance(0.5) ? 1 : 0);
    }
    matrix.entry_values.resize(matrix.entry_names.size());
    for (auto& row : matrix.entry_values) {
      for (std::size_t i = 0; i < matrix.entry_names.size(); ++i) row.enabled.push_back(random.chance(0.7) ? 1 : 0);
    }
    std::vector<PairRule> rules;
    for (const MatrixRule& rule : matrixRulesOf(matrix, 1000)) {
      rules.push_back({rule.first, rule.second.empty() ? "*" : rule.second, "", rule.allowed});
    }
    const PairFilter filter(bodies, PairKinds(), rules);
    for (std::uint32_t i = 0; i < names.size(); ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        const bool expected = mayTouch(matrix, names[i], names[j]);
        EXPECT_EQ(filter.allowed(i, j), expected) << names[i] << names[j];
        allowed += expected ? 1 : 0;
        ++pairs;
      }
    }
  }
  EXPECT_GT(allowed, pairs / 10);
  EXPECT_LT(allowed, pairs / 2);
}

TEST(MatrixRulesOf, RefusesAMatrixThatIsNotValid) {
  const auto refused = [](const AllowedCollisionMatrix& matrix, std::size_t most = 100) {
    return refusalOf([&] { matrixRulesOf(matrix, most); });
  };
  AllowedCollisionMatrix matrix = matrixOf({"a", "b", "c"}, {{0, 1}, {1, 2}});
  EXPECT_EQ(refused(matrix), Code::ok);
  EXPECT_EQ(refused(matrix, 2), Code::ok);
  EXPECT_EQ(refused(matrix, 1), Code::limit);
  EXPECT_EQ(refused(matrixOf({"a", "b", "a"}, {})), Code::dup_id);
  EXPECT_EQ(refused(matrixOf({"a", "b*"}, {})), Code::bad_id);
  EXPECT_EQ(refused(matrixOf({"a", "b\n"}, {})), Code::bad_id);
  matrix.entry_values[1].enabled.pop_back();
  EXPECT_EQ(refused(matrix), Code::parse);
  matrix.entry_values.pop_back();
  EXPECT_EQ(refused(matrix), Code::parse);
  AllowedCollisionMatrix defaults;
  defaults.default_entry_names = {"a"};
  EXPECT_EQ(refused(defaults), Code::parse);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
