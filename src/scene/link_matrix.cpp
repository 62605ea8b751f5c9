// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/scene/link_matrix.h"

#include <algorithm>

#include "hgrid_proximity/refusal.h"
#include "hgrid_proximity/scene/robot_model.h"

namespace hgrid {
namespace {

constexpr std::size_t kLongestReason = 512;  // bytes of an SRDF's reason that are kept

/// Links with geometry that a joint joins to `start`, perhaps through links that have none.
std::vector<std::uint32_t> joinedTo(const RobotModel& model, const std::vector<std::vector<std::uint32_t>>& neighbours,
                                    std::uint32_t start) {
  std::vector<std::uint32_t> found, open = {start};
  std::vector<bool> seen(model.links.size());
  seen[start] = true;
  while (!open.empty()) {
    const std::uint32_t link = open.back();
    open.pop_back();
    for (const std::uint32_t next : neighbours[link]) {
      if (seen[next]) continue;
      seen[next] = true;
      (model.links[next].has_collision ? found : open).push_back(next);
    }
  }
  return found;
}

}  // namespace

LinkMatrix::LinkMatrix(const RobotModel& model, const LinkRules& rules, std::vector<std::string>& warnings)
    : size_(model.links.size()),
      words_((size_ + 63) / 64),
      origins_(size_ * size_, Origin::none),
      allowed_(size_ * words_) {
  std::vector<std::vector<std::uint32_t>> neighbours(size_);
  for (std::uint32_t i = 0; i < size_; ++i) {
    if (model.links[i].parent < 0) continue;
    const auto parent = static_cast<std::uint32_t>(model.links[i].parent);
    neighbours[i].push_back(parent);
    neighbours[parent].push_back(i);
  }
  for (std::uint32_t i = 0; i < size_; ++i) {
    for (const std::uint32_t other : joinedTo(model, neighbours, i)) set(i, other, Origin::adjacent);
  }
  for (std::uint32_t i = 0; i < size_; ++i) {
    for (std::uint32_t j = 0; j < i; ++j) {
      if (model.links[i].rigid_group == model.links[j].rigid_group) set(i, j, Origin::rigid);
    }
  }

  const auto indexOf = [&](const std::string& link, const char* tag) {
    const int index = model.find(link);
    if (index < 0) {
      warnings.push_back(std::string(tag) + " names link '" + printable(link) + "', which robot '" +
                         printable(model.name) + "' does not have");
    }
    return index;
  };
  const auto setPair = [&](const LinkRules::Pair& pair, const char* tag, Origin origin) {
    const int first = indexOf(pair.first, tag), second = indexOf(pair.second, tag);
    if (first < 0 || second < 0) return;
    const auto a = static_cast<std::uint32_t>(first), b = static_cast<std::uint32_t>(second);
    set(a, b, origin);
    if (a != b) tags_[std::minmax(a, b)] = {origin == Origin::srdf, printable(pair.reason, kLongestReason)};
  };
  for (const std::string& link : rules.disabled_default) {
    const int index = indexOf(link, "disable_default_collisions");
    for (std::uint32_t j = 0; index >= 0 && j < size_; ++j) set(static_cast<std::uint32_t>(index), j, Origin::srdf);
  }
  for (const LinkRules::Pair& pair : rules.enabled) setPair(pair, "enable_collisions", Origin::none);
  for (const LinkRules::Pair& pair : rules.disabled) setPair(pair, "disable_collisions", Origin::srdf);
  for (std::uint32_t i = 0; i < size_; ++i) set(i, i, Origin::self);  // last: no rule makes a link meet itself
}

const LinkMatrix::Tag* LinkMatrix::tag(std::uint32_t first, std::uint32_t second) const {
  const auto found = tags_.find(std::minmax(first, second));
  return found == tags_.end() ? nullptr : &found->second;
}

void LinkMatrix::set(std::uint32_t first, std::uint32_t second, Origin origin) {
  for (const auto& [a, b] : {std::pair(first, second), std::pair(second, first)}) {
    origins_[a * size_ + b] = origin;
    std::uint64_t& word = allowed_[a * words_ + b / 64];
    const std::uint64_t bit = std::uint64_t{1} << (b % 64);
    word = origin != Origin::none ? word | bit : word & ~bit;
  }
}

}  // namespace hgrid
