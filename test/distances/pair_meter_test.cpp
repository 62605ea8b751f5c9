// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/distances/pair_meter.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <new>
#include <thread>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/random.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::at;
using test::put;

/// A narrow phase for spheres only, with a clock that stands still except while it measures. It counts its
/// measurements. Tests can make it slow, or make it fail or throw.
class BallPhase final : public NarrowPhase {
 public:
  struct Ball final : Solid {
    explicit Ball(double given) : radius(given) {}
    double radius;
  };

  std::shared_ptr<const Solid> solidOf(const Shape& shape) override {
    return std::make_shared<Ball>(shape.dimensions()[0]);
  }
  std::shared_ptr<const Solid> plane() const override { return std::make_shared<Ball>(0.0); }
  std::shared_ptr<const Solid> point() const override { return std::make_shared<Ball>(0.0); }
  std::shared_ptr<const Solid> needle(double) const override { return nullptr; }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d&) const override { return nullptr; }
  Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const override {
    if (++asked == throws_at) throw std::bad_alloc();
    if (throws_beside == std::this_thread::get_id()) {
      while (!thrown) std::this_thread::yield();
    } else if (throws_beside != std::thread::id()) {
      thrown = true;
      throw std::bad_alloc();
    }
    elapsed_ += std::chrono::nanoseconds(takes).count();
    const double around = static_cast<const Ball&>(first.solid).radius + first.padding +
                          static_cast<const Ball&>(second.solid).radius + second.padding;
    const Eigen::Vector3d way = second.world_from_shape.translation() - first.world_from_shape.translation();
    Proximity result;
    if (fails) {
      result.status = Measure::failed;
      result.distance = result.lower_bound = 0.0;
      return result;
    }
    result.distance = std::max(0.0, way.norm() - around);
    result.status = result.distance > 0.0 ? Measure::apart : Measure::contact;
    if (result.distance > up_to) result.distance = std::numeric_limits<double>::infinity();
    result.lower_bound = result.distance;
    return result;
  }

  Contact measureContact(const PlacedSolid& first, const PlacedSolid& second) const override {
    ++described;
    Contact contact;
    contact.point = 0.5 * (first.world_from_shape.translation() + second.world_from_shape.translation());
    return contact;
  }
  std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second, std::size_t most) const override {
    if (most == 0 || measure(first, second, 0.0).status != Measure::contact) return {};
    Contact contact;
    contact.depth = static_cast<const Ball&>(first.solid).radius;  // tells the test which sphere it is
    return {contact};
  }

  std::chrono::steady_clock::time_point now() const {
    return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(elapsed_));
  }

  mutable std::atomic<int> asked{0};
  mutable std::atomic<int> described{0};  // number of calls of measureContact()
  int throws_at = 0;                      // number of the measurement that throws bad_alloc; 0: none
  std::thread::id throws_beside;          // if set: this thread waits, and the other threads throw bad_alloc
  mutable std::atomic<bool> thrown{false};
  std::chrono::microseconds takes{0};  // how long each measurement takes by now()
  bool fails = false;

 private:
  mutable std::atomic<std::int64_t> elapsed_{1'000'000'000};  // [ns]
};

class PairMeterTest : public ::testing::Test {
 protected:
  static Body ballOf(BallPhase& phase, const std::string& name, double radius) {
    Body body = test::ball(name, radius);
    for (BodyShape& shape : body.shapes) shape.solid = phase.solidOf(shape.shape);
    return body;
  }
  BodyId add(const std::string& name, double x, double radius = 0.5) {
    return put(scene_, ballOf(*phase_, name, radius), at(x));
  }
  std::shared_ptr<const PairDistances> measure(PairMeter& meter, std::int64_t milliseconds) {
    snapshot_ = scene_.commit(std::chrono::milliseconds(milliseconds), {});
    return meter.measure(*snapshot_);
  }
  PairMeter meterOf(double report, double budget = 0.0, int threads = 1) {
    return PairMeter(phase_, {report, budget, threads, [phase = phase_] { return phase->now(); }});
  }

