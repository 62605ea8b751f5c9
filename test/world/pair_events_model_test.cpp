// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <tuple>

#include "test/support/events.h"
#include "test/support/scenes.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace {

using test::Random;

/// An event that the model expects. `gone` is true for the cause EventCause::bodies. The model predicts no other
/// causes.
struct Expected {
  std::string kind, first, second;
  Time since{0};
  bool gone = false;
  bool operator<(const Expected& o) const {
    return std::tie(kind, first, second) < std::tie(o.kind, o.first, o.second);
  }
};

/// A simple reference for the events. It identifies bodies by name and compares all bodies of a snapshot with each
/// other.
class Model {
 public:
  explicit Model(const SceneOptions& options) : options_(options) {}

  void beginEpoch() {
    on_.clear();
    last_ = 0;
  }

  void check(const Snapshot& snapshot) {
    std::set<Expected> expected;
    std::map<std::string, std::uint32_t> index;
    const Structure& structure = snapshot.structure();
    for (std::uint32_t i = 0; i < structure.bodies.size(); ++i) index[structure.bodies[i].name] = i;
    for (auto on = on_.begin(); on != on_.end();) {
      const auto a = index.find(on->first.first), b = index.find(on->first.second);
      const bool gone = a == index.end() || b == index.end() || structure.ids[a->second] != on->second.first ||
                        structure.ids[b->second] != on->second.second;
      if (!gone && within(snapshot, a->second, b->second, options_.event_hysteresis)) {
        ++on;
      } else {
        expected.insert({"END", on->first.first, on->first.second, on->second.since, gone});
        on = on_.erase(on);
      }
    }
    for (std::uint32_t i = 0; i < structure.bodies.size(); ++i) {
      for (std::uint32_t j = i + 1; j < structure.bodies.size(); ++j) {
        const auto names = std::make_pair(structure.bodies[i].name, structure.bodies[j].name);
        if (on_.count(names) != 0 || !within(snapshot, i, j, 0.0)) continue;
        on_[names] = {structure.ids[i], structure.ids[j], snapshot.stamp()};
        expected.insert({"BEGIN", names.first, names.second, snapshot.stamp(), false});
      }
    }
    compare(snapshot, expected);
  }
  std::size_t events() const { return events_; }

 private:
  struct On {
    BodyId first, second;
    Time since{0};
  };

  bool within(const Snapshot& snapshot, std::uint32_t i, std::uint32_t j, double beyond) const {
    const Structure& structure = snapshot.structure();
    const BodyPose &p = snapshot.poses()[i], &q = snapshot.poses()[j];
    const Body &a = structure.bodies[i], &b = structure.bodies[j];
    if (p.state == Freshness::unplaced || q.state == Freshness::unplaced || !test::reported(a, b)) return false;
    const double reach = std::max({options_.margin, a.margin, b.margin}) + (p.growth + q.growth) + beyond;
    for (std::uint32_t k = structure.first_proxy[i]; k < structure.first_proxy[i + 1]; ++k) {
      for (std::uint32_t l = structure.first_proxy[j]; l < structure.first_proxy[j + 1]; ++l) {
        if (test::oracleWithin(snapshot.boxes()[k], snapshot.boxes()[l], reach)) return true;
      }
    }
    return false;
  }

