// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "hgrid_proximity/queries/query.h"
#include "test/support/scenes.h"

namespace hgrid {
namespace {

using test::Random;

/// A copy of the data of a snapshot for later comparisons.
struct Copy {
  explicit Copy(const Snapshot& snapshot)
      : sequence(snapshot.sequence()), boxes(snapshot.boxes()), reasons(snapshot.reasons()) {
    for (const NearPair& pair : snapshot.pairs()) {
      pairs.emplace_back(snapshot.structure().bodies[pair.first].name, snapshot.structure().bodies[pair.second].name,
                         pair.gap, pair.since.count());
    }
    for (const BodyPose& pose : snapshot.poses())
      states.emplace_back(pose.state, pose.world_from_body.translation().x());
    for (const QueryAnswer& answer :
         {query(snapshot, Sphere{{0, 0, 0}, 2}, {}), query(snapshot, Segment{{-3, 0, 0}, {3, 0, 0}, 0.5}, {})}) {
      for (const QueryHit& hit : answer.hits) hits.emplace_back(hit.body, hit.distance);
    }
  }
  bool operator==(const Copy& o) const {
    return sequence == o.sequence && boxes == o.boxes && reasons == o.reasons && pairs == o.pairs &&
           states == o.states && hits == o.hits;
  }
  std::uint64_t sequence;
  std::vector<Aabb> boxes;
  std::vector<std::string> reasons;
  std::vector<std::tuple<std::string, std::string, double, std::int64_t>> pairs;
  std::vector<std::pair<Freshness, double>> states;
  std::vector<std::pair<std::uint32_t, double>> hits;
};

void anotherTick(Scene& scene, Random& random, std::vector<BodyId>& ids, int tick) {
  if (tick % 3 == 0 && ids.size() > 10) {
    scene.remove(ids.back());
    ids.pop_back();
  } else if (ids.size() < 40) {
    ids.push_back(test::putRandom(scene, random, "t" + std::to_string(tick), 2.0));
  }
  for (const BodyId& id : ids) {
    if (random.chance(0.5)) scene.place(id, test::randomPose(random, 2.0), Time{tick});
    scene.setState(id, static_cast<Freshness>(random.below(6)), random.uniform(0, 2));
  }
}

TEST(SceneThreads, ASnapshotStaysWhatItWasWhileTheSceneGoesOn) {
  Scene scene{SceneOptions{}};
  Random random(1);
  std::vector<BodyId> ids;
  std::vector<std::shared_ptr<const Snapshot>> kept;
  std::vector<Copy> copies;
  for (int tick = 1; tick <= 100; ++tick) {
    anotherTick(scene, random, ids, tick);
    const auto snapshot = scene.commit(Time{tick}, {});
    if (tick % 4 == 0) {
      kept.push_back(snapshot);
      copies.emplace_back(*snapshot);
    }
    for (std::size_t i = 0; i < kept.size(); i += 5) ASSERT_TRUE(Copy(*kept[i]) == copies[i]) << "tick " << tick;
  }
}

TEST(SceneThreads, ASnapshotOutlivesItsScene) {
  std::shared_ptr<const Snapshot> snapshot;
  {
    Scene scene{SceneOptions{}};
    Random random(2);
    std::vector<BodyId> ids;
    for (int tick = 1; tick <= 30; ++tick) anotherTick(scene, random, ids, tick);
    Scene moved = std::move(scene);
    snapshot = moved.commit(Time{1}, {});
  }
  EXPECT_FALSE(snapshot->pairs().empty());
  EXPECT_GT(query(*snapshot, Sphere{{0, 0, 0}, 5}, {}).total, 5u);
}

/// Readers query snapshots while the writer commits. ThreadSanitizer also finds data races between them.
TEST(SceneThreads, ReadersAskSnapshotsWhileTheWriterCommits) {
  std::mutex mutex;
  std::shared_ptr<const Snapshot> latest;
  std::atomic<bool> done{false};
  std::atomic<int> asked{0}, changed{0}, backwards{0};
  const auto current = [&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return latest;
  };
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      while (!done) {
        const std::shared_ptr<const Snapshot> snapshot = current();
        if (!snapshot) {
          std::this_thread::yield();
          continue;
        }
        backwards += snapshot->sequence() < last;
        last = snapshot->sequence();
        const Copy once(*snapshot), twice(*snapshot);
        changed += !(once == twice);
        ++asked;
      }
    });
  }
  Scene scene{SceneOptions{}};
  Random random(3);
  std::vector<BodyId> ids;
  // Runs at least 300 ticks. Continues until the readers have read 30 snapshots.
  for (int tick = 1; tick <= 300 || (asked < 30 && tick < 1000000); ++tick) {
    anotherTick(scene, random, ids, tick);
    auto snapshot = scene.commit(Time{tick}, {});
    const std::lock_guard<std::mutex> lock(mutex);
    latest.swap(snapshot);
  }
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(changed, 0);
  EXPECT_EQ(backwards, 0);
  EXPECT_GE(asked, 30);
}

}  // namespace
}  // namespace hgrid
