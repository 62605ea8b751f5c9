// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include "hgrid_proximity/history/history.h"
#include "hgrid_proximity/queries/query.h"
#include "test/support/maps.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using std::chrono::milliseconds;
using Outcome = PastTick::Outcome;

/// A scene of moving spheres with a history. Ticks are 20 ms apart.
class Played {
 public:
  explicit Played(const HistoryLimits& limits, int bodies = 20) : history(limits) {
    for (int i = 0; i < bodies; ++i)
      ids_.push_back(test::put(scene, test::ball("b" + std::to_string(i)), test::at(2.0 * i)));
  }
  void ticks(int count) {
    for (; count > 0; --count) {
      add();
      history.compact();
    }
  }
  void add() {
    stamp_ += milliseconds(20);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      scene.place(ids_[i], test::at(2.0 * double(i), 1e-9 * double(stamp_.count())), stamp_);
    }
    newest = scene.commit(stamp_, {});
    history.add(newest);
  }
  PastTick find(milliseconds ago) const { return history.find(newest->stamp() - ago, *newest); }

  Scene scene{SceneOptions{}};
  History history;
  std::shared_ptr<const Snapshot> newest;

 private:
  std::vector<BodyId> ids_;
  Time stamp_{milliseconds(1000)};
};

HistoryLimits limitsOf(milliseconds span, std::size_t bytes = 64u << 20) {
  HistoryLimits limits;
  limits.span = span;
  limits.bytes = bytes;
  return limits;
}

/// Returns the cells of a map that need about 100 kB.
std::shared_ptr<const MapCells> largeCells(unsigned seed) {
  test::Random random(seed);
  return test::cellsOf(0.05, test::randomVoxels(random, 20000, 10000));
}

TEST(HistoryLimits, TheSpanSaysHowFarBackOneCanAsk) {
  Played played(limitsOf(milliseconds(100)));
  played.ticks(20);
  EXPECT_EQ(played.find(milliseconds(100)).snapshot->sequence(), 15u);
  EXPECT_EQ(played.find(milliseconds(99)).snapshot->sequence(), 15u) << "the last tick that is not later";
  EXPECT_EQ(played.find(milliseconds(80)).snapshot->sequence(), 16u);
  EXPECT_EQ(played.find(milliseconds(1)).snapshot->sequence(), 19u);
  EXPECT_EQ(played.find(milliseconds(101)).outcome, Outcome::too_old);
  const HistoryExtent extent = played.history.extent();
  EXPECT_EQ(extent.ticks, 6u);
  EXPECT_EQ(extent.begin, played.newest->stamp() - milliseconds(100));
  EXPECT_EQ(extent.end, played.newest->stamp());
  EXPECT_EQ(extent.dropped, 0u) << "only the limit of bytes counts";
}

TEST(HistoryLimits, TheHistoryBecomesShorterWhenItsBytesAreUsedUp) {
  Played free(limitsOf(milliseconds(2000)));
  free.ticks(50);
  const std::size_t bytes = free.history.extent().bytes;
  EXPECT_EQ(free.history.extent().ticks, 50u);
  Played played(limitsOf(milliseconds(2000), bytes / 2));
  played.ticks(50);
  const HistoryExtent extent = played.history.extent();
  EXPECT_LE(extent.bytes, bytes / 2);
  EXPECT_GT(extent.ticks, 20u);
  EXPECT_LT(extent.ticks, 30u);
  EXPECT_EQ(extent.dropped, 50 - extent.ticks);
  EXPECT_EQ(extent.begin, played.newest->stamp() - milliseconds(20) * (extent.ticks - 1));
  EXPECT_EQ(played.find(milliseconds(980)).outcome, Outcome::too_old);
}

TEST(HistoryLimits, WithoutRoomForATickNothingIsKept) {
  Played played(limitsOf(milliseconds(2000), 100));
  played.ticks(5);
  EXPECT_EQ(played.history.extent().ticks, 0u);
  EXPECT_EQ(played.history.extent().bytes, 0u);
  EXPECT_EQ(played.find(milliseconds(20)).outcome, Outcome::too_old);
}

TEST(HistoryLimits, TicksShareWhatDidNotChange) {
  Played played(limitsOf(milliseconds(2000)), 320);
  played.ticks(10);
  const std::size_t moving = played.history.extent().bytes;
  Scene& scene = played.scene;
  History history(limitsOf(milliseconds(2000)));
  for (int tick = 1; tick <= 10; ++tick) {
    history.add(scene.commit(Time{milliseconds(20) * tick}, {}));
    history.compact();
  }
  EXPECT_LT(history.extent().bytes, moving / 4) << "320 bodies that rest are stored once, not ten times";
}

