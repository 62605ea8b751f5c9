// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/states/checker_cache.h"

#include <gtest/gtest.h>

#include "hgrid_proximity/adapters/urdf.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/refusals.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

const char* const kOneJoint =
    "<robot name='r'><link name='base'/><link name='arm'><collision><geometry><sphere radius='0.1'/></geometry>"
    "</collision></link><joint name='shoulder' type='continuous'><parent link='base'/><child link='arm'/></joint>"
    "</robot>";

class CheckerCacheTest : public ::testing::Test {
 protected:
  CheckerCacheTest() {
    const auto read = std::make_shared<ReadDescription>();
    read->model = readUrdf(kOneJoint, nullptr);
    read->joints = std::make_shared<const RobotJoints>(read->model, nullptr, DescriptionLimits{});
    robot_.name = "robot";
    robot_.read = read;
    Body link = test::ball("arm", 0.1);
    link.name = "robot/arm";
    link.robot = "robot";
    link.kind = BodyKind::link;
    link.link = 1;
    link.rigid_group = read->model.links[1].rigid_group;
    for (BodyShape& shape : link.shapes) shape.solid = narrow_phase_->solidOf(shape.shape);
    arm_ = test::put(scene_, link, Pose::Identity());
  }
  Tick tick() {
    scene_.place(arm_, Pose::Identity(), Time{++time_});
    Tick tick;
    tick.snapshot = scene_.commit(Time{time_}, {});
    return tick;
  }
  const StateChecker* get(const Tick& tick, const StateCheckerOptions& options = {}) {
    return cache_.get(tick, robot_, options, narrow_phase_).get();
  }

  LoadedRobot robot_;
  std::shared_ptr<NarrowPhase> narrow_phase_ = makeCoreNarrowPhase();
  Scene scene_{SceneOptions{}};
  BodyId arm_{};
  int time_ = 0;
  CheckerCache cache_;
};

TEST_F(CheckerCacheTest, ReturnsTheSameCheckerForTheSameQuestionAboutTheSameTick) {
  const Tick first = tick(), second = tick();
  StateCheckerOptions options;
  options.group = {"shoulder"};
  const StateChecker* const checker = get(first);
  const StateChecker* const of_group = get(first, options);
  const StateChecker* const later = get(second);
  EXPECT_EQ(get(first), checker);
  EXPECT_EQ(get(first, options), of_group);
  EXPECT_EQ(get(second), later);
  EXPECT_NE(of_group, checker);
  EXPECT_EQ(&checker->snapshot(), first.snapshot.get());
  EXPECT_EQ(&later->snapshot(), second.snapshot.get());
  robot_.name = "nobody";
  EXPECT_EQ(test::refusalOf([&] { get(first); }), Code::unknown_id);
}

/// Claim: checkers that no request uses are dropped, so they do not keep their snapshots alive.
TEST_F(CheckerCacheTest, DropsWhatIsNotUsed) {
  std::vector<std::weak_ptr<const StateChecker>> checkers;
  for (std::size_t i = 0; i < CheckerCache::kMost + 2; ++i)
    checkers.push_back(cache_.get(tick(), robot_, {}, narrow_phase_));
  EXPECT_TRUE(checkers[1].expired());
  EXPECT_FALSE(checkers[2].expired());
  cache_.dropUnused();
  EXPECT_FALSE(checkers[2].expired());
  cache_.dropUnused(CheckerCache::Clock::now() + std::chrono::milliseconds(1100));
  for (const auto& checker : checkers) EXPECT_TRUE(checker.expired());
}

}  // namespace
}  // namespace hgrid