  std::shared_ptr<BallPhase> phase_ = std::make_shared<BallPhase>();
  Scene scene_ = [] {
    SceneOptions options;
    options.margin = 1.0;
    return Scene(options);
  }();
  std::shared_ptr<const Snapshot> snapshot_;
};

TEST_F(PairMeterTest, ReportsWhatIsWithinTheReportDistanceNearestFirst) {
  add("a", 0.0);
  add("b", 1.3);
  add("c", 2.4);   // 0.1 m from b
  add("d", 20.0);  // far from a, b and c
  add("e", 20.9);  // in contact with d
  PairMeter meter = meterOf(0.2);
  const auto found = measure(meter, 1);
  ASSERT_EQ(found->pairs.size(), 2u);
  EXPECT_EQ(found->pairs[0].proximity.status, Measure::contact);
  EXPECT_EQ(found->pairs[0].proximity.distance, 0.0);
  EXPECT_NEAR(found->pairs[1].proximity.distance, 0.1, 1e-12);
  EXPECT_EQ(snapshot_->structure().bodies[found->pairs[1].first].name, "obstacle/b");
  EXPECT_EQ(snapshot_->structure().bodies[found->pairs[1].second].name, "obstacle/c");
}

TEST_F(PairMeterTest, AsksNobodyWhatItKnowsWhileNothingMoves) {
  add("a", 0.0);
  const BodyId b = add("b", 1.05);
  PairMeter meter = meterOf(0.2);
  const auto first = measure(meter, 1);
  const int asked = phase_->asked;
  EXPECT_EQ(asked, 1);
  const auto second = measure(meter, 2);
  EXPECT_EQ(phase_->asked, asked);
  ASSERT_EQ(second->pairs.size(), 1u);
  EXPECT_EQ(second->pairs[0].proximity.distance, first->pairs[0].proximity.distance);
  scene_.place(b, at(1.06), std::chrono::milliseconds(3));
  measure(meter, 3);
  EXPECT_EQ(phase_->asked, asked + 1) << "a pair that moved must be measured again";
}

TEST_F(PairMeterTest, DescribesAContactOnceAndNothingElse) {
  add("a", 0.0);
  const BodyId b = add("b", 0.9);
  add("c", 2.0);  // 0.1 m from b
  PairMeter meter = meterOf(0.2);
  for (const int tick : {1, 2}) {
    const auto found = measure(meter, tick);
    ASSERT_EQ(found->pairs.size(), 2u);
    EXPECT_EQ(found->pairs[0].contact.point, Eigen::Vector3d(0.45, 0, 0));
    EXPECT_TRUE(found->pairs[1].contact.point.hasNaN());
    EXPECT_EQ(phase_->described, 1) << "a pair that did not move is not described again";
  }
  scene_.place(b, at(0.8), std::chrono::milliseconds(3));
  EXPECT_EQ(measure(meter, 3)->pairs[0].contact.point, Eigen::Vector3d(0.4, 0, 0));
  EXPECT_EQ(phase_->described, 2);
  phase_->fails = true;
  scene_.place(b, at(0.7), std::chrono::milliseconds(4));
  EXPECT_TRUE(measure(meter, 4)->pairs[0].contact.point.hasNaN());
  EXPECT_EQ(phase_->described, 2) << "a failed measurement is not described";
}

/// Claim: the meter does not measure a pair that cannot have come near enough. This never makes it miss a pair.
TEST_F(PairMeterTest, NeverLosesAPairThatCreepsUp) {
  const BodyId a = add("a", 0.0);
  const BodyId b = add("b", 1.3);
  PairMeter meter = meterOf(0.2), fresh = meterOf(0.2);
  for (int step = 0; step < 400; ++step) {
    const double turn = 0.01 * step, distance = 0.3 - 0.001 * step;  // both bodies also turn and move together
    Pose carried = Pose::Identity();
    carried.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    carried.translation() << 5.0 * turn, -turn, 0.0;
    scene_.place(a, carried, std::chrono::milliseconds(step + 1));
    scene_.place(b, carried * at(1.0 + distance), std::chrono::milliseconds(step + 1));
    const auto found = measure(meter, step + 1);
    PairMeter forgetful = meterOf(0.2);
    const auto expected = forgetful.measure(*snapshot_);
    ASSERT_EQ(found->pairs.size(), expected->pairs.size()) << "step " << step;
    for (std::size_t i = 0; i < found->pairs.size(); ++i) {
      ASSERT_EQ(found->pairs[i].proximity.distance, expected->pairs[i].proximity.distance) << "step " << step;
    }
  }
}

