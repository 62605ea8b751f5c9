// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Random edges, and an interpolation of their configurations that shares nothing with the product.
#pragma once

#include <cmath>
#include <vector>

#include "test/queries/states/state_worlds.h"

namespace hgrid {
namespace test {

/// The configurations of one edge.
class EdgeOracle {
 public:
  EdgeOracle(const StateChecker& checker, const RobotModel& model, std::vector<double> from, std::vector<double> to)
      : variables_(checker.kinematics().variables()), from_(std::move(from)), to_(std::move(to)) {
    for (const JointVariable& variable : variables_) {
      bool wraps = variable.is_angle;  // unless its joint is revolute with limits, or nobody knows them
      for (const RobotLink& link : model.links) {
        if (link.joint == variable.joint && link.joint_kind == JointKind::revolute) wraps = wraps && link.continuous;
        wraps = wraps && link.mimic != variable.joint;
      }
      wraps_.push_back(wraps);
    }
  }
  /// Returns the values of the variables at a place between 0 and 1.
  std::vector<double> at(double place) const {
    std::vector<double> state;
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      double way = to_[i] - from_[i];
      while (wraps_[i] && way > M_PI) way -= 2 * M_PI;
      while (wraps_[i] && way < -M_PI) way += 2 * M_PI;
      state.push_back(from_[i] + place * way);
    }
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      if (variables_[i].quaternion != int(i)) continue;
      const Eigen::Quaterniond turn = quaternion(from_, i).slerp(place, quaternion(to_, i)).normalized();
      for (std::size_t k = 0; k < 4; ++k) state[i + k] = turn.coeffs()[Eigen::Index(k)];
    }
    return state;
  }

 private:
  static Eigen::Quaterniond quaternion(const std::vector<double>& state, std::size_t i) {
    return {state[i + 3], state[i], state[i + 1], state[i + 2]};
  }
  std::vector<JointVariable> variables_;
  std::vector<bool> wraps_;
  std::vector<double> from_, to_;
};

/// A batch of random edges. Some are long, and some are short. The ends of some are shared.
struct RandomEdges {
  RandomEdges(Random& random, const StateChecker& checker, const RobotModel& robot, int count) : model(robot) {
    for (int i = 0; i < count; ++i) {
      states.push_back(randomState(random, checker.kinematics()));
      std::vector<double> end = randomState(random, checker.kinematics());
      const double part = random.chance(0.5) ? 1.0 : random.uniform(0.0, 0.3);
      end = EdgeOracle(checker, model, states.back(), end).at(part);
      states.push_back(end);
      const auto last = std::uint32_t(states.size() - 1);
      edges.push_back({last - 1, random.chance(0.8) ? last : std::uint32_t(random.below(int(last) + 1))});
    }
    for (const std::vector<double>& state : states) append(batch, state);
    for (const StateEdge& edge : edges) oracles.emplace_back(checker, model, states[edge.from], states[edge.to]);
  }
  const EdgeOracle& oracle(std::size_t edge) const { return oracles[edge]; }

  const RobotModel& model;
  std::vector<std::vector<double>> states;
  StateBatch batch;
  std::vector<StateEdge> edges;
  std::vector<EdgeOracle> oracles;
};

}  // namespace test
}  // namespace hgrid
