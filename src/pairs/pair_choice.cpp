// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "pairs/pair_choice.h"

#include <algorithm>
#include <numeric>

namespace hgrid {
namespace {

/// Orders pairs with the same first body.
bool isBefore(const NearPair& a, const NearPair& b) {
  return a.second != b.second ? a.second < b.second : a.gap < b.gap;
}

}  // namespace

/// Sorts the collected pairs by (first, second, gap). If they are few, sorts them directly. Otherwise first a counting
/// sort by `first`, then a sort of the few pairs that have the same `first`.
void PairChoice::sort(std::size_t bodies, std::vector<NearPair>& sorted) {
  if (collected_.size() < bodies / 32) {  // a counting sort visits all bodies
    sorted = collected_;
    std::sort(sorted.begin(), sorted.end(), [](const NearPair& a, const NearPair& b) {
      return a.first != b.first ? a.first < b.first : isBefore(a, b);
    });
    return;
  }
  next_of_first_.assign(bodies + 1, 0);
  for (const NearPair& pair : collected_) ++next_of_first_[pair.first + 1];
  for (std::size_t i = 1; i < next_of_first_.size(); ++i) next_of_first_[i] += next_of_first_[i - 1];
  sorted.resize(collected_.size());
  for (const NearPair& pair : collected_) sorted[next_of_first_[pair.first]++] = pair;
  std::size_t begin = 0;
  for (std::size_t body = 0; body < bodies; ++body) {
    const std::size_t end = next_of_first_[body];
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin), sorted.begin() + static_cast<std::ptrdiff_t>(end),
              isBefore);
    begin = end;
  }
}

void PairChoice::keepNearest(std::size_t most, std::vector<NearPair>& listed) {
  order_.resize(sorted_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  const auto end = order_.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(order_.begin(), end, order_.end(), [this](std::uint32_t a, std::uint32_t b) {
    return sorted_[a].gap != sorted_[b].gap ? sorted_[a].gap < sorted_[b].gap : a < b;
  });
  std::sort(order_.begin(), end);
  listed.clear();
  for (std::size_t i = 0; i < most; ++i) listed.push_back(sorted_[order_[i]]);
}

std::size_t PairChoice::list(std::size_t bodies, std::size_t most, std::vector<NearPair>& listed) {
  const bool may_be_cut = collected_.size() > most;
  std::vector<NearPair>& sorted = may_be_cut ? sorted_ : listed;
  sort(bodies, sorted);
  sorted.erase(
      std::unique(sorted.begin(), sorted.end(),
                  [](const NearPair& a, const NearPair& b) { return a.first == b.first && a.second == b.second; }),
      sorted.end());
  const std::size_t found = sorted.size();
  if (!may_be_cut) return found;
  if (found > most) {
    keepNearest(most, listed);
  } else {
    listed.assign(sorted.begin(), sorted.end());
  }
  return found;
}

}  // namespace hgrid
