// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Sends random sequences of transforms to the node, and compares the node with a simple model of the last known poses.
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>

#include "test/node/support/freshness_model.h"
#include "test/node/support/simulated_world.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

const std::vector<std::string> kFrames = {"m", "a", "b"};
constexpr double kLate = 0.1, kStale = 0.25, kLost = 1.0, kCap = 0.7, kSpeed = 2.0, kMargin = 0.1;
constexpr double kRounding = 2e-6;  // [m] rounding of boxes that are stored as float

/// Counts how often each case occurred. The test prints the counts, which show whether it covers all cases.
struct Coverage {
  std::size_t ticks = 0, fresh = 0, late = 0, stale = 0, lost = 0, contested = 0, fought = 0, kept = 0, pairs = 0,
              grown_pairs = 0, jumps = 0;
};

Params paramsOf(Random& random) {
  Params params;
  params.late_after = kLate;
  params.stale_after = kStale;
  params.lost_after = kLost;
  params.growth_cap = kCap;
  params.default_max_speed = kSpeed;
  params.margin = kMargin;
  const double waits[] = {0.0, 0.03, 0.1, 0.3};
  params.max_sync_wait = waits[random.below(4)];
  return params;
}

class RandomHistory {
 public:
  RandomHistory(std::uint64_t seed, Ledger& ledger, Coverage& coverage)
      : random_(seed),
        simulated_(random_.chance(0.3)),
        world_(kFrames, simulated_ ? SimulatedWorld::Clock::simulated : SimulatedWorld::Clock::wall, paramsOf(random_),
               ledger),
        model_(kFrames),
        coverage_(coverage) {
    for (std::size_t i = 0; i < kFrames.size(); ++i) begin(sources_[i], kFrames[i], random_.chance(0.15));
    faulty_ = random_.chance(0.8);
    world_.tick();  // the node reads the clock for the first time in its first tick
  }

  void run() {
    const int steps = random_.between(10, 45);
    for (int i = 0; i < steps && !::testing::Test::HasFailure(); ++i) step();
  }

 private:
  /// A publisher of one frame. The frame moves at a constant speed in its parent.
  struct Source {
    std::string frame, parent, publisher;
    double x = 0.0, speed = 0.0;  // position at time 0 [m], speed [m/s]
    bool is_static = false;
    double delay = 0.0;  // [s] age of its stamps; negative: the stamps are in the future
    double period = 0.0, next = 0.0;
    bool silent = false;
  };

  std::string parentFor(const std::string& frame) {
    if (random_.chance(0.06)) return "island";
    if (frame == "m" || random_.chance(0.4)) return "base";
    return frame == "a" || random_.chance(0.5) ? "m" : "a";
  }

  void begin(Source& source, const std::string& frame, bool is_static) {
    source.frame = frame;
    source.parent = parentFor(frame);
    source.publisher = random_.chance(0.5) ? "/one" : "/two";
    source.is_static = is_static;
    source.speed = is_static || random_.chance(0.4) ? 0.0 : random_.uniform(-0.5, 0.5);
    source.x = random_.uniform(-0.3, 0.3) - source.speed * world_.now();
    const double delays[] = {0.0, 0.0, 0.0, 0.02, 0.07, 0.15, -0.03, -0.3};
    source.delay = delays[random_.below(8)];
    source.period = random_.uniform(0.01, 0.03);
    source.next = world_.now();
    source.silent = false;
  }

  void speak(const Source& source, double stamp) {
    stamp = std::round(stamp * 1e6) / 1e6;
    if (!source.is_static && stamp > world_.now()) ahead_for_ = 2.0;
    const PublishedTransform said{source.frame, source.parent,   source.publisher, source.x + source.speed * stamp,
                                  stamp,        source.is_static};
    if (said.is_static) {
      world_.fix(said.publisher, said.parent, said.frame, said.x, random_.chance(0.1) ? 1e8 : 0.0);
    } else {
      world_.send(said.publisher, said.parent, said.frame, said.x, stamp);
    }
    model_.hear(said, world_.now());
    if (told_) {
      std::printf("%.6f %s: %s in %s%s at %.6f, stamp %.6f\n", world_.now(), said.publisher.c_str(), said.frame.c_str(),
                  said.parent.c_str(), said.is_static ? " (static)" : "", said.x, stamp);
    }
  }