/// Claim: after tune(), a meter reports what a new meter with these options reports.
TEST_F(PairMeterTest, AfterATuneReportsWhatANewMeterReports) {
  const BodyId a = add("a", 0.0), b = add("b", 1.1), c = add("c", 2.4);
  add("d", 3.6);
  PairMeter meter = meterOf(0.5);
  test::Random random(3);
  for (int step = 1; step <= 200; ++step) {
    const double report = test::sixtyFourths(random, 0.0, 1.0);
    if (random.chance(0.5)) scene_.place(a, at(random.uniform(-0.5, 0.3)), std::chrono::milliseconds(step));
    meter.tune(report, 0.0);
    const auto found = measure(meter, step);
    PairMeter forgetful = meterOf(report);
    const auto expected = forgetful.measure(*snapshot_);
    ASSERT_EQ(found->pairs.size(), expected->pairs.size()) << "step " << step;
    for (std::size_t i = 0; i < found->pairs.size(); ++i) {
      ASSERT_EQ(found->pairs[i].proximity.distance, expected->pairs[i].proximity.distance) << "step " << step;
    }
  }
  phase_->takes = std::chrono::milliseconds(5);
  scene_.place(b, at(1.11), std::chrono::milliseconds(201));
  scene_.place(c, at(2.41), std::chrono::milliseconds(201));  // now three pairs are due
  meter.tune(1.0, 0.001);
  EXPECT_GT(measure(meter, 201)->left_out, 0u) << "the budget is in force";
}

TEST_F(PairMeterTest, WhatDoesNotFitIntoTheBudgetStaysACandidateNearestFirst) {
  phase_->takes = std::chrono::milliseconds(5);
  for (int i = 0; i < 8; ++i) add(std::string(1, static_cast<char>('a' + i)), (1.0 + 0.02 * i) * i);
  PairMeter meter = meterOf(0.5, 0.012);
  const auto found = measure(meter, 1);
  EXPECT_GT(found->measured, 0u);
  EXPECT_GT(found->left_out, 0u);
  EXPECT_EQ(found->pairs.size(), found->measured + found->left_out)
      << "all pairs are within the report distance, so all must be listed";
  for (std::size_t i = 0; i < found->pairs.size(); ++i) {
    const bool measured = i < found->measured;
    EXPECT_EQ(found->pairs[i].proximity.status == Measure::not_measured, !measured);
    EXPECT_EQ(std::isnan(found->pairs[i].proximity.distance), !measured);
    if (i > found->measured) {
      EXPECT_GE(found->pairs[i].gap, found->pairs[i - 1].gap);
    }
  }
  for (std::size_t i = found->measured; i < found->pairs.size(); ++i) {
    EXPECT_GE(found->pairs[i].gap, found->pairs[found->measured - 1].gap)
        << "the pairs with the nearest boxes must be measured first";
  }
}

