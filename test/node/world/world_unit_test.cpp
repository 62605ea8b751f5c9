// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: if memory runs out during a change or a tick of the world, later ticks are not affected. The tests run a
// script of changes and ticks many times. Each time, another allocation of one step fails. Then the step is either
// repeated or left out. Every later tick must be the same as in a world in which no allocation failed. The tests need
// no ROS master.
#include <gtest/gtest.h>
#include <ros/console.h>

#include <functional>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/world/world.h"
#include "test/node/support/settings.h"
#include "test/node/support/transform_views.h"
#include "test/support/failing_allocations.h"
#include "test/support/maps.h"
#include "test/support/refusals.h"
#include "test/support/rules.h"
#include "test/support/told.h"

namespace hgrid {
namespace {

using Ticks = std::vector<std::shared_ptr<const Tick>>;

struct Step {
  std::string name;
  std::function<void(World&, Ticks&)> play;
  bool may_fail = true;
  bool may_be_left_out = true;
};

/// Returns the moment `time` [s] after the start of both clocks. `jump` [s] shifts ROS time only.
Moment momentAt(double time, double jump = 0.0) {
  Moment moment;
  moment.ros = Time(std::int64_t(1e9 * (1000.0 + time + jump)));
  moment.steady = std::chrono::steady_clock::time_point(std::chrono::milliseconds(std::int64_t(1e3 * (50.0 + time))));
  return moment;
}

LoadedRobot armOf(const std::string& name, double margin) {
  LoadedRobot robot;
  robot.name = name;
  robot.root_frame = name + "_base";
  robot.bodies = test::armBodies(name);
  for (std::size_t i = 0; i < robot.bodies.size(); ++i) {
    robot.bodies[i].margin = margin;
    if (robot.bodies[i].frame == "shoulder") {  // the link moves together with the link before it
      robot.groups.back().members.push_back({i, test::at(0.1)});
    } else {
      robot.groups.push_back({name + "_" + robot.bodies[i].frame, {{i, Pose::Identity()}}});
    }
    robot.links[robot.bodies[i].name] = {robot.groups.size() - 1, robot.groups.back().members.back().second};
  }
  robot.warnings = {"of margin " + std::to_string(margin)};
  return robot;
}

LoadedMap mapOf(const std::string& name, double x, unsigned seed) {
  test::Random random(seed);
  LoadedMap map;
  map.params.name = name;
  map.params.frame_from_map = test::at(x);
  map.cells = test::cellsOf(0.25, test::randomVoxels(random, 20, 4));
  return map;
}

LoadedCloud cloudOf(double time, unsigned seed) {
  test::Random random(seed);
  LoadedCloud cloud;
  cloud.name = "eye";
  cloud.lifetime = 1000.0;
  cloud.cells = test::cellsOf(0.25, test::randomVoxels(random, 20, 4));
  cloud.stamp = momentAt(time).ros;
  cloud.received = momentAt(time).steady;
  return cloud;
}

Step settingRobot(const std::string& name, double margin) {
  return {"setRobot " + name,
          [=](World& world, Ticks&) { world.setRobot(std::make_shared<const LoadedRobot>(armOf(name, margin))); }};
}
Step settingMap(const std::string& name, double x, unsigned seed) {
  const LoadedMap map = mapOf(name, x, seed);
  return {"setMap " + name, [=](World& world, Ticks&) { world.setMap(map); }};
}
Step clearingMap(const std::string& name) {
  return {"clearMap " + name, [=](World& world, Ticks&) {
            try {
              world.clearMap(name);
            } catch (const Refusal&) {  // the step that sets this map was left out
            }
          }};
}
Step settingCloud(double time, unsigned seed) {
  const LoadedCloud cloud = cloudOf(time, seed);
  return {"setCloud", [=](World& world, Ticks&) { world.setCloud(cloud); }};
}
Step settingRules(const std::vector<PairRule>& rules) {
  return {"setRules", [=](World& world, Ticks&) { world.setRules({PairFilter({}, {}, rules), 0}); }};
}
ObstacleChange adding(const std::string& name, double x, double lifetime = 0.0) {
  auto added = std::make_shared<RequestedObstacle>();
  added->body = test::ball(name, 0.1);
  added->place.frame_from_body = test::at(x);
  added->owner = "a program with a long name";
  added->lifetime = std::chrono::nanoseconds(std::int64_t(1e9 * lifetime));
  ObstacleChange change;
  change.name = added->body.name;
  change.added = added;
  return change;
}
/// Returns a change without a value.
ObstacleChange without(ObstacleChange::Kind kind, const std::string& name) {
  ObstacleChange change;
  change.kind = kind;
  change.name = "obstacle/" + name;
  return change;
}
ObstacleChange moving(const std::string& name, double x) {
  ObstacleChange change = without(ObstacleChange::Kind::move, name);
  change.place.frame_from_body = test::at(x);
  return change;
}
ObstacleChange attaching(const std::string& name, const std::string& link) {
  auto attachment = std::make_shared<Attachment>();
  attachment->link = link;
  attachment->link_from_body = test::at(0.1);
  attachment->touch = {"arm/*", "obstacle/a name that needs memory of its own"};
  ObstacleChange change = without(ObstacleChange::Kind::attach, name);
  change.attachment = attachment;
  return change;
}
Step applying(const std::vector<ObstacleChange>& changes, const Moment& now, bool complete_set = false) {
  ObstacleChanges all{changes, std::nullopt};
  if (complete_set) all.complete_set_of = "a program with a long name";
  return {"applyObstacles", [=](World& world, Ticks&) {
            try {
              world.applyObstacles(all, now.ros);
            } catch (const Refusal&) {  // a step with an earlier change was left out
            }
          }};
}
Step applyingRobots(const std::vector<std::pair<RobotOperation, std::string>>& requested) {
  RobotChanges changes;
  for (const auto& [operation, name] : requested) {
    RobotChange change;
    change.operation = operation;
    change.name = name;
    if (operation == RobotOperation::add) {
      RobotSpec spec;
      spec.params = {name, "a description with a long name", "", name};
      change.spec = std::make_shared<const RobotSpec>(spec);
      change.model = std::make_shared<const LoadedRobot>(armOf(name, 0.2));
    }
    changes.push_back(change);
  }
  return {"applyRobots", [=](World& world, Ticks&) {
            try {
              world.applyRobots(changes);
            } catch (const Refusal&) {  // a step with an earlier change was left out
            }
          }};
}
Step settingMissing(const SourceId& source) {
  const std::string sentence = "NOT_READY " + source.name + ": a sentence of some length";
  return {"setMissing " + source.name, [=](World& world, Ticks&) { world.setMissing(source, sentence); }};
}
Step resetting() {
  return {"reset", [](World& world, Ticks&) { world.reset(); }};
}
Step ticking(const Moment& now) {
  return {"tick", [=](World& world, Ticks& ticks) { ticks.push_back(world.tick(now)); }};
}

/// Returns the step that sends transforms of all frames. The first link of each robot moves, the others are fixed to
/// it.
Step hearing(const Moment& now, double x) {
  tf2_msgs::TFMessage moving, standing;
  for (const std::string robot : {"arm", "other"}) {
    for (const std::string link : {"base", "elbow", "hand"}) {
      geometry_msgs::TransformStamped transform;
      transform.header.frame_id = link == "base" ? "world" : robot + "_base";
      transform.header.stamp.fromNSec(std::uint64_t(now.ros.count()));
      transform.child_frame_id = robot + "_" + link;
      transform.transform.rotation.w = 1.0;
      transform.transform.translation.x = link == "base" ? (robot == "arm" ? x : -x) : 0.2 * double(link.size()) - 0.8;
      (link == "base" ? moving : standing).transforms.push_back(transform);
    }
  }
  return {"transforms",
          [=](World& world, Ticks&) {
            world.transforms().take(test::viewsOf(standing), true, "/publisher", now);
            world.transforms().take(test::viewsOf(moving), false, "/publisher", now);
          },
          false};
}

Params paramsOfTheWorld() {
  Params params;
  params.world_frame = "world";
  params.margin = 0.2;
  params.horizon = 0.1;
  for (const char* robot : {"arm", "other"}) params.robots.push_back({robot, "", "", ""});
  params.clouds.push_back({"eye"});
  ObstacleParams post{test::ball("post", 0.3)}, gripped{test::ball("gripped", 0.1)}, twin{test::ball("post", 0.5)};
  post.body.frame.clear();
  gripped.body.frame = "arm_hand";
  // The world refuses `twin`, because `post` has the same name.
  for (const ObstacleParams& obstacle : {post, gripped, twin}) params.obstacles.push_back(obstacle);
  return params;
}

std::vector<Step> script() {
  std::vector<Step> steps;
  double time = 0.0, jump = 0.0;
  const auto tick = [&](double x) {
    time += 0.02;
    steps.push_back(hearing(momentAt(time, jump), x));
    steps.push_back(ticking(momentAt(time, jump)));
  };
  steps.push_back(settingRobot("arm", 0.1));
  tick(0.0);
  steps.push_back(settingMissing(SourceId::ofRobot("other")));
  steps.push_back(settingMap("room", 0.5, 1));
  tick(0.1);
  steps.push_back(settingRobot("other", 0.0));
  steps.push_back(settingRules({test::until(test::allow("arm/*", "other/*"), momentAt(time + 0.05).steady)}));
  tick(0.2);
  steps.push_back(settingRobot("arm", 0.4));
  steps.push_back(settingCloud(time, 2));
  tick(2.0);
  tick(-2.0);  // the rule has expired
  const auto now = [&] { return momentAt(time, jump); };
  using Kind = ObstacleChange::Kind;
  steps.push_back(applying({adding("part with a name of some length", 0.6), adding("lid", 0.7, 0.03),
                            adding("case", 0.8), moving("post", 0.2), without(Kind::remove, "gripped")},
                           now()));
  tick(0.1);
  steps.push_back(
      applying({attaching("part with a name of some length", "arm/hand"), attaching("case", "arm/base")}, now()));
  tick(0.2);  // the lifetime of the lid has ended
  steps.push_back(settingRobot("arm", 0.3));
  tick(0.3);
  steps.push_back(applying({without(Kind::detach, "case"), adding("plate", 0.5)}, now()));
  tick(0.2);
  steps.push_back(applying({adding("plate", 0.5)}, now(), true));
  steps.push_back(applyingRobots({{RobotOperation::declare_absent, "other"}, {RobotOperation::add, "third robot"}}));
  tick(0.25);
  steps.push_back(applyingRobots({{RobotOperation::declare_present, "other"},
                                  {RobotOperation::declare_absent, "arm"},
                                  {RobotOperation::remove, "third robot"}}));
  tick(0.3);
  steps.push_back(settingMap("room", -0.5, 3));
  steps.push_back(settingMap("shelf", 1.0, 4));
  steps.push_back(settingCloud(time, 5));
  tick(0.3);
  steps.push_back(resetting());
  tick(0.2);
  tick(0.2);
  steps.back().may_be_left_out = false;  // after the jump of the clock, only the poses of the last tick are known
  jump = -5.0;
  tick(0.1);
  steps.back().may_be_left_out = false;  // all transforms that arrive before the node notices the jump are dropped
  steps.push_back(clearingMap("room"));
  steps.push_back(clearingMap(""));
  tick(0.0);
  return steps;
}

struct Told {
  test::Told snapshot;
  std::uint64_t epoch = 0;
  std::vector<std::string> not_ready, troubles, warnings, missing_frames;
};

Told tell(const Tick& tick) {
  Told told;
  if (tick.snapshot) told.snapshot = test::tell(*tick.snapshot);
  told.epoch = tick.epoch;
  told.not_ready = tick.not_ready;
  for (const BodyTrouble& trouble : tick.troubles) told.troubles.push_back(trouble.name + " " + name(trouble.state));
  told.warnings = tick.models->warnings;
  told.missing_frames = tick.missing_frames;
  return told;
}

void expectEqual(const Told& told, const Told& expected) {
  ASSERT_EQ(told.epoch, expected.epoch);
  ASSERT_EQ(told.not_ready, expected.not_ready);
  ASSERT_EQ(told.troubles, expected.troubles);
  ASSERT_EQ(told.warnings, expected.warnings);
  ASSERT_EQ(told.missing_frames, expected.missing_frames);
  test::expectEqual(told.snapshot, expected.snapshot);
}

constexpr std::size_t kNone = ~std::size_t{0};

/// A fault that the test causes: the k-th allocation of a step fails.
struct Fault {
  std::size_t step = kNone, k = 0;
  test::Failing which = test::Failing::one;
  bool again = true;  // whether the failed step is repeated at once; otherwise it is left out
};

struct Played {
  std::vector<Told> told;  // contents of all ticks from a given step on
  bool failed = false;
};

class WorldFailedAllocation : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {  // turns off the log, because each run of the script logs refusals
    if (ros::console::set_logger_level(ROSCONSOLE_DEFAULT_NAME, ros::console::levels::Fatal)) {
      ros::console::notifyLoggerLevelsChanged();
    }
  }

