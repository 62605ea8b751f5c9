// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/matrix_rules.h"

#include <optional>
#include <utility>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {
namespace {

constexpr const char* kOctomap = "<octomap>";  // MoveIt's name of the octomap of a planning scene
constexpr const char* kOctomapBody = "map/planning_scene";

/// Returns the name of the body; nullopt if several robots have a link of this name.
std::optional<std::string> bodyOf(const std::string& name, const RobotEntries& robots) {
  if (findLink(robots, name) != nullptr) return name;
  std::vector<std::string> links = linksNamed(robots, name);
  if (links.size() > 1) return std::nullopt;
  if (links.size() == 1) return std::move(links.front());
  return name == kOctomap ? kOctomapBody : joined("obstacle", name);
}

}  // namespace

std::vector<PairRule> rulesOf(const std::vector<MatrixRule>& matrix, const RobotEntries& robots) {
  std::vector<PairRule> rules;
  for (const MatrixRule& one : matrix) {
    const std::optional<std::string> first = bodyOf(one.first, robots);
    const std::optional<std::string> second = one.second.empty() ? "*" : bodyOf(one.second, robots);
    if (!first || !second) continue;
    PairRule rule{*first, *second, "MoveIt's allowed collision matrix", one.allowed};
    rule.origin = Origin::moveit;
    rules.push_back(std::move(rule));
  }
  return rules;
}

void MatrixRules::set(std::vector<MatrixRule> matrix) noexcept {
  is_new_ = is_new_ || !(matrix == matrix_);
  matrix_.swap(matrix);
}

const DerivedRules& MatrixRules::rules(const RobotModels& robots) {
  if (!is_new_ && (matrix_.empty() || robots_revision_ == robots.revision())) return rules_;
  std::vector<PairRule> rules = rulesOf(matrix_, robots.all());
  // The code below does not throw.
  rules_.rules.swap(rules);
  ++rules_.revision;
  robots_revision_ = robots.revision();
  is_new_ = false;
  return rules_;
}

}  // namespace hgrid