/// Claim: if there is no time to measure a pair, its lower bound never exceeds the true distance. The bound is larger
/// than the gap if the pair was measured before and moved little.
TEST_F(PairMeterTest, APairThatIsNotMeasuredHasALowerBoundFromItsLastMeasurement) {
  std::vector<BodyId> others;  // pairs in contact, which are measured first
  for (int i = 0; i < 3; ++i) {
    others.push_back(add("other" + std::to_string(i), -10.0 * (i + 1)));
    add("still" + std::to_string(i), -10.0 * (i + 1) - 0.5);
  }
  const BodyId a = add("a", 0.0), b = add("b", 1.0);
  PairMeter meter = meterOf(3.0, 0.002);
  test::Random random(7);
  std::size_t better = 0;
  for (int step = 1; step <= 100; ++step) {
    const bool in_time = step % 2 == 1;
    phase_->takes = in_time ? std::chrono::microseconds(0) : std::chrono::microseconds(5000);
    const Time now = std::chrono::milliseconds(step);
    for (int i = 0; i < 3; ++i) scene_.place(others[i], at(-10.0 * (i + 1) + random.uniform(-0.1, 0.1)), now);
    const double from_y = 0.55 + random.uniform(0.0, 0.02), to_y = -0.55 - random.uniform(0.0, 0.02);
    scene_.place(a, Pose(Eigen::Translation3d(0.0, from_y, 0.0)), now);
    scene_.place(b, Pose(Eigen::Translation3d(1.1, to_y, 0.0)), now);
    const auto found = measure(meter, step);
    ASSERT_EQ(found->pairs.size(), 4u);
    EXPECT_EQ(found->left_out, in_time ? 0u : 2u);
    const PairDistance& pair = found->pairs.back();
    const double distance = std::hypot(1.1, from_y - to_y) - 1.0;
    EXPECT_LE(pair.lower_bound, distance + 1e-9) << "step " << step;
    EXPECT_GE(pair.lower_bound, pair.gap);
    if (pair.proximity.status == Measure::apart) {
      EXPECT_EQ(pair.lower_bound, pair.proximity.distance);
      EXPECT_EQ(pair.measured, now);
    } else {
      EXPECT_LT(pair.measured, now);
      better += pair.lower_bound > pair.gap + 0.1 ? 1 : 0;
    }
  }
  EXPECT_EQ(better, 50u);
}

/// Claim: half of the budget keeps the nearest pairs up to date. With the other half, each pair is measured again
/// within a bounded number of snapshots, however many pairs are nearer.
TEST_F(PairMeterTest, EachPairIsMeasuredAgainWithinABoundedNumberOfSnapshots) {
  constexpr int kPairs = 40;
  std::vector<BodyId> movers;
  for (int i = 0; i < kPairs; ++i) {
    add("still" + std::to_string(i), 10.0 * i);
    movers.push_back(add("mover" + std::to_string(i), 10.0 * i + 1.1));
  }
  PairMeter meter = meterOf(2.0, 0.0079);  // [s] eight measurements of 1 ms: four nearest, four that wait
  phase_->takes = std::chrono::milliseconds(1);
  std::map<std::uint32_t, std::uint64_t> measured;  // by first body: the last snapshot in which its pair was measured
  std::uint64_t most = 0;
  for (int step = 1; step <= 60; ++step) {
    for (int i = 0; i < kPairs; ++i) {
      scene_.place(movers[i], at(10.0 * i + 1.1 + 0.01 * i + 0.00001 * step), std::chrono::milliseconds(step));
    }
    const auto found = measure(meter, step);
    ASSERT_EQ(found->pairs.size(), static_cast<std::size_t>(kPairs));
    EXPECT_EQ(found->measured, 8u);
    for (const PairDistance& pair : found->pairs) {
      std::uint64_t& last = measured[pair.first];
      if (pair.proximity.status == Measure::apart) last = static_cast<std::uint64_t>(step);
      const std::uint64_t waited = static_cast<std::uint64_t>(step) - last;
      EXPECT_LE(waited, 10u) << "step " << step;  // (40 - 4) / 4, and one for the pairs that were not measured before
      most = std::max(most, step > 1 ? waited : 0);
      if (waited > 0) {
        EXPECT_LE(waited, found->longest_wait);
      }
      if (pair.gap < 0.1 + 0.01 * 3.5) {
        EXPECT_EQ(waited, 0u) << "one of the four nearest pairs";
      }
    }
  }
  EXPECT_GE(most, 8u) << "the test must make pairs wait";
}

TEST_F(PairMeterTest, OnePairIsMeasuredForEachSnapshotEvenWithoutTime) {
  const BodyId a = add("a", 0.0), b = add("b", 1.1);
  add("c", 2.2);
  PairMeter meter = meterOf(0.2, 1e-9);
  phase_->takes = std::chrono::seconds(1);
  for (int step = 1; step <= 6; ++step) {
    scene_.place(a, at(0.0001 * step), std::chrono::milliseconds(step));
    scene_.place(b, at(1.1 + 0.0002 * step), std::chrono::milliseconds(step));
    const auto found = measure(meter, step);
    EXPECT_GE(found->measured, 1u);
    EXPECT_LE(found->longest_wait, 1u);
  }
}