TEST(HistoryLimits, CellsCountOnceAndOnlyWhenTheNewestTickNoLongerUsesThem) {
  Played played(limitsOf(milliseconds(2000)), 1);
  const BodyId map = test::put(played.scene, test::mapBody("hall"), test::at(0));
  auto cells = largeCells(1);
  const std::size_t size = cells->grid->bytes();
  ASSERT_GT(size, 50000u);
  played.scene.setCells(map, cells);
  played.ticks(10);
  const std::size_t before = played.history.extent().bytes;
  EXPECT_LT(before, size) << "the map exists anyway";
  played.scene.setCells(map, largeCells(2));
  played.ticks(1);
  const std::size_t with_old = played.history.extent().bytes;
  EXPECT_GT(with_old, size);
  EXPECT_LT(with_old, before + 3 * size / 2) << "ten ticks share the cells";
  const std::weak_ptr<const MapCells> old = cells;
  cells.reset();
  EXPECT_FALSE(old.expired());
  EXPECT_EQ(played.find(milliseconds(20)).snapshot->cells().front(), old.lock());
  played.ticks(100);
  EXPECT_TRUE(old.expired()) << "no kept tick needs the old cells";
  EXPECT_LT(played.history.extent().bytes, size + 100 * 1000);
}

TEST(HistoryLimits, OldCellsDoNotLiveBeyondTheBytes) {
  Played played(limitsOf(milliseconds(2000), 60000), 1);
  const BodyId map = test::put(played.scene, test::mapBody("hall"), test::at(0));
  auto cells = largeCells(1);
  ASSERT_GT(cells->grid->bytes(), 60000u);
  played.scene.setCells(map, cells);
  played.ticks(10);
  EXPECT_EQ(played.history.extent().ticks, 10u);
  const std::weak_ptr<const MapCells> old = cells;
  cells.reset();
  played.scene.setCells(map, largeCells(2));
  played.ticks(1);
  EXPECT_TRUE(old.expired());
  EXPECT_EQ(played.history.extent().ticks, 1u);
  EXPECT_EQ(played.history.extent().dropped, 10u);
}

TEST(HistoryLimits, RemovedBodiesCount) {
  Played played(limitsOf(milliseconds(2000)), 1);
  test::Random random(1);
  Body body = test::obstacle("part");
  body.shapes.push_back(test::shapeOf(Shape::mesh(test::randomMesh(random, 1.0, 1000))));
  const BodyId part = test::put(played.scene, body, test::at(0));
  played.ticks(10);
  const std::size_t before = played.history.extent().bytes;
  played.scene.remove(part);
  played.ticks(1);
  EXPECT_GT(played.history.extent().bytes, before + 1000 * (sizeof(Eigen::Vector3d) + 12));
  played.ticks(101);
  Played without(limitsOf(milliseconds(2000)), 1);
  without.ticks(120);
  EXPECT_EQ(played.history.extent().bytes, without.history.extent().bytes) << "no kept tick has the part any more";
}

TEST(HistoryLimits, NoSnapshotIsKeptAlive) {
  Played played(limitsOf(milliseconds(2000)));
  played.add();
  const std::weak_ptr<const Snapshot> live = played.newest;
  played.history.compact();
  played.ticks(1);
  EXPECT_TRUE(live.expired());
}

TEST(HistoryLimits, AFewPastSnapshotsAreKeptForTheNextQueries) {
  Played played(limitsOf(milliseconds(2000)));
  played.ticks(20);
  const std::size_t before = played.history.extent().bytes;
  const std::weak_ptr<const Snapshot> first = played.find(milliseconds(100)).snapshot;
  ASSERT_FALSE(first.expired());
  EXPECT_EQ(played.find(milliseconds(100)).snapshot, first.lock());
  EXPECT_GT(played.history.extent().bytes, before) << "they count";
  for (int ago : {120, 140, 160}) played.find(milliseconds(ago));
  EXPECT_EQ(played.find(milliseconds(100)).snapshot, first.lock());
  const std::weak_ptr<const Snapshot> longest_ago = played.find(milliseconds(120)).snapshot;
  for (int ago : {180, 200, 220, 240}) played.find(milliseconds(ago));
  EXPECT_TRUE(first.expired());
  EXPECT_TRUE(longest_ago.expired());
}

