// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: Scene::prepare() and Scene::exchangePrepared() give the same results as Scene::exchange(), whatever happens
// between them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "hgrid_proximity/refusal.h"
#include "test/support/rules.h"
#include "test/support/scenes.h"
#include "test/support/told.h"

namespace hgrid {
namespace {

/// A scene that changes with exchange(), and another one that makes the same changes with exchangePrepared().
class Twins {
 public:
  explicit Twins(unsigned seed) : random_(seed), options_(optionsOf(random_)), plain_(options_), twin_(options_) {}

  void run(int ticks) {
    ASSERT_NO_FATAL_FAILURE(commit());
    for (int tick = 0; tick < ticks; ++tick) {
      SCOPED_TRACE("tick " + std::to_string(tick));
      std::vector<std::string> out;
      std::vector<Body> in;
      choose(out, in);
      PreparedBodies prepared = prepare(out, in);
      const auto meanwhile = static_cast<Meanwhile>(random_.below(kMeanwhiles));
      if (meanwhile == Meanwhile::a_body_comes) {
        ASSERT_NO_FATAL_FAILURE(addAnother());
      }
      if (meanwhile == Meanwhile::rules_are_set) setRules(someRules());
      if (meanwhile == Meanwhile::settings_change) tune();
      if (meanwhile == Meanwhile::a_commit) {
        ASSERT_NO_FATAL_FAILURE(commit());
      }
      if (meanwhile == Meanwhile::preparing_again) prepared = prepare(out, in);
      const std::vector<PairRule> rules = someRules();
      const bool expects_rules = meanwhile >= Meanwhile::expected_rules_later;
      if (expects_rules) prepared = twin_.prepare(*newest_, out, in, rules);
      const std::uint64_t before = twin_.revision();
      ASSERT_NO_FATAL_FAILURE(exchange(out, in, std::move(prepared)));
      used_ += twin_.revision() > before ? 1 : 0;
      if (meanwhile == Meanwhile::rules_later) setRules(someRules());
      if (meanwhile == Meanwhile::a_body_comes_later) {
        ASSERT_NO_FATAL_FAILURE(addAnother());
      }
      if (meanwhile == Meanwhile::expected_rules_later) setRules(rules);
      if (meanwhile == Meanwhile::other_rules_later) setRules(someRules());
      move();
      ASSERT_NO_FATAL_FAILURE(commit());
    }
  }
  int used() const { return used_; }

 private:
  /// What happens between prepare() and exchangePrepared(), or later but before the next commit.
  enum class Meanwhile {
    nothing,
    a_body_comes,
    rules_are_set,
    settings_change,
    a_commit,
    preparing_again,  ///< the first preparation is never used
    rules_later,
    a_body_comes_later,
    expected_rules_later,  ///< prepare() was told of these rules
    other_rules_later,     ///< prepare() was told of others
    no_rules_although_expected,
  };
  static constexpr int kMeanwhiles = 11;

  static SceneOptions optionsOf(test::Random& random) {
    SceneOptions options;
    options.margin = test::sixtyFourths(random, 0, 0.5);
    options.horizon = random.chance(0.5) ? 0.0 : 0.5;
    options.finest_edge = random.chance(0.5) ? 0.0 : 0.3;
    options.pair_margins = {{"obstacle/o1*", "*", 0.6}};
    options.required = {"obstacle/o7"};
    options.allowed_pairs = {test::allow("obstacle/o2*", "obstacle/o3*")};
    return options;
  }

  /// Returns a random body. Half of the bodies are fixed and share one solid, so that a body can be replaced by the
  /// same obstacle at another place.
  Body body(const std::string& name) {
    Body body = test::randomBody(random_, name);
    if (random_.chance(0.5)) {
      body = test::ball(name);
      body.mobility = Mobility::fixed;
      static const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
      static const std::shared_ptr<const Solid> solid = phase->solidOf(body.shapes[0].shape);
      body.shapes[0].solid = solid;
      body.frame_from_body = test::randomPose(random_, 1.0);
    }
    body.covered = random_.chance(0.8);
    return body;
  }

  void choose(std::vector<std::string>& out, std::vector<Body>& in) {
    for (const auto& known : ids_) {
      if (random_.chance(0.2)) out.push_back(known.first);
    }
    for (const std::string& name : out) {
      if (random_.chance(0.5)) in.push_back(body(name.substr(name.find('/') + 1)));
    }
    for (int more = random_.below(8); more > 0; --more) {
      Body next = body("o" + std::to_string(random_.below(80)));
      const auto has = [&](const Body& other) { return other.name == next.name; };
      if (ids_.count(next.name) == 0 && std::none_of(in.begin(), in.end(), has)) in.push_back(std::move(next));
    }
    for (std::size_t i = in.size(); i > 1; --i) std::swap(in[i - 1], in[std::size_t(random_.below(int(i)))]);
  }