TEST_F(PairMeterTest, EstimatesHowFastTheyComeNearerAndWhen) {
  add("a", 0.0);
  const BodyId b = add("b", 1.19);
  PairMeter meter = meterOf(0.3);
  std::shared_ptr<const PairDistances> found;
  for (int step = 0; step <= 50; ++step) {  // b approaches a with 0.5 m/s
    scene_.place(b, at(1.19 - 0.001 * step), std::chrono::milliseconds(2 * step + 1));
    found = measure(meter, 2 * step + 1);
  }
  ASSERT_EQ(found->pairs.size(), 1u);
  EXPECT_NEAR(found->pairs[0].closing_speed, 0.5, 1e-6);
  EXPECT_NEAR(found->pairs[0].time_to_contact, 0.14 / 0.5, 1e-6);
  for (int step = 51; step <= 300; ++step) {
    scene_.place(b, at(1.14 + 0.0005 * (step - 50)), std::chrono::milliseconds(2 * step + 1));
    found = measure(meter, 2 * step + 1);
  }
  EXPECT_NEAR(found->pairs[0].closing_speed, -0.25, 1e-3);
  EXPECT_TRUE(std::isinf(found->pairs[0].time_to_contact));
}

TEST_F(PairMeterTest, NoContactBeforeRestsOnBoundsThatSomebodyVouchesForOrIsFlagged) {
  Body slow = ballOf(*phase_, "slow", 0.5), still = test::ball("still", 0.5, Mobility::fixed);
  still.shapes[0].solid = phase_->solidOf(still.shapes[0].shape);
  slow.speed_bound = 0.5;
  Body unknown = ballOf(*phase_, "unknown", 0.5);
  unknown.max_speed = 2.0;  // nobody vouches for this
  put(scene_, slow, at(0.0), std::chrono::milliseconds(100));
  put(scene_, still, at(1.1), std::chrono::milliseconds(100));
  put(scene_, unknown, at(-1.1), std::chrono::milliseconds(100));
  PairMeter meter = meterOf(0.3);
  const auto found = measure(meter, 120);  // the poses are 20 ms old
  ASSERT_EQ(found->pairs.size(), 2u);
  for (const PairDistance& pair : found->pairs) {
    const bool with_unknown = snapshot_->structure().bodies[pair.second].name == "obstacle/unknown";
    if (with_unknown) {
      EXPECT_NEAR(pair.no_contact_before, (0.1 - 2.5 * 0.02) / 2.5, 1e-9);
    } else {
      EXPECT_NEAR(pair.no_contact_before, (0.1 - 0.5 * 0.02) / 0.5, 1e-9);
    }
    EXPECT_EQ(pair.flags & kAssumedFlag, with_unknown ? kAssumedFlag : 0);
  }
}

/// Claim: what is said about the distance now counts the age of poses: bounds get smaller, estimates become unknown.
TEST_F(PairMeterTest, OldPosesLowerTheBoundAndEndTheEstimates) {
  const BodyId a = add("a", 0.0), b = add("b", 1.19);
  PairMeter meter = meterOf(0.3);
  std::shared_ptr<const PairDistances> found;
  for (int step = 0; step <= 20; ++step) {
    scene_.place(b, at(1.19 - 0.001 * step), std::chrono::milliseconds(2 * step + 1));
    found = measure(meter, 2 * step + 1);
  }
  ASSERT_EQ(found->pairs.size(), 1u);
  EXPECT_EQ(found->pairs[0].approach, Approach::approaching);
  EXPECT_EQ(found->pairs[0].lower_bound, found->pairs[0].proximity.distance);
  scene_.setState(a, Freshness::stale, 0.3);
  found = measure(meter, 43);
  ASSERT_EQ(found->pairs.size(), 1u);
  const PairDistance& pair = found->pairs[0];
  EXPECT_NEAR(pair.proximity.distance, 0.17, 1e-9) << "at the poses";
  EXPECT_NEAR(pair.lower_bound, std::max(0.0, 0.17 - snapshot_->poses()[0].reach), 1e-9);
  EXPECT_GT(snapshot_->poses()[0].reach, 0.0);
  EXPECT_EQ(pair.approach, Approach::unknown);
  EXPECT_TRUE(std::isnan(pair.closing_speed) && std::isnan(pair.time_to_contact));
}