  Played play(std::size_t from, const Fault& fault, std::size_t left_out = kNone) const {
    Played played;
    Ledger ledger;
    World world(test::settingsOf(params_), GetParam(), 5, ledger, narrow_phase_);
    Ticks ticks;
    ticks.reserve(steps_.size());
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      if (i == left_out) continue;
      const std::size_t before = ticks.size();
      const auto act = [&] { steps_[i].play(world, ticks); };
      if (fault.step == i) {
        played.failed = test::failsAt(fault.k, fault.which, act);
        if (played.failed && fault.again) act();
      } else {
        act();
      }
      if (ticks.size() > before && i >= from) played.told.push_back(tell(*ticks.back()));
      if (ticks.size() > 1) ticks[ticks.size() - 2].reset();
    }
    return played;
  }

  /// Lets each allocation of a step fail, one after the other. @returns the number of allocations
  std::size_t tryStep(std::size_t step) const {
    const Played all_well = play(step, {}), without = play(step, {}, step);
    bool failed = true;
    std::size_t k = 1;
    for (; failed; k += every_) {
      failed = false;
      for (const bool again : {true, false}) {
        if (!again && !steps_[step].may_be_left_out) continue;
        SCOPED_TRACE("step " + std::to_string(step) + " (" + steps_[step].name + "), allocation " + std::to_string(k) +
                     (again ? ", then repeated" : ", then left out"));
        const Played played =
            play(step, {step, k, k % 2 == 0 ? test::Failing::from_then_on : test::Failing::one, again});
        failed = failed || played.failed;
        const Played& expected = played.failed && !again ? without : all_well;
        EXPECT_EQ(played.told.size(), expected.told.size());
        for (std::size_t i = 0; i < played.told.size() && !HasFailure(); ++i) {
          SCOPED_TRACE("tick " + std::to_string(i));
          expectEqual(played.told[i], expected.told[i]);
        }
        if (HasFailure()) return k;
      }
    }
    return k - every_ - 1;
  }

