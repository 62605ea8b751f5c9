// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Threads may share solids and the narrow phase. They get the same answers as a single thread.
#include <gtest/gtest.h>

#include <thread>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

TEST(NarrowPhaseThreads, AnswerAsOneDoes) {
  std::vector<Case> placed;
  for (const KindPair& kinds : allKindPairs()) {
    Cases cases(16, kinds);
    for (int i = 0; i < 20; ++i) placed.push_back(cases.next());
  }
  std::vector<Trial> trials;
  std::vector<Proximity> expected;
  for (const Case& one : placed) {
    trials.emplace_back(one);
    expected.push_back(trials.back().measure());
  }
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (int& count : wrong) {
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < trials.size(); ++i) {
        const Trial made_here(placed[i]);  // at the same time, other threads create solids from these meshes
        count += !isSame(trials[i].measure(), expected[i]) || !isSame(made_here.measure(), expected[i]);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
