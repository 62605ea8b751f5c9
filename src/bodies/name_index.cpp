// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bodies/name_index.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {

namespace {

std::vector<std::uint32_t> allOf(const BodyList& bodies) {
  std::vector<std::uint32_t> indices(bodies.size());
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

}  // namespace

NameIndex::NameIndex(const BodyList& bodies) : NameIndex(bodies, allOf(bodies)) {}

NameIndex::NameIndex(const BodyList& bodies, std::vector<std::uint32_t> chosen)
    : bodies_(bodies), order_(std::move(chosen)) {
  const auto before = [&](std::uint32_t a, std::uint32_t b) { return bodies_[a].name < bodies_[b].name; };
  if (!std::is_sorted(order_.begin(), order_.end(), before)) std::sort(order_.begin(), order_.end(), before);
}

NameIndex::Iterator NameIndex::from(const std::string& name) const {
  return std::lower_bound(order_.begin(), order_.end(), name,
                          [&](std::uint32_t body, const std::string& wanted) { return bodies_[body].name < wanted; });
}

std::pair<NameIndex::Iterator, NameIndex::Iterator> NameIndex::candidates(const std::string& glob) const {
  const std::string prefix = glob.substr(0, glob.find('*'));
  const Iterator begin = from(prefix);
  return {begin, std::partition_point(begin, order_.end(), [&](std::uint32_t body) {
            return bodies_[body].name.compare(0, prefix.size(), prefix) == 0;
          })};
}

std::uint32_t NameIndex::find(const std::string& name) const {
  const Iterator found = from(name);
  return found != order_.end() && bodies_[*found].name == name ? *found : kNone;
}

void NameIndex::matching(const std::string& glob, std::vector<std::uint32_t>& found) const {
  found.clear();
  const auto [begin, end] = candidates(glob);
  std::copy_if(begin, end, std::back_inserter(found),
               [&](std::uint32_t body) { return matches(glob, bodies_[body].name); });
}

bool NameIndex::matchesNone(const std::string& glob) const {
  const auto [begin, end] = candidates(glob);
  return std::none_of(begin, end, [&](std::uint32_t body) { return matches(glob, bodies_[body].name); });
}

}  // namespace hgrid
