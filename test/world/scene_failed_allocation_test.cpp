// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: if memory runs out during a change or a commit of a scene, the scene does not change. The tests run scripts of
// changes and commits many times. Each time another memory allocation fails. Then the failed step is either repeated or
// left out. Every later snapshot must equal the snapshot of a scene in which no allocation failed.
#include <gtest/gtest.h>

#include <functional>
#include <iterator>
#include <thread>

#include "test/support/buildings.h"
#include "test/support/failing_allocations.h"
#include "test/support/maps.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"
#include "test/support/told.h"

namespace hgrid {
namespace {

using Snapshots = std::vector<std::shared_ptr<const Snapshot>>;

/// A step of a script. It finds its bodies by name, so it can run even if an earlier step was left out.
struct Step {
  std::string name;
  std::function<void(Scene&, Snapshots&)> play;
};

// The functions below create the steps of a script.

Step adding(const Body& body) {
  return {"add " + body.name, [=](Scene& scene, Snapshots&) {
            BodyId id;
            if (!scene.find(body.name, id)) scene.add(body);
          }};
}

Step removing(const std::string& name) {
  return {"remove " + name, [=](Scene& scene, Snapshots&) {
            BodyId id;
            if (scene.find(name, id)) scene.remove(id);
          }};
}

/// Replaces the bodies of a source by other bodies, like the reload of a robot or a map.
Step exchanging(const std::string& source, const std::vector<Body>& in, const std::vector<std::string>& names) {
  return {"exchange " + source, [=](Scene& scene, Snapshots&) {
            std::vector<BodyId> out;
            for (const std::string& name : names) {
              BodyId id;
              if (name.compare(0, source.size() + 1, source + "/") == 0 && scene.find(name, id)) out.push_back(id);
            }
            scene.exchange(out, in);
          }};
}

/// As exchanging(), but with Scene::prepare() and Scene::exchangePrepared().
Step exchangingPrepared(const std::string& source, const std::vector<Body>& in, const std::vector<std::string>& names) {
  return {"exchange prepared " + source, [=](Scene& scene, Snapshots& snapshots) {
            std::vector<BodyId> out;
            std::vector<std::string> leaving;
            for (const std::string& name : names) {
              BodyId id;
              if (name.compare(0, source.size() + 1, source + "/") != 0 || !scene.find(name, id)) continue;
              out.push_back(id);
              leaving.push_back(name);
            }
            const std::size_t newest = snapshots.size() - 1;
            scene.exchangePrepared(out, scene.prepare(*snapshots[newest], leaving, in));
          }};
}

Step settingCells(const std::string& name, const std::shared_ptr<const MapCells>& cells) {
  return {"cells of " + name, [=](Scene& scene, Snapshots&) {
            BodyId id;
            if (scene.find(name, id)) scene.setCells(id, cells);
          }};
}

Step settingRules(const std::vector<PairRule>& rules) {
  return {"rules", [=](Scene& scene, Snapshots&) { scene.setRules(rules); }};
}

struct Placing {
  std::string name;
  Pose pose;
  Freshness state;
  double age;
};

Step placing(const std::vector<Placing>& placings, Time stamp) {
  return {"place", [=](Scene& scene, Snapshots&) {
            for (const Placing& one : placings) {
              BodyId id;
              if (!scene.find(one.name, id)) continue;
              scene.place(id, one.pose, stamp);
              scene.setState(id, one.state, one.age);
            }
          }};
}

/// Commits the scene. Keeps the snapshot for a while; the scene may reuse the snapshot after its release.
Step committing(Time stamp, const std::vector<SourceGap>& gaps) {
  return {"commit", [=](Scene& scene, Snapshots& snapshots) {
            const std::shared_ptr<const Snapshot> snapshot = scene.commit(stamp, gaps);
            snapshots.push_back(snapshot);
          }};
}

// Scripts and the class that writes them.

struct Script {
  SceneOptions options;
  std::vector<Step> steps;
};

/// Writes a random script about a small world in motion: an arm, obstacles, two maps, rules and margins.
class Writer {
 public:
  explicit Writer(unsigned seed) : random_(seed) {
    Script& s = script_;
    s.options.horizon = seed % 2 == 0 ? 0.0 : 0.5;
    s.options.threads = random_.between(1, 2);
    s.options.event_hysteresis = 0.05;
    if (seed > 2) s.options.building = test::twoRooms();
    if (random_.chance(0.5)) s.options.pair_margins.push_back({"arm/*", "obstacle/*", 0.5});
    for (const Body& body : test::armBodies("arm")) add(body);
    for (int i = 0; i < 4; ++i) add(test::randomBody(random_, "thing" + std::to_string(i)));
    for (const char* map : {"room", "shelf"}) addMap(map, random_.chance(0.5) ? Mobility::fixed : Mobility::moving);
    moveAll();
    commit();
    moveAll();
    commit();
  }

