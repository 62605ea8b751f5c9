// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <cfenv>
#include <functional>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "hgrid_proximity/distances/pair_meter.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::Random;

/// A scene whose results depend on rounding. Floats cannot represent its sizes and positions exactly. Some gaps are
/// close to the margin, and some numbers are denormal.
struct World {
  World() : scene(options()) {
    Random random(11);
    for (int i = 0; i < 60; ++i) ids.push_back(test::putRandom(scene, random, "o" + std::to_string(i)));
    const double tiny = 1e-310;
    for (int i = 0; i < 4; ++i)
      ids.push_back(test::put(scene, test::ball("tiny" + std::to_string(i)), test::at(tiny * i, 1.1 * i)));
  }
  static SceneOptions options() {
    SceneOptions options;
    options.margin = 0.1;
    options.origin << 0.3, -0.7, 1e-310;
    return options;
  }
  Scene scene;
  std::vector<BodyId> ids;
};

struct Outcome {
  std::vector<Aabb> boxes;
  std::vector<std::tuple<std::uint32_t, std::uint32_t, double, double>> pairs;
  std::vector<std::tuple<std::uint32_t, double, double, double>> hits;
  bool operator==(const Outcome& other) const {
    return boxes == other.boxes && pairs == other.pairs && hits == other.hits;
  }
};

/// Moves all bodies of a world, then commits and queries it. This runs all code of a tick and of a query.
Outcome outcomeOf(World& world) {
  Random random(12);
  for (const BodyId& id : world.ids) {
    Pose pose = world.scene.poseOf(id).world_from_body;
    pose.translation().x() = 0.1 * random.below(64) - 3.0;
    world.scene.place(id, pose, Time{2});
    world.scene.setState(id, Freshness::stale, 0.1);
  }
  const auto snapshot = world.scene.commit(Time{2}, {});
  Outcome outcome;
  outcome.boxes = snapshot->boxes();
  for (const NearPair& pair : snapshot->pairs())
    outcome.pairs.emplace_back(pair.first, pair.second, pair.gap, pair.margin);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d from(0.1 * i - 1, 0.3, -0.7), to(3.1, -0.1 * i, 1e-310);
    for (const QueryAnswer& answer :
         {query(*snapshot, Sphere{from, 0.1 * i}, {}), query(*snapshot, Segment{from, to, 0.01 * i}, {})}) {
      for (const QueryHit& hit : answer.hits) {
        outcome.hits.emplace_back(hit.body, hit.distance, hit.center_distance, std::isnan(hit.along) ? -1 : hit.along);
      }
    }
  }
  return outcome;
}

/// A floating-point mode of the processor. Only the code under test may run in the mode. The inputs of the test must be
/// computed in the normal mode, because otherwise they would differ, too.
struct Mode {
  const char* name;
  std::function<void()> set;
  std::function<bool()> is_set;
};

std::vector<Mode> modes() {
  std::vector<Mode> modes;
  const std::pair<const char*, int> roundings[] = {
      {"upward", FE_UPWARD}, {"downward", FE_DOWNWARD}, {"toward zero", FE_TOWARDZERO}};
  for (const auto& rounding : roundings) {
    const int mode = rounding.second;
    modes.push_back({rounding.first, [mode] { std::fesetround(mode); }, [mode] { return std::fegetround() == mode; }});
  }
#if defined(__SSE2__)
  modes.push_back({"denormals off", [] { _mm_setcsr(_mm_getcsr() | 0x8040u); },
                   [] { return (_mm_getcsr() & 0x8040u) == 0x8040u; }});
#endif
  return modes;
}

class Restored {
 public:
  Restored() { std::fegetenv(&before_); }
  ~Restored() { std::fesetenv(&before_); }

 private:
  std::fenv_t before_;
};

TEST(SceneFloatEnvironment, CommitAndQueriesFindTheSameInEveryRoundingMode) {
  World reference;
  const Outcome expected = outcomeOf(reference);
  ASSERT_GT(expected.pairs.size(), 50u);
  ASSERT_GT(expected.hits.size(), 50u);
  for (const Mode& mode : modes()) {
    SCOPED_TRACE(mode.name);
    World world;
    // The poses and queries are the same as in outcomeOf(). They are computed before the mode is set.
    Random random(12);
    std::vector<Pose> poses;
    for (const BodyId& id : world.ids) {
      Pose pose = world.scene.poseOf(id).world_from_body;
      pose.translation().x() = 0.1 * random.below(64) - 3.0;
      poses.push_back(pose);
    }
    std::vector<Segment> questions;
    for (int i = 0; i < 20; ++i) questions.push_back({{0.1 * i - 1, 0.3, -0.7}, {3.1, -0.1 * i, 1e-310}, 0.01 * i});
    std::vector<double> radii;
    for (int i = 0; i < 20; ++i) radii.push_back(0.1 * i);

    Outcome outcome;
    std::vector<QueryAnswer> answers;
    std::shared_ptr<const Snapshot> snapshot;
    bool kept = true;
    {
      const Restored restored;
      mode.set();
      for (std::size_t i = 0; i < poses.size(); ++i) {
        world.scene.place(world.ids[i], poses[i], Time{2});
        kept = kept && mode.is_set();
        world.scene.setState(world.ids[i], Freshness::stale, 0.1);
      }
      snapshot = world.scene.commit(Time{2}, {});
      kept = kept && mode.is_set();
      for (int i = 0; i < 20; ++i) {
        answers.push_back(query(*snapshot, Sphere{questions[std::size_t(i)].from, radii[std::size_t(i)]}, {}));
        kept = kept && mode.is_set();
        answers.push_back(query(*snapshot, questions[std::size_t(i)], {}));
        kept = kept && mode.is_set();
      }
    }
    EXPECT_TRUE(kept) << "a call has changed the floating-point mode of the caller";
    outcome.boxes = snapshot->boxes();
    for (const NearPair& pair : snapshot->pairs())
      outcome.pairs.emplace_back(pair.first, pair.second, pair.gap, pair.margin);
    for (const QueryAnswer& answer : answers) {
      for (const QueryHit& hit : answer.hits) {
        outcome.hits.emplace_back(hit.body, hit.distance, hit.center_distance, std::isnan(hit.along) ? -1 : hit.along);
      }
    }
    EXPECT_EQ(outcome.boxes, expected.boxes);
    EXPECT_EQ(outcome.pairs, expected.pairs);
    EXPECT_EQ(outcome.hits, expected.hits);
  }
}

