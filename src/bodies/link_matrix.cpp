// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/bodies/link_matrix.h"

#include <algorithm>
#include <map>
#include <utility>

#include "bodies/group_tree.h"
#include "hgrid_proximity/bodies/robot_model.h"
#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestReason = 512;  // [bytes] longer reasons of an SRDF are cut

constexpr std::size_t kMostNamed = 8;  // largest number of joints in a reason

/// Finds the links with geometry that are nearest to a link, over fixed joints.
class NearestShapes {
 public:
  explicit NearestShapes(const RobotModel& model) : model_(model), fixed_to_(model.links.size()) {
    for (std::uint32_t i = 0; i < model.links.size(); ++i) {
      const RobotLink& link = model.links[i];
      if (link.parent < 0 || link.joint_kind != JointKind::fixed) continue;
      fixed_to_[i].push_back(static_cast<std::uint32_t>(link.parent));
      fixed_to_[static_cast<std::size_t>(link.parent)].push_back(i);
    }
  }
  /// Returns the link itself if it has geometry. If not, returns all links with geometry that fixed joints connect to
  /// it, through links without geometry only.
  std::vector<std::uint32_t> from(std::uint32_t link) const {
    std::vector<std::uint32_t> found;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open = {{link, link}};  // a link, and the one before it
    while (!open.empty()) {
      const auto [at, before] = open.back();
      open.pop_back();
      if (model_.links[at].hasGeometry()) {
        found.push_back(at);
        continue;
      }
      for (const std::uint32_t next : fixed_to_[at]) {
        if (next != before) open.emplace_back(next, at);
      }
    }
    return found;
  }

 private:
  const RobotModel& model_;
  std::vector<std::vector<std::uint32_t>> fixed_to_;  // for each link: the links that a fixed joint connects to it
};

}  // namespace

struct LinkMatrix::State {
  State(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings)
      : model_name(model.name),
        size(model.links.size()),
        words((size + 63) / 64),
        groups(model),
        origins(size * size, Origin::none),
        allowed(size * words) {
    setGroups(model);
    applyRules(model, rules, warnings);
    for (std::uint32_t i = 0; i < size; ++i) set(i, i, Origin::self);  // last, so that no rule can change these entries
  }
  void setGroups(const RobotModel& model);
  void applyRules(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings);
  void set(std::uint32_t first, std::uint32_t second, Origin origin);

  std::string model_name;
  std::size_t size, words;  // number of links; 64-bit words per bit set of links
  GroupTree groups;
  std::vector<std::uint32_t> group_of;  // rigid group of each link
  std::vector<Origin> origins;
  std::vector<std::uint64_t> allowed;  // one bit set of links for each link; a bit is 1 if the origin is not none
  std::map<std::pair<std::uint32_t, std::uint32_t>, Tag> tags;  // by two links, the smaller first; few pairs have a tag
};

LinkMatrix::LinkMatrix(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings)
    : state_(std::make_shared<const State>(model, rules, warnings)) {}

const std::uint64_t* LinkMatrix::allowedWith(std::uint32_t link) const {
  return state_->allowed.data() + link * state_->words;
}

Origin LinkMatrix::origin(std::uint32_t first, std::uint32_t second) const {
  return state_->origins[first * state_->size + second];
}

std::size_t LinkMatrix::size() const { return state_->size; }

const std::string& LinkMatrix::modelName() const { return state_->model_name; }

void LinkMatrix::State::setGroups(const RobotModel& model) {
  std::vector<std::vector<std::uint32_t>> members(groups.size());
  for (std::uint32_t i = 0; i < size; ++i) {
    group_of.push_back(model.links[i].rigid_group);
    members[group_of[i]].push_back(i);
  }
  const auto setAll = [&](const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& second,
                          Origin origin) {
    for (const std::uint32_t i : first) {
      for (const std::uint32_t j : second) set(i, j, origin);
    }
  };
  const NearestShapes nearest(model);
  for (std::uint32_t group = 0; group < groups.size(); ++group) {
    setAll(members[group], members[group], Origin::rigid);
    std::uint32_t below = model.group_roots[group];  // the child of the uppermost of the joints
    const std::vector<std::uint32_t> children = nearest.from(below);
    for (const std::uint32_t above : groups.adjacentAbove(group)) {
      setAll(children, nearest.from(static_cast<std::uint32_t>(model.links[below].parent)), Origin::adjacent);
      below = model.group_roots[above];
    }
  }
}

void LinkMatrix::State::applyRules(const RobotModel& model, const LinkRules& rules,
                                   std::vector<std::string>& warnings) {
  const auto indexOf = [&](const std::string& link, const char* tag) {
    const int index = model.find(link);
    if (index < 0) {
      warnings.push_back(std::string(tag) + " names link '" + printable(link) + "', which robot '" +
                         printable(model.name) + "' does not have; the rule is ignored");
    }
    return index;
  };
  const auto setPair = [&](const LinkRules::Pair& pair, const char* tag, Origin origin) {
    const int first = indexOf(pair.first, tag), second = indexOf(pair.second, tag);
    if (first < 0 || second < 0) return;
    const auto a = static_cast<std::uint32_t>(first), b = static_cast<std::uint32_t>(second);
    set(a, b, origin);
    if (a != b) tags[std::minmax(a, b)] = {origin == Origin::srdf, printable(pair.reason, kLongestReason)};
  };
  for (const std::string& link : rules.disabled_default) {
    const int index = indexOf(link, "disable_default_collisions");
    for (std::uint32_t j = 0; index >= 0 && j < size; ++j) set(static_cast<std::uint32_t>(index), j, Origin::srdf);
  }
  for (const LinkRules::Pair& pair : rules.enabled) setPair(pair, "enable_collisions", Origin::none);
  for (const LinkRules::Pair& pair : rules.disabled) setPair(pair, "disable_collisions", Origin::srdf);
}

const LinkMatrix::Tag* LinkMatrix::tag(std::uint32_t first, std::uint32_t second) const {
  const auto found = state_->tags.find(std::minmax(first, second));
  return found == state_->tags.end() ? nullptr : &found->second;
}

std::string LinkMatrix::adjacencyReason(std::uint32_t first, std::uint32_t second) const {
  const std::vector<std::string> joints =
      state_->groups.jointsBetween(state_->group_of[first], state_->group_of[second]);
  if (joints.size() == 1) return "joint '" + printable(joints.front()) + "' connects them";
  std::string names;
  for (std::size_t i = 0; i < std::min(joints.size(), kMostNamed); ++i) {
    names += (names.empty() ? "'" : ", '") + printable(joints[i]) + "'";
  }
  if (joints.size() > kMostNamed) names += ", ...";
  return "the " + std::to_string(joints.size()) + " joints " + names +
         " connect them in one place, without geometry between them";
}

void LinkMatrix::State::set(std::uint32_t first, std::uint32_t second, Origin origin) {
  for (const auto& [a, b] : {std::pair(first, second), std::pair(second, first)}) {
    origins[a * size + b] = origin;
    std::uint64_t& word = allowed[a * words + b / 64];
    const std::uint64_t bit = std::uint64_t{1} << (b % 64);
    word = origin != Origin::none ? word | bit : word & ~bit;
  }
}

}  // namespace hgrid
