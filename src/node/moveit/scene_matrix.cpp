// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/moveit/scene_matrix.h"

#include <iterator>
#include <map>
#include <string>
#include <utility>

#include "hgrid_proximity/bodies/name.h"
#include "hgrid_proximity/pairs/pair_rule.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

const std::string kWhat = "the allowed collision matrix";

/// Returns the index of each name. @throws Refusal bad_id, dup_id
std::map<std::string, std::size_t> indexOf(const std::vector<std::string>& names) {
  std::map<std::string, std::size_t> index;
  for (const std::string& name : names) {
    checkLocal(name, "a name in " + kWhat);
    if (isGlob(name)) {
      throw Refusal(Code::bad_id, kWhat + " has the name '" + printable(name) +
                                      "'; names with * cannot be used, because rules read them as globs");
    }
    if (!index.emplace(name, index.size()).second) {
      throw Refusal(Code::dup_id, kWhat + " has the name '" + printable(name) + "' twice; each name needs one row");
    }
  }
  return index;
}

void checkLength(std::size_t size, std::size_t wanted, const std::string& list) {
  if (size == wanted) return;
  throw Refusal(Code::parse, list + " of " + kWhat + " has " + std::to_string(size) + " entries; it must have " +
                                 std::to_string(wanted) + ", one for each name");
}

/// Reads a matrix. Names are in alphabetical order, so that equal matrices give equal rules.
class MatrixReader {
 public:
  MatrixReader(const moveit::AllowedCollisionMatrix& matrix, std::size_t most)
      : matrix_(matrix), most_(most), index_(indexOf(matrix.entry_names)) {
    checkLength(matrix.entry_values.size(), index_.size(), "entry_values");
    for (const auto& row : matrix.entry_values) checkLength(row.enabled.size(), index_.size(), "a row");
    const auto defaults = indexOf(matrix.default_entry_names);
    checkLength(matrix.default_entry_values.size(), defaults.size(), "default_entry_values");
    for (const auto& [name, index] : defaults) defaults_[name] = matrix.default_entry_values[index] != 0;
  }

  std::vector<MatrixRule> rules() {
    for (auto first = index_.begin(); first != index_.end(); ++first) {
      for (auto second = std::next(first); second != index_.end(); ++second) addPair(*first, *second);
    }
    for (const auto& [name, may_touch] : defaults_) {
      if (!may_touch) continue;
      add({name, "", true});
      for (const auto& [other, may_touch_too] : defaults_) {  // both defaults must allow a pair
        const bool has_entry = index_.count(name) != 0 && index_.count(other) != 0;
        if (!may_touch_too && !has_entry) add({name, other, false});
      }
    }
    return std::move(rules_);
  }

 private:
  using Entry = std::pair<const std::string, std::size_t>;

  void addPair(const Entry& first, const Entry& second) {
    const auto enabled = [this](std::size_t row, std::size_t column) {
      return matrix_.entry_values[row].enabled[column] != 0;
    };
    if (enabled(first.second, second.second) && enabled(second.second, first.second)) {
      add({first.first, second.first, true});
    } else if (isAllowedByDefault(first.first) || isAllowedByDefault(second.first)) {
      add({first.first, second.first, false});
    }
  }
  bool isAllowedByDefault(const std::string& name) const {
    const auto found = defaults_.find(name);
    return found != defaults_.end() && found->second;
  }
  void add(const MatrixRule& rule) {
    if (rules_.size() >= most_) {
      throw Refusal(Code::limit, kWhat + " needs more than " + std::to_string(most_) +
                                     " rules, which is ~limits/max_rules; raise it, or allow fewer pairs to touch");
    }
    rules_.push_back(rule);
  }

  const moveit::AllowedCollisionMatrix& matrix_;
  const std::size_t most_;
  const std::map<std::string, std::size_t> index_;
  std::map<std::string, bool> defaults_;
  std::vector<MatrixRule> rules_;
};

}  // namespace

std::vector<MatrixRule> matrixRulesOf(const moveit::AllowedCollisionMatrix& matrix, std::size_t most) {
  return MatrixReader(matrix, most).rules();
}

moveit::AllowedCollisionMatrix matrixMessage(const std::vector<MatrixRule>& rules) {
  moveit::AllowedCollisionMatrix matrix;
  std::map<std::string, std::size_t> index;
  for (const MatrixRule& rule : rules) {
    if (rule.second.empty()) continue;
    index.emplace(rule.first, 0);
    index.emplace(rule.second, 0);
  }
  for (auto& [name, number] : index) {
    number = matrix.entry_names.size();
    matrix.entry_names.push_back(name);
  }
  matrix.entry_values.resize(index.size());
  for (auto& row : matrix.entry_values) row.enabled.resize(index.size());
  for (const MatrixRule& rule : rules) {
    if (rule.second.empty()) {
      matrix.default_entry_names.push_back(rule.first);
      matrix.default_entry_values.push_back(1);
    } else if (rule.allowed) {
      const std::size_t first = index.at(rule.first), second = index.at(rule.second);
      matrix.entry_values[first].enabled[second] = matrix.entry_values[second].enabled[first] = 1;
    }
  }
  return matrix;
}

}  // namespace hgrid
