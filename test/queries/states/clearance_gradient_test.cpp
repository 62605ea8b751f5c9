// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Compares gradients of clearances with central differences.
#include <gtest/gtest.h>

#include "test/queries/states/state_worlds.h"

namespace hgrid {
namespace {

using namespace test;

constexpr double kReach = 0.3, kStep = 1e-5;  // [m] clearance that is asked for; [rad] or [m] half of a difference

/// Returns a state in which one variable has another value. A changed quaternion is normalized.
std::vector<double> moved(std::vector<double> state, std::size_t variable, double by,
                          const std::vector<JointVariable>& variables) {
  state[variable] += by;
  if (variables[variable].quaternion < 0) return state;
  const auto first = std::size_t(variables[variable].quaternion);
  double norm = 0.0;
  for (std::size_t k = first; k < first + 4; ++k) norm += state[k] * state[k];
  for (std::size_t k = first; k < first + 4; ++k) state[k] /= std::sqrt(norm);
  return state;
}

/// Claim: gradients are equal to central differences, except at few states where the nearest points jump.
TEST(ClearanceGradient, EqualsCentralDifferences) {
  int compared = 0, different = 0, own = 0;
  std::set<std::string> kinds;
  for (unsigned seed = 1; compared < 6000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    WorldPlan plan;
    plan.links = random.between(2, 7);
    plan.obstacles = random.between(0, 8);
    plan.map = random.chance(0.3);
    plan.world_from_root = randomPose(random, 1.0);
    const StateWorld world = randomStateWorld(random, plan);
    const StateChecker checker = world.checker();
    const std::vector<JointVariable>& variables = checker.kinematics().variables();
    if (variables.empty()) continue;
    StateBatch batch;
    for (std::size_t k = variables.size(); k > 0; --k) batch.joints.push_back(variables[k - 1].name);  // any order
    const auto appendRow = [&](std::vector<double> state) {
      std::reverse(state.begin(), state.end());
      append(batch, state);
    };
    StateRequest request;
    request.clearance = kReach;
    request.gradients = true;
    StateScratch scratch;
    StateAnswers answers, steps;
    for (int i = 0; i < 10; ++i) {
      const std::vector<double> state = randomState(random, checker.kinematics());
      batch.positions.clear();
      appendRow(state);
      checker.checkStates(batch, request, scratch, answers);
      ASSERT_EQ(answers.gradients.size(), variables.size());
      const double clearance = answers.states[0].clearance;
      if (!(clearance > 1e-3 && clearance < kReach - 1e-2)) {
        EXPECT_TRUE((clearance > 0.0 && clearance <= kReach) || std::isnan(answers.gradients[0]));
        continue;
      }
      const StatePair pair = answers.pairs[0];
      own += checker.moves(pair.second) ? 1 : 0;
      batch.positions.clear();
      for (std::size_t k = 0; k < variables.size(); ++k) {
        appendRow(moved(state, k, kStep, variables));
        appendRow(moved(state, k, -kStep, variables));
      }
      checker.checkStates(batch, request, scratch, steps);
      for (std::size_t k = 0; k < variables.size(); ++k) {
        const double difference = (steps.states[2 * k].clearance - steps.states[2 * k + 1].clearance) / (2 * kStep);
        ++compared;
        if (std::abs(difference - answers.gradients[variables.size() - 1 - k]) > 2e-3) {
          ++different;
        } else if (std::abs(difference) > 0.01) {
          kinds.insert(variables[k].name.substr(variables[k].name.find_last_of('_')));
        }
      }
    }
  }
  EXPECT_LT(different, compared / 50) << "of " << compared;
  EXPECT_GT(own, 100);
  EXPECT_GE(kinds.size(), 8u) << "all kinds of joints";
}

}  // namespace
}  // namespace hgrid