TEST_F(PairMeterTest, APairThatTheSolverFailsOnIsKeptAsContactAndCounted) {
  add("a", 0.0);
  add("b", 1.1);
  phase_->fails = true;
  PairMeter meter = meterOf(0.3);
  const auto found = measure(meter, 1);
  ASSERT_EQ(found->pairs.size(), 1u);
  EXPECT_EQ(found->failed, 1u);
  EXPECT_TRUE(isContact(found->pairs[0].proximity.status));
  EXPECT_EQ(found->pairs[0].time_to_contact, 0.0);
}

TEST_F(PairMeterTest, ShapesWithoutASolidAreNotMeasured) {
  put(scene_, test::ball("a"), at(0.0));
  add("b", 1.1);
  PairMeter meter = meterOf(0.3);
  const auto found = measure(meter, 1);
  ASSERT_EQ(found->pairs.size(), 1u);
  EXPECT_EQ(found->pairs[0].proximity.status, Measure::not_measured);
}

TEST_F(PairMeterTest, ThreadsDoNotShow) {
  test::Random random(4);
  for (int i = 0; i < 120; ++i) add(std::to_string(i), random.uniform(0, 100), random.uniform(0.2, 0.6));
  PairMeter one = meterOf(0.3), three = meterOf(0.3, 0.0, 3);
  const auto a = measure(one, 1);
  const auto b = three.measure(*snapshot_);
  ASSERT_GT(a->pairs.size(), 20u);
  ASSERT_EQ(a->pairs.size(), b->pairs.size());
  for (std::size_t i = 0; i < a->pairs.size(); ++i) {
    EXPECT_EQ(a->pairs[i].first, b->pairs[i].first);
    EXPECT_EQ(a->pairs[i].second, b->pairs[i].second);
    EXPECT_EQ(a->pairs[i].proximity.distance, b->pairs[i].proximity.distance);
  }
}

TEST_F(PairMeterTest, ABodyOfWhichNothingWasReadIsNotMeasured) {
  put(scene_, test::obstacle("bare"), at(0));
  add("ball", 0.0);
  snapshot_ = scene_.commit(std::chrono::milliseconds(1), {});
  const PairDistance found = measurePair(*phase_, *snapshot_, 0, 1, 1.0);
  EXPECT_EQ(found.proximity.status, Measure::not_measured);
  EXPECT_TRUE(std::isnan(found.proximity.distance));
}

TEST_F(PairMeterTest, ContactsTellTheirShapesDeepestFirst) {
  Body pile = ballOf(*phase_, "pile", 0.3);
  for (const double radius : {0.1, 0.5, 0.2}) {
    Body one = ballOf(*phase_, "one", radius);
    pile.shapes.push_back(one.shapes.front());
  }
  put(scene_, pile, at(0.0));
  add("wall", 0.75, 0.4);  // touches only the sphere of radius 0.5 m
  add("floor", 0.2, 0.4);  // touches all four spheres
  snapshot_ = scene_.commit(std::chrono::milliseconds(1), {});
  const Structure& structure = snapshot_->structure();
  const std::uint32_t pile_number = structure.find("obstacle/pile");
  const auto with = [&](const char* other, std::size_t most) {
    return contactsOf(*phase_, *snapshot_, pile_number, structure.find(other), most);
  };
  std::vector<PairContact> found = with("obstacle/wall", 10);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].first_shape, 2u);
  found = with("obstacle/floor", 10);
  ASSERT_EQ(found.size(), 4u);
  const std::vector<std::uint32_t> expected{2, 0, 3, 1};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(found[i].first_shape, expected[i]);
  EXPECT_EQ(with("obstacle/floor", 3).size(), 3u);
  EXPECT_TRUE(with("obstacle/floor", 0).empty());
}

