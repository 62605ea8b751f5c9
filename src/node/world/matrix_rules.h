// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "node/world/robot_models.h"
#include "node/world/rules_in_force.h"

namespace hgrid {

/// A rule of an allowed collision matrix of MoveIt, for names as MoveIt uses them: a name of a link without its robot,
/// "robot/link", the id of an object, or "<octomap>".
struct MatrixRule {
  std::string first;
  std::string second;   ///< empty: all bodies
  bool allowed = true;  ///< whether the two may touch
};

inline bool operator==(const MatrixRule& a, const MatrixRule& b) {
  return a.first == b.first && a.second == b.second && a.allowed == b.allowed;
}

/// Returns the rules for the bodies. A name that is a link of one robot means this link. A name that several robots
/// have makes no rule. Any other name means an object.
std::vector<PairRule> rulesOf(const std::vector<MatrixRule>& matrix, const RobotEntries& robots);

/// Keeps the newest allowed collision matrix of MoveIt, and makes the rules for pairs of bodies from it.
class MatrixRules {
 public:
  /// Replaces the matrix. No rules: there is no matrix.
  void set(std::vector<MatrixRule> matrix) noexcept;
  const std::vector<MatrixRule>& matrix() const { return matrix_; }

  /// Returns the rules of the matrix, see rulesOf(). If this throws, nothing changes.
  const DerivedRules& rules(const RobotModels& robots);

 private:
  std::vector<MatrixRule> matrix_;
  DerivedRules rules_;
  std::uint64_t robots_revision_ = 0;  // RobotModels::revision() of rules_
  bool is_new_ = false;                // whether the matrix has changed since
};

}  // namespace hgrid
