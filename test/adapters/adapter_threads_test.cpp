// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Several threads may read robots, meshes and maps at the same time. Each gets the same result as a single thread.
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "hgrid_proximity/adapters/octomap.h"
#include "test/adapters/urdf_texts.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

constexpr int kThreads = 4;

/// Calls `work` on several threads, with the number of the thread. Waits until all have returned.
void onThreads(const std::function<void(int)>& work) {
  std::vector<std::thread> threads;
  for (int number = 0; number < kThreads; ++number) threads.emplace_back(work, number);
  for (std::thread& thread : threads) thread.join();
}

/// Returns what is said about the first shape of a robot, which cannot be read.
std::string troubleOf(const std::string& urdf) { return readUrdf(urdf, {}).links.at(0).unreadable.at(0).what(); }

/// Claim: a thread gets the error that urdfdom reports about its own robot. urdfdom reports errors to a global log.
TEST(AdapterThreads, ReadRobotsAndTheirErrors) {
  std::vector<std::string> texts, expected;
  for (int number = 0; number < kThreads; ++number) {
    texts.push_back(robot(link("a", collision("<sphere radius=\"no_number" + std::to_string(number) + "\"/>"))));
    expected.push_back(troubleOf(texts.back()));
    ASSERT_TRUE(says(expected.back(), "is not a valid float")) << "this test needs an error that urdfdom reports";
  }
  std::vector<int> wrong(kThreads, 0);
  onThreads([&](int number) {
    for (int i = 0; i < 500; ++i) wrong[number] += troubleOf(texts[number]) != expected[number];
  });
  EXPECT_EQ(wrong, std::vector<int>(kThreads, 0));
}

/// Claim: the helper process of one thread keeps open no file of another thread's helper.
TEST(AdapterThreads, ReadMeshes) {
  const auto read = [] {
    MeshLoader loader(meshPolicy());
    return loader.load("package://hgrid_test/meshes/corner.stl", Eigen::Vector3d::Ones());
  };
  const auto expected = read();
  std::vector<int> wrong(kThreads, 0);
  onThreads([&](int number) {
    for (int i = 0; i < 10; ++i) wrong[number] += read()->vertices != expected->vertices;
  });
  EXPECT_EQ(wrong, std::vector<int>(kThreads, 0));
}

TEST(AdapterThreads, ReadMaps) {
  const std::string file = fileText(std::string(HGRID_PROJECT_DIR) + "/demo/room.bt");
  const std::size_t expected = readOctomap(file, "room").occupied.size();
  std::vector<std::size_t> sizes(kThreads, 0);
  onThreads([&](int number) { sizes[number] = readOctomap(file, "room").occupied.size(); });
  EXPECT_EQ(sizes, std::vector<std::size_t>(kThreads, expected));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
