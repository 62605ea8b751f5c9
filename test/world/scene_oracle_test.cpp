// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::Random;

/// The data of one body that the test gave to the scene. The test compares the snapshots with this data.
struct Told {
  Body body;
  BodyId id;
  bool placed = false;
  Pose pose = Pose::Identity();
  Time stamp{0};
};
using World = std::map<std::string, Told>;

void expectRecorded(const Snapshot& snapshot, const World& world, const SceneOptions& options) {
  const Structure& structure = snapshot.structure();
  ASSERT_EQ(structure.bodies.size(), world.size());
  ASSERT_EQ(structure.first_proxy.size(), world.size() + 1);
  ASSERT_EQ(structure.least_margin, options.margin);
  std::uint32_t i = 0, proxy = 0;
  for (const auto& entry : world) {  // the map and the bodies of the structure are sorted by name
    const Told& told = entry.second;
    ASSERT_EQ(structure.bodies[i].name, entry.first);
    ASSERT_EQ(structure.ids[i], told.id);
    ASSERT_EQ(structure.first_proxy[i], proxy);
    ASSERT_EQ(structure.margin[i], std::max(options.margin, told.body.margin));
    ASSERT_EQ(snapshot.poses()[i].state == Freshness::unplaced, !told.placed);
    if (told.placed) {
      ASSERT_EQ(snapshot.poses()[i].world_from_body.matrix(), told.pose.matrix());
      ASSERT_EQ(snapshot.poses()[i].stamp, told.stamp);
    }
    for (const BodyShape& shape : told.body.shapes) {
      ASSERT_EQ(structure.body_of_proxy[proxy], i);
      if (told.placed) {
        ASSERT_EQ(snapshot.boxes()[proxy],
                  boxOf(shape.shape, told.pose * shape.body_from_shape, shape.padding, options.origin));
      }
      ++proxy;
    }
    ++i;
  }
  ASSERT_EQ(structure.body_of_proxy.size(), proxy);
}

void expectGrownByTheRule(const Snapshot& snapshot, double cap, double after) {
  for (std::uint32_t i = 0; i < snapshot.poses().size(); ++i) {
    const BodyPose& pose = snapshot.poses()[i];
    const double speed = snapshot.structure().bodies[i].max_speed;
    const bool young = pose.state <= Freshness::late && pose.age <= after;
    if (young || pose.state == Freshness::unplaced) {
      ASSERT_EQ(pose.growth, 0.0);
    } else if (pose.state <= Freshness::lost) {
      ASSERT_EQ(pose.growth, pose.age > 0 ? std::min(cap, speed * pose.age) : 0.0);
    } else {
      ASSERT_GE(pose.growth, 0.0);
      ASSERT_LE(pose.growth, cap);
    }
  }
}

class Story {
 public:
  explicit Story(unsigned seed) : random_(seed), scene_(optionsOf(random_, options_)) {}

  void run(int ticks) {
    for (int tick = 1; tick <= ticks; ++tick) {
      SCOPED_TRACE("tick " + std::to_string(tick));
      for (int changes = random_.below(10); changes > 0; --changes) change(tick);
      const auto snapshot = scene_.commit(Time{tick}, {});
      ASSERT_EQ(snapshot->sequence(), std::uint64_t(tick));
      ASSERT_EQ(snapshot->stamp(), Time{tick});
      ASSERT_NO_FATAL_FAILURE(expectRecorded(*snapshot, world_, options_));
      ASSERT_NO_FATAL_FAILURE(expectGrownByTheRule(*snapshot, options_.growth_cap, options_.growth_after));
      ASSERT_NO_FATAL_FAILURE(test::expectPairsOfTheOracle(*snapshot, options_.margin));
      ASSERT_NO_THROW(snapshot->broadPhase().checkInvariants());
      pairs_ += snapshot->pairs().size();
      if (random_.chance(0.3)) kept_.push_back(snapshot);  // keeps some snapshots for a while, like a reader
      if (kept_.size() > 3) kept_.erase(kept_.begin());
    }
  }
  std::size_t pairs() const { return pairs_; }

 private:
  static const SceneOptions& optionsOf(Random& random, SceneOptions& options) {
    options.margin = random.chance(0.2) ? 0.0 : test::sixtyFourths(random, 0, 0.5);
    options.growth_cap = test::sixtyFourths(random, 0, 2);
    options.finest_edge = random.chance(0.5) ? 0.0 : random.logUniform(0.001, 100);
    if (random.chance(0.5)) options.origin << random.uniform(-10, 10), 1.5, -7;
    options.threads = 1 + random.below(2);
    return options;
  }

  void change(int tick) {
    const int kind = random_.below(100);
    if (kind < 30 || world_.empty()) {
      Told told;
      const std::string name = "o" + std::to_string(random_.below(60));
      if (world_.count("obstacle/" + name) != 0) return;
      told.body = test::randomBody(random_, name);
      told.id = scene_.add(told.body);
      world_[told.body.name] = told;
      return;
    }
    auto chosen = world_.begin();
    std::advance(chosen, random_.below(int(world_.size())));
    Told& told = chosen->second;
    if (kind < 38) {
      scene_.remove(told.id);
      world_.erase(chosen);
    } else if (kind < 80) {
      told.pose = test::randomPose(random_, 3.0);
      const Pose before = scene_.poseOf(told.id).world_from_body;
      if (random_.chance(0.2)) told.pose = before;  // the same pose with a later stamp
      if (random_.chance(0.2)) {
        told.pose = before;
        told.pose.translation().x() += 1e-9;  // a tiny move that must not be ignored
      }
      told.stamp = Time{tick};
      told.placed = true;
      scene_.place(told.id, told.pose, told.stamp);
    } else {
      const auto state = static_cast<Freshness>(random_.below(6));
      scene_.setState(told.id, state, test::sixtyFourths(random_, 0, 3), std::uint32_t(random_.below(3)));
    }
  }

  Random random_;
  SceneOptions options_;
  Scene scene_;
  World world_;
  std::vector<std::shared_ptr<const Snapshot>> kept_;
  std::size_t pairs_ = 0;
};

TEST(SceneOracle, EverySnapshotOfALongStoryHasThePairsOfABruteForceScan) {
  std::size_t pairs = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Story story(seed);
    ASSERT_NO_FATAL_FAILURE(story.run(40));
    pairs += story.pairs();
  }
  EXPECT_GT(pairs, 10000u);
}

TEST(SceneOracle, MarginsEqualToTheGapCountAndLessDoesNot) {
  for (const double margin : {0.0, 0.25, 5.0}) {
    SceneOptions options;
    options.margin = margin;
    Scene scene(options);
    const BodyId left = test::put(scene, test::ball("left"), test::at(0)),
                 right = test::put(scene, test::ball("right"), test::at(9));
    const auto apart = scene.commit(Time{1}, {});
    const float edge = apart->boxes()[0].max.x();
    // Moves the right sphere in tiny steps. Its gap changes between a little less and a little more than the margin.
    double x = double(edge) + margin + 0.5;
    for (int i = 0; i < 40; ++i) {
      scene.place(right, test::at(x), Time{i + 2});
      const auto snapshot = scene.commit(Time{i + 2}, {});
      const double gap = double(snapshot->boxes()[1].min.x()) - double(snapshot->boxes()[0].max.x());
      ASSERT_EQ(snapshot->pairs().size(), gap <= margin ? 1u : 0u) << gap << " at margin " << margin;
      x += 3e-8 * (margin + 0.5) * (gap <= margin ? 1 : -1);
    }
    scene.remove(left);
  }
}

}  // namespace
}  // namespace hgrid