  /// Causes one random fault or change of a source.
  void upset(Source& source) {
    const std::string frame = source.frame;
    switch (random_.below(9)) {
      case 0:  // the publisher moves the frame to another place
        source.parent = parentFor(frame);
        source.x = random_.uniform(-0.3, 0.3) - source.speed * world_.now();
        if (source.is_static) source.next = world_.now();
        break;
      case 1:
        source.silent = !source.silent;
        break;
      case 2:  // another publisher takes over at once
        begin(source, frame, source.is_static && random_.chance(0.7));
        break;
      case 3:  // another publisher takes over after a pause
        begin(source, frame, source.is_static);
        source.next = world_.now() + 0.7;
        break;
      case 4:  // two publishers at the same time
        rival_ = source;
        begin(rival_, frame, false);
        has_rival_ = !has_rival_;
        break;
      case 5:  // a stamp far in the future, which is refused
        if (source.is_static) break;
        world_.send(source.publisher, source.parent, frame, 9.0, world_.now() + 2.0);
        model_.hearRefused(frame, world_.now());
        break;
      case 6:
        world_.send(source.publisher, source.parent, frame, std::numeric_limits<double>::quiet_NaN(), world_.now());
        model_.hearRefused(frame, world_.now());
        break;
      case 7:  // a transform whose stamp is too old or in the future
        if (!source.is_static) speak(source, world_.now() + random_.uniform(-0.2, 0.4));
        break;
      case 8:
        jump();
        break;
    }
  }

  void jump() {
    if (ahead_for_ > 0.0 || random_.chance(0.5)) return;
    const double by = random_.chance(0.5) ? -random_.uniform(0.5, 100.0) : random_.uniform(20.0, 1000.0);
    ++coverage_.jumps;
    world_.setRosClock(world_.now() + by);
    if (!simulated_ || by < 0.0) model_.forgetStamps(by);
    elapsed_ += simulated_ ? std::max(0.0, by) : 0.0;
    for (Source* source : {&sources_[0], &sources_[1], &sources_[2], &rival_}) source->next = world_.now();
    tick();  // the node must notice the jump before the next transform arrives
  }

  void step() {
    const double duration = random_.chance(0.05) ? random_.uniform(0.1, 0.6) : random_.uniform(0.005, 0.04);
    world_.wait(duration);
    elapsed_ += duration;
    ahead_for_ -= duration;
    if (faulty_ && random_.chance(0.15)) upset(sources_[random_.below(3)]);
    for (Source* source : {&sources_[0], &sources_[1], &sources_[2], &rival_}) {
      if ((source == &rival_ && !has_rival_) || source->silent || source->next > world_.now()) continue;
      speak(*source, world_.now() - source->delay);
      source->next = source->is_static ? 1e12 : world_.now() + source->period;
    }
    if (random_.chance(0.8)) tick();
  }

  void tick() {
    world_.tick();
    ASSERT_NE(world_.last().snapshot, nullptr);
    const double time = std::round(world_.tickTime() * 1e9) / 1e9;
    model_.tick(time, world_.now(), elapsed_);
    elapsed_ = 0.0;
    ++coverage_.ticks;
    if (told_) std::printf("%.6f tick at %.6f\n", world_.now(), time);
    for (const std::string& frame : kFrames) {
      SCOPED_TRACE("body of " + frame);
      judge(frame, time);
    }
    judgePair("a", "b");
    judgePair("m", "a");
    judgePair("m", "b");
  }