// Successive poses differ by one unit in the last place. In this range of poses, a face of the box changes from one
// float to the next. If an addition were rounded differently, the face would change at another pose.
TEST(SceneFloatEnvironment, PlacingMakesTheSameBoxesInEveryRoundingMode) {
  std::vector<Pose> poses;
  double x = 0.5 + 0x1p-23 - 0x1p-44;
  for (int i = 0; i < 6000; ++i, x = test::stepped(x, 1)) poses.push_back(test::at(x, -x, 1e-310));
  const auto boxesIn = [&](const Mode* mode) {
    Scene scene{SceneOptions{}};
    const BodyId id = test::put(scene, test::ball("a"), test::at(0));
    std::vector<Aabb> boxes;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      {
        const Restored restored;
        if (mode != nullptr) mode->set();
        scene.place(id, poses[i], Time{1});
      }
      boxes.push_back(scene.commit(Time{1}, {})->boxes()[0]);
    }
    return boxes;
  };
  const std::vector<Aabb> expected = boxesIn(nullptr);
  EXPECT_NE(expected.front(), expected.back())
      << "no face of the box passes from one float to the next, so this test is useless";
  for (const Mode& mode : modes()) EXPECT_TRUE(boxesIn(&mode) == expected) << mode.name;
}

/// A scene of 2000 spheres whose gaps depend on rounding, and the exact distances of its pairs. Both use several
/// threads.
struct MeasuredWorld {
  static constexpr int kSpheres = 2000;
  explicit MeasuredWorld(const Mode* mode) {
    SceneOptions options;
    options.margin = 0.1;
    options.threads = 3;
    Scene scene(options);
    const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
    Random random(5);
    std::vector<Pose> later;
    std::vector<BodyId> ids;
    for (int i = 0; i < kSpheres; ++i) {
      Body body = test::ball(std::to_string(i), 0.1 + 0.001 * random.below(100));
      body.shapes[0].solid = narrow_phase->solidOf(body.shapes[0].shape);
      ids.push_back(test::put(scene, body, test::at(0, 0, 0)));
      later.push_back(test::at(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)));
    }
    {
      const Restored restored;
      if (mode != nullptr) mode->set();  // threads begin in the mode of the thread that creates them
      PairMeter meter(narrow_phase, {0.1, 0.0, 3});
      for (std::size_t i = 0; i < ids.size(); ++i) scene.place(ids[i], later[i], Time{2});
      snapshot = scene.commit(Time{2}, {});
      distances = meter.measure(*snapshot);
    }
  }
  std::shared_ptr<const Snapshot> snapshot;
  std::shared_ptr<const PairDistances> distances;
};

/// Claim: the threads of a tick and of the distances find the same as well, although they may begin in another mode.
TEST(SceneFloatEnvironment, ThreadsAndDistancesFindTheSameInEveryRoundingMode) {
  const MeasuredWorld expected(nullptr);
  ASSERT_GT(expected.snapshot->pairs().size(), 10000u);
  ASSERT_GT(expected.distances->pairs.size(), 1000u);
  for (const Mode& mode : modes()) {
    SCOPED_TRACE(mode.name);
    const MeasuredWorld world(&mode);
    ASSERT_EQ(world.snapshot->pairs().size(), expected.snapshot->pairs().size());
    for (std::size_t i = 0; i < expected.snapshot->pairs().size(); ++i) {
      const NearPair &a = world.snapshot->pairs()[i], &b = expected.snapshot->pairs()[i];
      ASSERT_TRUE(a.first == b.first && a.second == b.second && a.gap == b.gap);
    }
    ASSERT_EQ(world.distances->pairs.size(), expected.distances->pairs.size());
    for (std::size_t i = 0; i < expected.distances->pairs.size(); ++i) {
      const PairDistance &a = world.distances->pairs[i], &b = expected.distances->pairs[i];
      ASSERT_TRUE(a.first == b.first && a.second == b.second);
      ASSERT_EQ(a.proximity.distance, b.proximity.distance);
      ASSERT_EQ(a.proximity.on_first, b.proximity.on_first);
    }
  }
}

}  // namespace
}  // namespace hgrid