  Script written(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      change();
      moveAll();
      commit();
    }
    return script_;
  }

 private:
  void add(const Body& body) {
    names_.push_back(body.name);
    script_.steps.push_back(adding(body));
  }
  void addMap(const std::string& map, Mobility mobility) {
    add(test::mapBody(map, mobility));
    script_.steps.push_back(settingCells("map/" + map, cells()));
  }
  std::shared_ptr<const MapCells> cells() { return test::cellsOf(0.25, test::randomVoxels(random_, 30, 8)); }

  void change() {
    switch (random_.below(8)) {
      case 0:
        return add(test::randomBody(random_, "new" + std::to_string(++number_)));
      case 1:
        return script_.steps.push_back(removing("obstacle/thing" + std::to_string(random_.below(4))));
      case 2: {
        std::vector<Body> bodies = test::armBodies("arm");
        for (Body& body : bodies) body.margin = test::sixtyFourths(random_, 0, 1);
        return script_.steps.push_back(exchanging("arm", bodies, names_));
      }
      case 3: {
        std::vector<Body> bodies = test::armBodies("arm");
        for (Body& body : bodies) body.margin = test::sixtyFourths(random_, 0, 1);
        return script_.steps.push_back(exchangingPrepared("arm", bodies, names_));
      }
      case 4:
        return script_.steps.push_back(
            exchanging("map", {test::mapBody("room", Mobility::moving), test::mapBody("shelf")}, names_));
      case 5:
        return script_.steps.push_back(settingCells(random_.chance(0.5) ? "map/room" : "map/shelf", cells()));
      case 6:
        return script_.steps.push_back(
            settingRules({test::allow("arm/*", random_.chance(0.5) ? "map/*" : "obstacle/*")}));
      default:
        return;  // nothing changes except the poses
    }
  }

  void moveAll() {
    std::vector<Placing> placings;
    for (const std::string& name : names_) {
      if (random_.chance(0.2)) continue;
      const bool old = random_.chance(0.2);
      placings.push_back({name, test::randomPose(random_, 2.0), old ? Freshness::stale : Freshness::fresh,
                          old ? random_.uniform(0, 1) : 0.0});
    }
    script_.steps.push_back(placing(placings, Time{1000000 * ++stamp_}));
  }
  void commit() {
    std::vector<SourceGap> gaps;
    if (random_.chance(0.2))
      gaps.push_back({"other", "other/*", "NOT_READY robot 'other': its description was not read yet"});
    script_.steps.push_back(committing(Time{1000000 * stamp_}, gaps));
  }

