// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/world/shared_obstacles.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

namespace hgrid {
namespace test {
namespace {

void add(SharedObstacles& shared, const std::string& name) {
  const SharedObstacles::Access access(shared);
  access.all()[name].owner = name;
}

TEST(SharedObstacles, AViewDoesNotChange) {
  SharedObstacles shared;
  add(shared, "a");
  const SharedObstacles::View view = shared.view();
  EXPECT_EQ(view.revision, shared.revision());
  add(shared, "b");
  EXPECT_EQ(view.obstacles->size(), 1u);
  EXPECT_EQ(shared.all().size(), 2u);
  EXPECT_GT(shared.revision(), view.revision);
  shared.clear(SharedObstacles::Spare());
  EXPECT_EQ(view.obstacles->size(), 1u);
  EXPECT_TRUE(shared.all().empty());
}

TEST(SharedObstacles, AreCopiedOnlyWhileAViewExists) {
  SharedObstacles shared;
  add(shared, "a");
  const PlacedObstacle* before = &shared.all().at("a");
  shared.view();
  add(shared, "b");
  EXPECT_EQ(&shared.all().at("a"), before);
  const SharedObstacles::View view = shared.view();
  add(shared, "c");
  EXPECT_NE(&shared.all().at("a"), before);
  EXPECT_EQ(&view.obstacles->at("a"), before);
}

/// Each obstacle is added with its owner, and the owners of all change together. A view must never show half of that.
TEST(SharedObstacles, MayBeViewedWhileTheyChange) {
  SharedObstacles shared;
  for (const char* name : {"a", "b", "c"}) add(shared, name);
  std::atomic<bool> end{false};
  std::atomic<int> torn{0}, views{0};
  std::thread reader([&] {
    while (!end) {
      const SharedObstacles::View view = shared.view();
      const std::string owner = view.obstacles->begin()->second.owner;
      for (const auto& obstacle : *view.obstacles) torn += obstacle.second.owner == owner || view.revision == 3 ? 0 : 1;
      ++views;
    }
  });
  for (int i = 0; i < 2000 || views < 100; ++i) {
    {
      const SharedObstacles::Access access(shared);
      for (auto& obstacle : access.all()) obstacle.second.owner = std::to_string(i);
    }
    std::this_thread::yield();  // lets the reader have the mutex
  }
  end = true;
  reader.join();
  EXPECT_EQ(torn, 0);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