/// Claim: an exception in any measurement, on any thread, reaches the caller. Afterwards the meter gives the same
/// results as a new one.
TEST_F(PairMeterTest, AnExceptionReachesTheCallerAndTheMeterWorksAgain) {
  for (int i = 0; i < 40; ++i) add(std::to_string(10 + i), 1.05 * i);
  for (const int threads : {1, 2, 4}) {
    PairMeter meter = meterOf(0.2, 0.0, threads);
    for (const int throws_at : {1, 2, 20, 38, 39}) {
      SCOPED_TRACE("threads " + std::to_string(threads) + ", measurement " + std::to_string(throws_at));
      PairMeter fresh = meterOf(0.2, 0.0, threads);
      phase_->asked = 0;
      phase_->throws_at = throws_at;
      EXPECT_THROW(measure(fresh, 1), std::bad_alloc);
      phase_->throws_at = 0;
      const auto found = measure(fresh, 2), expected = measure(meter, 3);
      ASSERT_EQ(found->pairs.size(), 39u);
      ASSERT_EQ(expected->pairs.size(), 39u);
      for (std::size_t i = 0; i < 39; ++i) {
        EXPECT_EQ(found->pairs[i].first, expected->pairs[i].first);
        EXPECT_EQ(found->pairs[i].second, expected->pairs[i].second);
        EXPECT_EQ(found->pairs[i].proximity.distance, expected->pairs[i].proximity.distance);
      }
    }
  }
}

TEST_F(PairMeterTest, AnExceptionOfAnotherThreadReachesTheCaller) {
  for (int i = 0; i < 40; ++i) add(std::to_string(10 + i), 1.05 * i);
  for (const int threads : {2, 4}) {
    SCOPED_TRACE("threads " + std::to_string(threads));
    PairMeter meter = meterOf(0.2, 0.0, threads);
    phase_->thrown = false;
    phase_->throws_beside = std::this_thread::get_id();
    EXPECT_THROW(measure(meter, 1), std::bad_alloc);
    phase_->throws_beside = std::thread::id();
    EXPECT_EQ(measure(meter, 2)->pairs.size(), 39u);
  }
}

/// Claim: a flat box just above a floor stays in the list, however large both are.
TEST(PairMeter, LargeBodiesThatAlmostTouchAreListedInEachTick) {
  const std::shared_ptr<NarrowPhase> phase = makeCoreNarrowPhase();
  for (const double size : {1.0, 100.0, 1000.0}) {
    for (int turn = 0; turn < 20; ++turn) {
      SceneOptions options;
      options.margin = 0.2;
      Scene scene(options);
      const auto add = [&](const char* name, const Eigen::Vector3d& sides) {
        Body body = test::obstacle(name, Mobility::moving);
        body.max_speed = 1.0;
        body.shapes.push_back(test::shapeOf(Shape::box(sides)));
        body.shapes.front().solid = phase->solidOf(body.shapes.front().shape);
        return scene.add(body);
      };
      const BodyId floor = add("floor", {size, size, 0.2}), plate = add("plate", {0.4 * size, 0.3 * size, 0.1});
      Pose of_plate = Pose::Identity();
      of_plate.linear() = Eigen::AngleAxisd(0.0157 * turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      PairMeter meter(phase, MeterOptions{});
      for (int tick = 0; tick < 20; ++tick) {
        of_plate.translation() << 0.1 * size + 1e-9 * (tick % 7), 0.05 * size, 0.05 + 1.2e-6;
        scene.place(floor, Pose(Eigen::Translation3d(0.0, 0.0, -0.1)), Time{1 + tick});
        scene.place(plate, of_plate, Time{1 + tick});
        const auto found = meter.measure(*scene.commit(Time{1 + tick}, {}));
        ASSERT_EQ(found->pairs.size(), 1u) << "size " << size << ", turn " << turn << ", tick " << tick;
        ASSERT_NEAR(found->pairs[0].proximity.distance, 1.2e-6, 1e-9 + 1e-12 * size);
      }
    }
  }
}

}  // namespace
}  // namespace hgrid