  void judge(const std::string& frame, double time) {
    const BodyPose& pose = world_.pose(frame);
    const FreshnessModel::Known& known = model_.known(frame);
    count(pose, known);
    if (told_) {
      std::printf("  %s: %s x %.6f at %.6f, %.6f old; model: x %.6f at %.6f, %.6f old%s%s\n", frame.c_str(),
                  name(pose.state), pose.world_from_body.translation().x(), world_.stamp(frame), pose.age, known.x,
                  known.stamp, known.age, known.contested ? ", contested" : "", known.at_tick ? ", at tick" : "");
    }
    if (pose.state == Freshness::unplaced) {
      EXPECT_FALSE(known.placed && !known.contested);
      EXPECT_FALSE(world_.snapshot().complete());
      return;
    }
    const double x = pose.world_from_body.translation().x();
    if (pose.age > kStale + 1e-6) {
      EXPECT_GE(pose.growth, std::min(kCap, kSpeed * kStale));
    }
    if (known.fought) {
      EXPECT_NE(pose.state, Freshness::fresh);
    }
    if (known.contested) {
      // The pose must follow from transforms that publishers have sent for its stamp.
      if (known.moves && pose.age < kLost && coverage_.jumps == jumps_before_) {
        EXPECT_TRUE(model_.isSupported(frame, x, world_.stamp(frame))) << "x = " << x << " at " << world_.stamp(frame);
      }
      return;
    }
    EXPECT_TRUE(known.placed);
    EXPECT_GE(pose.age, known.age - 1e-5) << "at " << world_.now() << ", tick at " << time;
    EXPECT_NEAR(x, known.x, 1e-6) << "at " << world_.now() << ", tick at " << time;
    const double periods = 1.5 * known.period + 1e-5;
    if (known.moves && known.age > std::max(kLate + 1e-5, periods)) {
      EXPECT_NE(pose.state, Freshness::fresh) << "known at " << known.stamp << ", now " << world_.now();
    }
    if (known.moves && known.age > std::max(kStale + 1e-5, periods)) {
      EXPECT_GE(pose.state, Freshness::stale);
    }
    if (known.moves && known.age > std::max(kLost + 1e-5, periods)) {
      EXPECT_GE(pose.state, Freshness::lost);
    }
    const bool well = known.at_tick && (!known.moves || (known.age < 0.05 && ahead_for_ <= 0.0));
    if (well) {
      EXPECT_EQ(pose.state, Freshness::fresh) << "age " << pose.age << ", by the model " << known.age;
    }
  }

  void count(const BodyPose& pose, const FreshnessModel::Known& known) {
    coverage_.fresh += pose.state == Freshness::fresh;
    coverage_.late += pose.state == Freshness::late;
    coverage_.stale += pose.state == Freshness::stale;
    coverage_.lost += pose.state == Freshness::lost;
    coverage_.contested += known.contested;
    coverage_.fought += known.fought;
    coverage_.kept += known.placed && !known.connected;
  }

  static double growthOf(const FreshnessModel::Known& known) {
    return known.moves && known.age > kStale + 1e-5 ? std::min(kCap, kSpeed * known.age) : 0.0;
  }

  void judgePair(const std::string& first, const std::string& second) {
    const FreshnessModel::Known &a = model_.known(first), &b = model_.known(second);
    if (!a.placed || !b.placed || a.contested || b.contested) return;
    const double gap = std::max(0.0, std::abs(a.x - b.x) - 0.2);
    if (gap > kMargin + growthOf(a) + growthOf(b) - kRounding) return;
    ++coverage_.pairs;
    coverage_.grown_pairs += gap > kMargin;
    EXPECT_TRUE(world_.near(first, second)) << first << " and " << second << ", gap " << gap;
  }

  Random random_;
  bool simulated_;
  SimulatedWorld world_;
  FreshnessModel model_;
  Coverage& coverage_;
  const std::size_t jumps_before_ = coverage_.jumps;
  Source sources_[3], rival_;
  bool has_rival_ = false, faulty_ = false;
  const bool told_ = std::getenv("HGRID_TEST_SEED") != nullptr;
  double elapsed_ = 0.0;    // [s] time since the last tick
  double ahead_for_ = 0.0;  // [s] remaining time in which an earlier stamp from the future may have an effect
};

TEST(FreshnessHistories, ABodyIsNeverFresherThanTheDataAndNoPairIsLost) {
  const int histories = countFromEnvironment("HGRID_TEST_HISTORIES", 100000);
  Ledger ledger;  // all histories use one ledger, so they log one line per second in total
  Coverage coverage;
  const int only = countFromEnvironment("HGRID_TEST_SEED", 0);  // if it is not 0, the test plays only this seed
  for (int seed = only > 0 ? only : 1; seed <= (only > 0 ? only : histories); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomHistory(static_cast<std::uint64_t>(seed), ledger, coverage).run();
    if (HasFailure()) break;
  }
  std::printf(
      "%d histories, %zu ticks; bodies: %zu fresh, %zu late, %zu stale, %zu lost, %zu contested, %zu fought over, "
      "%zu kept; pairs that must be there: %zu, of which %zu by growth; %zu jumps of the clock\n",
      histories, coverage.ticks, coverage.fresh, coverage.late, coverage.stale, coverage.lost, coverage.contested,
      coverage.fought, coverage.kept, coverage.pairs, coverage.grown_pairs, coverage.jumps);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
