// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests the answers of queries whose deadline passes before the queries have examined everything.
#include <gtest/gtest.h>

#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/scenes.h"
#include "test/support/told.h"
#include "test/support/worlds.h"

namespace hgrid {
namespace test {
namespace {

using Clock = std::chrono::steady_clock;

QueryScope until(Clock::time_point deadline) {
  QueryScope scope;
  scope.deadline = deadline;
  return scope;
}
QueryScope withoutTime() { return until(Clock::now()); }

void expectCut(const QueryAnswer& answer) {
  EXPECT_EQ(answer.verdict, Verdict::unknown);
  EXPECT_EQ(answer.because, Unknown::budget);
  EXPECT_FALSE(answer.examined_all);
  EXPECT_FALSE(answer.reason.empty());
}

TEST(Deadline, WithoutTimeNothingThatNeedsAnExaminationIsClear) {
  Scene scene{SceneOptions{}};
  put(scene, ball("a"), at(0));
  put(scene, ball("b"), at(1));
  scene.setCells(put(scene, mapBody("room"), at(50)), cellsOf(0.1, {}));
  const auto snapshot = scene.commit(Time{1}, {});
  expectCut(query(*snapshot, Sphere{{0, 0, 0}, 1}, withoutTime()));
  expectCut(query(*snapshot, Sphere{{50, 0, 0}, 1}, withoutTime()));
  expectCut(query(*snapshot, Segment{{-9, 0, 0}, {9, 0, 0}, 0.1}, withoutTime()));
  expectCut(nearest(*snapshot, Eigen::Vector3d(0, 0, 0), 0.0, withoutTime()));
  expectCut(nearest(*snapshot, indexOf(*snapshot, "obstacle/a"), 0.0, withoutTime()));
}

TEST(Deadline, WithoutTimeADoubtThatWasNotExaminedIsNotClear) {
  Scene scene{SceneOptions{}};
  Body body = ball("a");
  body.max_speed = 1.0;
  scene.setState(put(scene, body, at(0)), Freshness::lost, 1.0);
  const auto snapshot = scene.commit(Time{1}, {});
  EXPECT_EQ(query(*snapshot, Sphere{{9, 0, 0}, 1}, {}).verdict, Verdict::clear);
  expectCut(query(*snapshot, Sphere{{9, 0, 0}, 1}, withoutTime()));
}

TEST(Deadline, WhereThereIsNothingToExamineItDoesNotMatter) {
  Scene scene{SceneOptions{}};
  put(scene, ball("a"), at(0));
  const QueryAnswer answer = query(*scene.commit(Time{1}, {}), Sphere{{50, 0, 0}, 1}, withoutTime());
  EXPECT_EQ(answer.verdict, Verdict::clear);
  EXPECT_TRUE(answer.examined_all);
}

TEST(Deadline, WithEnoughTimeAnswersAreTheSame) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Scene scene{SceneOptions{}};
    for (int i = 0; i < 40; ++i) putRandom(scene, random, "o" + std::to_string(i), 4.0);
    const auto snapshot = scene.commit(Time{1}, {});
    const QueryScope hour = until(Clock::now() + std::chrono::hours(1));
    for (int i = 0; i < 20; ++i) {
      const Sphere sphere{randomVector(random, -5, 5), random.uniform(0, 2)};
      const QueryAnswer limited = query(*snapshot, sphere, hour), unlimited = query(*snapshot, sphere, {});
      ASSERT_TRUE(limited.examined_all);
      ASSERT_EQ(limited.verdict, unlimited.verdict);
      ASSERT_EQ(limited.total, unlimited.total);
    }
  }
}

/// A narrow phase that returns contact for every pair of shapes. After `fast` measurements, each further measurement
/// lasts until the deadline.
class SlowNarrowPhase final : public NarrowPhase {
 public:
  SlowNarrowPhase(int fast, Clock::time_point deadline) : fast_(fast), deadline_(deadline) {}
  std::shared_ptr<const Solid> solidOf(const Shape&) override { return std::make_shared<Solid>(); }
  std::shared_ptr<const Solid> plane() const override { return std::make_shared<Solid>(); }
  std::shared_ptr<const Solid> point() const override { return std::make_shared<Solid>(); }
  std::shared_ptr<const Solid> needle(double) const override { return std::make_shared<Solid>(); }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d&) const override { return std::make_shared<Solid>(); }
  Proximity measure(const PlacedSolid&, const PlacedSolid&, double) const override {
    if (++measured_ > fast_) {
      while (Clock::now() < deadline_) continue;
    }
    Proximity found;
    found.status = Measure::contact;
    found.distance = 0.0;
    return found;
  }
  Contact measureContact(const PlacedSolid&, const PlacedSolid&) const override { return {}; }
  std::vector<Contact> contacts(const PlacedSolid&, const PlacedSolid&, std::size_t) const override { return {}; }

 private:
  const int fast_;
  const Clock::time_point deadline_;
  mutable int measured_ = 0;
};

TEST(Deadline, WhatWasHitBeforeItIsAHit) {
  const Clock::time_point deadline = Clock::now() + std::chrono::milliseconds(300);
  SlowNarrowPhase narrow_phase(2, deadline);
  Scene scene{SceneOptions{}};
  for (int i = 0; i < 10; ++i) {
    Body body = ball("o" + std::to_string(i));
    body.shapes[0].solid = narrow_phase.solidOf(body.shapes[0].shape);
    put(scene, body, at(0));
  }
  QueryScope scope = until(deadline);
  scope.exact = &narrow_phase;
  const QueryAnswer answer = query(*scene.commit(Time{1}, {}), Sphere{{0, 0, 0}, 1}, scope);
  EXPECT_EQ(answer.verdict, Verdict::hit);
  EXPECT_EQ(answer.because, Unknown::no);
  EXPECT_FALSE(answer.examined_all);
  EXPECT_EQ(answer.total, 3u) << "two fast measurements, and the one during which the deadline passed";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