  test::Random random_;
  Script script_;
  std::vector<std::string> names_;
  int stamp_ = 0, number_ = 0;
};

/// A fault that the test causes: the k-th memory allocation of a step fails.
struct Fault {
  std::size_t step, k;
  test::Failing which;
  bool again;  // whether the failed step is repeated at once; otherwise it is left out
};

/// The contents of the snapshots after a certain step, and whether the fault has occurred.
struct Played {
  std::vector<test::Told> told;
  bool failed = false;
};

constexpr std::size_t kNone = ~std::size_t{0};

Played play(const Script& script, std::size_t from, const Fault* fault, std::size_t left_out = kNone) {
  Played played;
  Scene scene(script.options);
  scene.beginEpoch(7);
  Snapshots snapshots;
  snapshots.reserve(script.steps.size());
  for (std::size_t i = 0; i < script.steps.size(); ++i) {
    if (i == left_out) continue;
    const std::size_t before = snapshots.size();
    const auto act = [&] { script.steps[i].play(scene, snapshots); };
    if (fault != nullptr && fault->step == i) {
      played.failed = test::failsAt(fault->k, fault->which, act);
      if (played.failed && fault->again) act();
    } else {
      act();
    }
    if (snapshots.size() > before && i >= from) played.told.push_back(test::tell(*snapshots.back()));
    if (snapshots.size() > 2) snapshots[snapshots.size() - 3].reset();
  }
  return played;
}

/// Returns the index of the first step in which allocations fail. The steps before it only build the world.
std::size_t firstTried(const Script& script) {
  std::size_t commits = 0;
  for (std::size_t i = 0; i < script.steps.size(); ++i) {
    commits += script.steps[i].name == "commit" ? 1 : 0;
    if (commits == 1) return i;
  }
  return 0;
}

void tryAll(const Script& script, std::size_t& failures) {
  for (std::size_t step = firstTried(script); step < script.steps.size(); ++step) {
    const Played all_well = play(script, step, nullptr), without = play(script, step, nullptr, step);
    bool failed = true;
    for (std::size_t k = 1; failed; ++k) {
      failed = false;
      for (const bool again : {true, false}) {
        const Fault fault{step, k, k % 2 == 0 ? test::Failing::from_then_on : test::Failing::one, again};
        SCOPED_TRACE("step " + std::to_string(step) + " (" + script.steps[step].name + "), allocation " +
                     std::to_string(k) + (again ? ", then repeated" : ", then left out"));
        const Played played = play(script, step, &fault);
        failed = failed || played.failed;
        failures += played.failed ? 1 : 0;
        const Played& expected = played.failed && !again ? without : all_well;
        ASSERT_EQ(played.told.size(), expected.told.size());
        for (std::size_t i = 0; i < played.told.size(); ++i) {
          SCOPED_TRACE("snapshot " + std::to_string(i));
          test::expectEqual(played.told[i], expected.told[i]);
          ASSERT_TRUE(played.told[i].ages == expected.told[i].ages);
          if (::testing::Test::HasFatalFailure()) return;
        }
      }
    }
  }
}

TEST(SceneFailedAllocation, LeavesNoTraceInLaterSnapshots) {
  std::size_t failures = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    tryAll(Writer(seed).written(4), failures);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(failures, 2000u) << "too few allocations failed for a meaningful test";
}

/// Claim: a body may move and leave the scene before a commit that fails. The next commit does not visit it.
TEST(SceneFailedAllocation, AfterABodyMovedAndLeftIsHarmless) {
  const auto moved = [](const std::string& name, double x) {
    return placing({{name, test::at(x), Freshness::fresh, 0.0}}, Time{2});
  };
  Script script;
  for (const char* name : {"a", "b", "c"}) {
    script.steps.push_back(adding(test::ball(name)));
    script.steps.push_back(moved(std::string("obstacle/") + name, 0.1));
  }
  script.steps.push_back(committing(Time{1}, {}));
  script.steps.push_back(moved("obstacle/a", 0.2));
  script.steps.push_back(removing("obstacle/a"));
  script.steps.push_back(moved("obstacle/b", 0.3));
  script.steps.push_back(committing(Time{2}, {}));
  script.steps.push_back(committing(Time{3}, {}));
  std::size_t failures = 0;
  tryAll(script, failures);
  EXPECT_GT(failures, 20u);
}

/// Claim: exchangePrepared() changes nothing if it fails, also if what was prepared is out of date.
TEST(SceneFailedAllocation, OfAnOutdatedExchangeChangesNothing) {
  SceneOptions options;
  options.allowed_pairs = {test::allow("obstacle/*", "obstacle/none*")};
  std::size_t failures = 0;
  bool failed = true;
  for (std::size_t k = 1; failed; ++k) {
    Scene scene(options);
    const BodyId old = test::put(scene, test::ball("old"), test::at(0));
    const auto newest = scene.commit(Time{1}, {});
    PreparedBodies prepared = scene.prepare(*newest, {"obstacle/old"}, {test::ball("new"), test::ball("other")});
    test::put(scene, test::ball("late"), test::at(0));
    failed = test::failsAt(k, test::Failing::one, [&] { scene.exchangePrepared({old}, std::move(prepared)); });
    BodyId id;
    ASSERT_EQ(scene.size(), failed ? 2u : 3u) << "allocation " << k;
    ASSERT_EQ(scene.find("obstacle/old", id), failed) << "allocation " << k;
    ASSERT_EQ(scene.find("obstacle/new", id), !failed) << "allocation " << k;
    failures += failed ? 1 : 0;
  }
  EXPECT_GT(failures, 5u);
}

/// Claim: a commit that fails keeps the prepared names for the next one. The test sets wrong bits to detect the use.
TEST(SceneFailedAllocation, KeepsPreparedNames) {
  SceneOptions options;
  options.allowed_pairs = {test::allow("obstacle/*", "obstacle/*")};
  std::size_t failures = 0;
  bool failed = true;
  for (std::size_t k = 1; failed; ++k) {
    Scene scene(options);
    test::put(scene, test::ball("box"), test::at(0));
    NameMatches wrong = scene.commit(Time{1}, {})->structure().filter.match({"obstacle/late"});
    wrong.as_first[0] = wrong.as_second[0] = 0;
    scene.prepareNames(wrong);
    test::put(scene, test::ball("late"), test::at(0));
    failed = test::failsAt(k, test::Failing::one, [&] { scene.commit(Time{2}, {}); });
    EXPECT_EQ(scene.commit(Time{3}, {})->pairs().size(), 1u) << "allocation " << k;
    failures += failed ? 1 : 0;
  }
  EXPECT_GT(failures, 20u);
}

/// Uses a new thread for each query, because the buffers of a new thread are empty.
TEST(SceneFailedAllocation, OfAQueryChangesNoLaterAnswer) {
  Script script = Writer(11).written(2);
  Scene scene(script.options);
  Snapshots snapshots;
  for (const Step& step : script.steps) step.play(scene, snapshots);
  const std::shared_ptr<const Snapshot> snapshot = snapshots.back();
  const std::string expected = test::answersOf(*snapshot);
  bool failed = true;
  std::size_t failures = 0;
  for (std::size_t k = 1; failed; ++k) {
    std::thread([&] {
      failed = test::failsAt(k, test::Failing::one, [&] { test::answersOf(*snapshot); });
      ASSERT_EQ(test::answersOf(*snapshot), expected) << "allocation " << k;
    }).join();
    failures += failed ? 1 : 0;
  }
  EXPECT_GT(failures, 10u);
}

/// Claim: exchange() may add a body with the name of a body that it removes. If one of the new bodies is invalid,
/// exchange() changes nothing.
TEST(SceneExchange, TakesAllOrNothing) {
  SceneOptions options;
  options.max_bodies = 3;
  Scene scene(options);
  const BodyId a = test::put(scene, test::ball("a"), test::at(0)), b = test::put(scene, test::ball("b"), test::at(0.1));
  const auto first = scene.commit(Time{1}, {});

  EXPECT_THROW(scene.exchange({a}, {test::ball("b")}), Refusal) << "b is not removed, so its name is not free";
  EXPECT_THROW(scene.exchange({a}, {test::ball("c"), test::ball("c")}), Refusal)
      << "two added bodies have the same name";
  EXPECT_THROW(scene.exchange({a, a}, {}), Refusal) << "a body is removed twice";
  EXPECT_THROW(scene.exchange({a}, {test::ball("c"), test::ball("d"), test::ball("e")}), Refusal)
      << "more than max_bodies";
  EXPECT_THROW(scene.exchange({a, {7, 0}}, {}), Refusal) << "a handle without a body";
  EXPECT_EQ(scene.size(), 2u);
  EXPECT_EQ(scene.body(a).name, "obstacle/a");
  EXPECT_EQ(scene.commit(Time{2}, {})->structure().revision, first->structure().revision);

  const std::vector<BodyId> ids = scene.exchange({b, a}, {test::ball("b"), test::ball("c"), test::ball("d")});
  ASSERT_EQ(ids.size(), 3u);
  EXPECT_EQ(scene.body(ids[0]).name, "obstacle/b");
  EXPECT_EQ(scene.body(ids[1]).name, "obstacle/c");
  EXPECT_EQ(scene.body(ids[2]).name, "obstacle/d");
  EXPECT_THROW(scene.body(a), Refusal);
  EXPECT_THROW(scene.body(b), Refusal);
  EXPECT_EQ(scene.poseOf(ids[0]).state, Freshness::unplaced);
  BodyId found;
  EXPECT_FALSE(scene.find("obstacle/a", found));
  ASSERT_TRUE(scene.find("obstacle/b", found));
  EXPECT_EQ(found, ids[0]);

  EXPECT_TRUE(scene.exchange(ids, {}).empty());
  EXPECT_EQ(scene.size(), 0u);
}

}  // namespace
}  // namespace hgrid