  /// Of how many allocations one fails. An odd number, because even and odd allocations fail in different ways.
  const std::size_t every_ = static_cast<std::size_t>(test::countFromEnvironment("HGRID_TEST_ALLOCATIONS", 1));
  Params params_ = paramsOfTheWorld();
  std::shared_ptr<NarrowPhase> narrow_phase_ = makeCoreNarrowPhase();
  std::vector<Step> steps_ = script();
};

TEST_P(WorldFailedAllocation, LeavesNoTraceInLaterTicks) {
  std::size_t failures = 0;
  for (std::size_t step = 0; step < steps_.size(); ++step) {
    if (!steps_[step].may_fail) continue;
    failures += tryStep(step);
    if (HasFailure()) return;
  }
  EXPECT_GT(failures, 500u) << "the test is useful only if many allocations fail";
}

/// Checks that the script produces pairs, events and several epochs.
TEST_P(WorldFailedAllocation, IsTriedOnAWorldThatHasPairsEventsAndSeveralEpochs) {
  const Played played = play(0, {});
  std::size_t pairs = 0, events = 0;
  for (const Told& told : played.told) {
    pairs += told.snapshot.pairs.empty() ? 0 : 1;
    events += told.snapshot.events.size();
  }
  EXPECT_EQ(pairs, played.told.size());
  EXPECT_GT(events, 20u);
  EXPECT_EQ(played.told.back().epoch, 7u) << "one ~reset and one jump of the clock";
}

TEST(WorldMaps, AreAtMostMaxMaps) {
  Params params;
  params.world_frame = "world";
  params.max_maps = 2;
  Ledger ledger;
  World world(test::settingsOf(params), false, 1, ledger, makeCoreNarrowPhase());
  world.setMap(mapOf("hall", 0.0, 1));
  world.setMap(mapOf("shelf", 1.0, 2));
  std::string sentence;
  EXPECT_EQ(test::refusalOf([&] { world.setMap(mapOf("third", 2.0, 3)); }, &sentence), Code::limit);
  EXPECT_TRUE(test::says(sentence, "map 'third' would be one map too many; ~limits/max_maps is 2"));
  world.setMap(mapOf("shelf", 3.0, 4));  // replaces a map
  world.clearMap("hall");
  world.setMap(mapOf("third", 2.0, 3));
}

INSTANTIATE_TEST_SUITE_P(Clock, WorldFailedAllocation, ::testing::Values(false, true),
                         [](const auto& info) { return info.param ? "Simulated" : "Wall"; });

}  // namespace
}  // namespace hgrid