  void compare(const Snapshot& snapshot, const std::set<Expected>& expected) {
    std::set<Expected> told;
    bool begins = false;
    std::pair<std::string, std::string> before;
    for (const PairEvent& event : snapshot.events()) {
      const Structure& structure = snapshot.structureOf(event);
      const Expected one{test::nameOf(event.kind), structure.bodies[event.first].name,
                         structure.bodies[event.second].name, event.since, event.cause == EventCause::bodies};
      SCOPED_TRACE(one.kind + " " + one.first + " " + one.second);
      ASSERT_EQ(event.number, ++last_) << "the events of an epoch are not numbered without gaps";
      ASSERT_LT(one.first, one.second);
      ASSERT_TRUE(told.insert(one).second) << "the event occurs twice";
      ASSERT_FALSE(begins && event.kind == EventKind::end) << "an END event comes after a BEGIN event";
      begins = event.kind == EventKind::begin;
      const auto found = expected.find(one);
      ASSERT_TRUE(found != expected.end()) << "the model does not expect this event";
      ASSERT_EQ(one.since, found->since);
      if (event.kind == EventKind::end) {
        ASSERT_EQ(one.gone, found->gone);
        ASSERT_EQ(std::isnan(event.gap), found->gone);
      } else {
        ASSERT_GE(event.gap, 0.0);
      }
    }
    ASSERT_EQ(told.size(), expected.size()) << "some expected events are missing";
    ASSERT_EQ(snapshot.lastEvent(), last_);
    events_ += told.size();
  }

  SceneOptions options_;
  std::map<std::pair<std::string, std::string>, On> on_;
  std::uint64_t last_ = 0;
  std::size_t events_ = 0;
};

/// A random sequence of changes: bodies are added, moved, replaced and removed, and become stale. New epochs begin.
class Story {
 public:
  explicit Story(unsigned seed) : random_(seed), scene_(optionsOf(random_, options_)), model_(options_) {}

  void run(int ticks) {
    for (int tick = 1; tick <= ticks; ++tick) {
      SCOPED_TRACE("tick " + std::to_string(tick));
      for (int changes = random_.below(8); changes > 0; --changes) change(tick);
      if (random_.chance(0.02)) {
        scene_.beginEpoch(static_cast<std::uint64_t>(tick));
        model_.beginEpoch();
      }
      const auto snapshot = scene_.commit(Time{tick}, {});
      ASSERT_NO_FATAL_FAILURE(model_.check(*snapshot));
      if (random_.chance(0.3)) kept_.push_back(snapshot);
      if (kept_.size() > 3) kept_.erase(kept_.begin());
    }
  }
  std::size_t events() const { return model_.events(); }

 private:
  static const SceneOptions& optionsOf(Random& random, SceneOptions& options) {
    options.margin = random.chance(0.2) ? 0.0 : test::sixtyFourths(random, 0, 0.5);
    options.event_hysteresis = random.chance(0.2) ? 0.0 : test::sixtyFourths(random, 0, 0.5);
    options.growth_cap = test::sixtyFourths(random, 0, 1);
    return options;
  }

  void change(int tick) {
    const std::string name = "o" + std::to_string(random_.below(25));
    BodyId id;
    if (!scene_.find("obstacle/" + name, id)) {
      id = scene_.add(test::randomBody(random_, name));
      if (random_.chance(0.7)) scene_.place(id, test::randomPose(random_, 3.0), Time{tick});
      return;
    }
    const int kind = random_.below(100);
    if (kind < 4) {
      scene_.remove(id);
    } else if (kind < 8) {
      const Pose pose = scene_.poseOf(id).world_from_body;
      scene_.remove(id);
      test::put(scene_, test::randomBody(random_, name), pose, Time{tick});
    } else if (kind < 80) {
      Pose pose = scene_.poseOf(id).world_from_body;
      pose.translation() += test::randomVector(random_, -0.3, 0.3);
      scene_.place(id, pose, Time{tick});
    } else {
      const auto state = static_cast<Freshness>(random_.below(6));
      scene_.setState(id, state, test::sixtyFourths(random_, 0, 1), std::uint32_t(random_.below(3)));
    }
  }

  Random random_;
  SceneOptions options_;
  Scene scene_;
  Model model_;
  std::vector<std::shared_ptr<const Snapshot>> kept_;
};

TEST(PairEventsModel, EveryBeginAndEveryEndIsToldOnceAndNothingElseIs) {
  std::size_t events = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Story story(seed);
    ASSERT_NO_FATAL_FAILURE(story.run(80));
    events += story.events();
  }
  EXPECT_GT(events, 10000u);
}

}  // namespace
}  // namespace hgrid
