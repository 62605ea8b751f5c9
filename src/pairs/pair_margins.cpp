// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/pair_margins.h"

#include <algorithm>

#include "hgrid_proximity/bodies/name.h"

namespace hgrid {

PairMargins::PairMargins(const BodyList& bodies, const std::vector<PairMargin>& margins)
    : largest_(bodies.size()), words_((margins.size() + 63) / 64) {
  as_first_.resize(bodies.size() * words_);
  as_second_.resize(bodies.size() * words_);
  for (std::size_t k = 0; k < margins.size(); ++k) {
    margins_.push_back(margins[k].margin);
    const std::uint64_t bit = std::uint64_t{1} << (k % 64);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const bool first = matches(margins[k].first, bodies[i].name), second = matches(margins[k].second, bodies[i].name);
      if (first) as_first_[i * words_ + k / 64] |= bit;
      if (second) as_second_[i * words_ + k / 64] |= bit;
      if (first || second) largest_[i] = std::max(largest_[i], margins[k].margin);
    }
  }
}

std::optional<double> PairMargins::look(std::uint32_t first, std::uint32_t second) const {
  for (std::size_t word = words_; word-- > 0;) {
    const std::size_t i = first * words_ + word, j = second * words_ + word;
    const std::uint64_t both = (as_first_[i] & as_second_[j]) | (as_second_[i] & as_first_[j]);
    for (std::size_t bit = 64; both != 0 && bit-- > 0;) {
      if (both >> bit & 1) return margins_[64 * word + bit];
    }
  }
  return std::nullopt;
}

}  // namespace hgrid