  PreparedBodies prepare(const std::vector<std::string>& out, const std::vector<Body>& in) {
    return twin_.prepare(*newest_, out, in);
  }

  void exchange(const std::vector<std::string>& out, const std::vector<Body>& in, PreparedBodies prepared) {
    std::vector<BodyId> leaving, twins;
    for (const std::string& name : out) {
      leaving.push_back(ids_.at(name).first);
      twins.push_back(ids_.at(name).second);
      ids_.erase(name);
    }
    for (std::size_t i = twins.size(); i > 1; --i) std::swap(twins[i - 1], twins[std::size_t(random_.below(int(i)))]);
    const std::vector<BodyId> plain = plain_.exchange(leaving, in),
                              twin = twin_.exchangePrepared(twins, std::move(prepared));
    ASSERT_EQ(twin.size(), in.size());
    for (std::size_t i = 0; i < in.size(); ++i) {
      ids_[in[i].name] = {plain[i], twin[i]};
      BodyId found;
      ASSERT_TRUE(twin_.find(in[i].name, found));
      ASSERT_EQ(found, twin[i]);
      ASSERT_EQ(twin_.body(found).name, in[i].name);
    }
    ASSERT_EQ(twin_.size(), plain_.size());
  }

  void addAnother() {
    const std::string name = "x" + std::to_string(++others_);
    ids_["obstacle/" + name] = {plain_.add(test::ball(name)), twin_.add(test::ball(name))};
  }
  std::vector<PairRule> someRules() {
    return {test::allow("obstacle/o" + std::to_string(random_.below(9)) + "*", "*")};
  }
  void setRules(const std::vector<PairRule>& rules) {
    plain_.setRules(rules);
    twin_.setRules(rules);
  }
  void tune() {
    const SceneTuning tuning{test::sixtyFourths(random_, 0, 0.5), 0.02, 1.0, options_.horizon};
    plain_.tune(tuning);
    twin_.tune(tuning);
  }
  void move() {
    for (const auto& known : ids_) {
      if (random_.chance(0.3)) continue;
      const Pose pose = test::randomPose(random_, 2.0);
      plain_.place(known.second.first, pose, Time{tick_});
      twin_.place(known.second.second, pose, Time{tick_});
    }
  }
  void commit() {
    ++tick_;
    const auto plain = plain_.commit(Time{tick_}, {});
    newest_ = twin_.commit(Time{tick_}, {});
    test::expectEqual(test::tell(*newest_), test::tell(*plain));
    const Structure &a = newest_->structure(), &b = plain->structure();
    ASSERT_EQ(a.planes, b.planes);
    ASSERT_EQ(a.sources, b.sources);
    ASSERT_EQ(a.source_of, b.source_of);
    ASSERT_EQ(a.absent, b.absent);
    ASSERT_EQ(a.margin, b.margin);
    ASSERT_EQ(a.silenced, b.silenced);
    ASSERT_TRUE(a.filter.rules() == b.filter.rules());
  }