TEST(HistoryLimits, PastSnapshotsMakeRoomForTicks) {
  Played free(limitsOf(milliseconds(2000)));
  free.ticks(50);
  const std::size_t bytes = free.history.extent().bytes;
  Played played(limitsOf(milliseconds(2000), bytes + 100));
  played.ticks(40);
  for (int ago : {100, 120, 140, 160}) ASSERT_TRUE(played.find(milliseconds(ago)).snapshot);
  EXPECT_LE(played.history.extent().bytes, bytes + 100);
  played.ticks(10);
  EXPECT_EQ(played.history.extent().ticks, 50u);
  EXPECT_EQ(played.history.extent().dropped, 0u);
}

TEST(HistoryLimits, ANewEpochDropsTheTicksOfTheOldOne) {
  Played played(limitsOf(milliseconds(2000)));
  played.ticks(10);
  const std::shared_ptr<const Snapshot> old = played.newest;
  played.scene.beginEpoch(7);
  played.ticks(3);
  const HistoryExtent extent = played.history.extent();
  EXPECT_EQ(extent.ticks, 3u);
  EXPECT_EQ(extent.epoch, 7u);
  EXPECT_EQ(played.find(milliseconds(40)).snapshot->sequence(), 1u);
  EXPECT_EQ(played.find(milliseconds(60)).outcome, Outcome::too_old);
  EXPECT_EQ(played.history.find(old->stamp() - milliseconds(20), *old).outcome, Outcome::too_old);
  Played fresh(limitsOf(milliseconds(2000)));
  fresh.ticks(3);
  EXPECT_EQ(extent.bytes, fresh.history.extent().bytes);
}

TEST(HistoryLimits, TheTickBeforeANewestTickThatWasNotAddedYetIsFound) {
  Played played(limitsOf(milliseconds(2000)));
  played.ticks(3);
  const auto newest = played.scene.commit(played.newest->stamp() + milliseconds(20), {});
  EXPECT_EQ(played.history.find(newest->stamp() - milliseconds(1), *newest).snapshot->sequence(), 3u);
}

TEST(HistoryLimits, WhatWasNotKeptIsNotAnsweredFromAnOlderTick) {
  Played played(limitsOf(milliseconds(2000)));
  for (int i = 0; i < 6; ++i) played.add();  // nobody calls compact(), so ticks 5 and 6 are skipped
  EXPECT_EQ(played.history.extent().skipped, 2u);
  EXPECT_EQ(played.history.extent().ticks, 4u);
  played.ticks(1);
  EXPECT_EQ(played.history.extent().skipped, 3u);
  played.ticks(2);
  EXPECT_EQ(played.find(milliseconds(20)).snapshot->sequence(), 8u);
  for (int ago : {21, 60, 99}) EXPECT_EQ(played.find(milliseconds(ago)).outcome, Outcome::skipped) << ago;
  EXPECT_EQ(played.find(milliseconds(100)).outcome, Outcome::skipped)
      << "the tick is there, but it is not the last one";
  EXPECT_EQ(played.find(milliseconds(101)).snapshot->sequence(), 3u);
}

TEST(HistoryLimits, OfTicksWithOneStampOnlyTheLastIsKept) {
  Played played(limitsOf(milliseconds(2000)));
  played.ticks(2);
  const auto again = [&](Time later) {
    const auto snapshot = played.scene.commit(played.newest->stamp() + later, {});
    played.history.add(snapshot);
    played.history.compact();
    return snapshot;
  };
  const std::size_t bytes = played.history.extent().bytes;
  for (int i = 0; i < 50; ++i) again(Time{0});
  EXPECT_EQ(played.history.extent().ticks, 2u);
  EXPECT_EQ(played.history.extent().bytes, bytes) << "while time stands still, the history does not grow";
  const auto newest = again(milliseconds(20));
  EXPECT_EQ(played.history.find(newest->stamp() - milliseconds(1), *newest).snapshot->sequence(), 52u);
  EXPECT_EQ(played.history.find(newest->stamp() - milliseconds(21), *newest).snapshot->sequence(), 1u);
}

TEST(HistoryLimits, ANoteComesBackWithItsTick) {
  Played played(limitsOf(milliseconds(2000)));
  const auto note = std::make_shared<const int>(42);
  played.add();
  History history(limitsOf(milliseconds(2000)));
  history.add(played.newest, note);
  history.compact();
  played.add();
  EXPECT_EQ(history.find(played.newest->stamp() - milliseconds(20), *played.newest).note, note);
}

}  // namespace
}  // namespace hgrid