  test::Random random_;
  SceneOptions options_;
  Scene plain_, twin_;
  std::shared_ptr<const Snapshot> newest_;
  std::map<std::string, std::pair<BodyId, BodyId>> ids_;  // of both scenes, by name
  int tick_ = 0, others_ = 0, used_ = 0;
};

TEST(ScenePrepare, GivesTheResultsOfExchange) {
  int used = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Twins twins(seed);
    ASSERT_NO_FATAL_FAILURE(twins.run(30));
    used += twins.used();
  }
  EXPECT_GT(used, 1000) << "the prepared structures were used too rarely";
  EXPECT_LT(used, 2900) << "the prepared structures were out of date too rarely";
}

/// Returns what prepare() refuses, as "code: sentence", and expects that exchange() refuses the same.
std::string refusalOf(Scene& scene, const Snapshot& newest, const std::vector<std::string>& out,
                      const std::vector<Body>& in) {
  std::string first, second;
  try {
    scene.prepare(newest, out, in);
  } catch (const Refusal& refusal) {
    first = std::string(name(refusal.code())) + ": " + refusal.what();
  }
  std::vector<BodyId> ids;
  for (const std::string& name : out) {
    ids.emplace_back();
    scene.find(name, ids.back());
  }
  try {
    scene.exchange(ids, in);
  } catch (const Refusal& refusal) {
    second = std::string(name(refusal.code())) + ": " + refusal.what();
  }
  EXPECT_EQ(first, second);
  return first;
}

TEST(ScenePrepare, RefusesWhatExchangeRefuses) {
  SceneOptions options;
  options.max_bodies = 3;
  options.max_planes = 1;
  Scene scene(options);
  test::put(scene, test::ball("a"), test::at(0));
  test::put(scene, test::ball("b"), test::at(1));
  const auto newest = scene.commit(Time{1}, {});
  Body bad = test::ball("bad");
  bad.margin = -1.0;
  EXPECT_EQ(refusalOf(scene, *newest, {}, {bad}).substr(0, 12), "OUT_OF_RANGE");
  EXPECT_EQ(refusalOf(scene, *newest, {}, {test::ball("a")}).substr(0, 6), "DUP_ID");
  EXPECT_EQ(refusalOf(scene, *newest, {}, {test::ball("c"), test::ball("c")}).substr(0, 6), "DUP_ID");
  EXPECT_EQ(refusalOf(scene, *newest, {"obstacle/a", "obstacle/a"}, {}).substr(0, 6), "DUP_ID");
  EXPECT_EQ(refusalOf(scene, *newest, {}, {test::ball("c"), test::ball("d")}).substr(0, 5), "LIMIT");
  EXPECT_EQ(refusalOf(scene, *newest, {"obstacle/a"}, {test::ball("c"), test::ball("d")}), "");
}

TEST(ScenePrepare, RefusesToRemoveWhatTheSnapshotLacks) {
  Scene scene({});
  const auto newest = scene.commit(Time{1}, {});
  try {
    scene.prepare(*newest, {"obstacle/a"}, {});
    FAIL();
  } catch (const Refusal& refusal) {
    EXPECT_EQ(refusal.code(), Code::unknown_id);
    EXPECT_EQ(refusal.what(), std::string("there is no body 'obstacle/a'; only an existing body can be removed"));
  }
}

/// A body that moves comes and leaves before the next commit: in a new slot, or in that of an earlier body.
TEST(ScenePrepare, ABodyThatComesAndLeavesBetweenTwoCommitsLeavesNothing) {
  Scene scene({});
  test::put(scene, test::ball("a"), test::at(0));
  const BodyId moving = test::put(scene, test::ball("b"), test::at(0.1));
  // With many bodies that stand still, a commit looks only at those that changed.
  for (int i = 0; i < 20; ++i) test::put(scene, test::ball("still" + std::to_string(i)), test::at(100 + 10 * i));
  const BodyId gone = test::put(scene, test::ball("c"), test::at(5));
  scene.commit(Time{1}, {});
  scene.remove(gone);  // its slot is free from here on
  for (int i = 1; i <= 20; ++i) {
    if (i % 3 == 0) scene.remove(test::put(scene, test::ball("guest" + std::to_string(i)), test::at(i)));
    if (i % 3 == 1) {
      const BodyId first = test::put(scene, test::ball("one"), test::at(i)),
                   second = test::put(scene, test::ball("two"), test::at(i));
      scene.remove(first);
      scene.remove(second);
    }
    scene.place(moving, test::at(0.001 * i), Time{i});
    const auto snapshot = scene.commit(Time{i}, {});
    ASSERT_EQ(snapshot->structure().bodies.size(), 22u);
    ASSERT_EQ(snapshot->pairs().size(), 1u);
    ASSERT_EQ(snapshot->poses()[1].world_from_body.translation().x(), 0.001 * i);
  }
}

/// The thread sanitizer checks that prepare() reads nothing that a change or a commit writes.
TEST(ScenePrepare, MayRunBesideChangesAndCommits) {
  Scene scene({});
  test::put(scene, test::ball("still"), test::at(0));
  const auto newest = scene.commit(Time{1}, {});
  std::thread other([&] {
    for (int i = 0; i < 200; ++i) scene.prepare(*newest, {"obstacle/still"}, {test::ball("new"), test::ball("other")});
  });
  for (int i = 0; i < 200; ++i) {
    const BodyId id = test::put(scene, test::ball("moving"), test::at(i));
    scene.setRules({test::allow("obstacle/a" + std::to_string(i), "*")});
    scene.tune({0.1 + 0.001 * i, 0.02, 1.0, 0.0});
    scene.commit(Time{2 + i}, {});
    scene.remove(id);
  }
  other.join();
  EXPECT_EQ(scene.size(), 1u);
}

}  // namespace
}  // namespace hgrid
