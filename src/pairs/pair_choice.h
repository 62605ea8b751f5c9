// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/pairs/near_pair.h"

namespace hgrid {

/// Selects the pairs that a snapshot lists from the pairs that a tick collected. Reuses its memory in the next tick.
class PairChoice {
 public:
  /// The collected pairs, in any order. If several of them have the same two bodies, the smallest gap counts.
  std::vector<NearPair>& collected() { return collected_; }

  /// Replaces `listed` by at most `most` pairs, sorted by (first, second). Each pair of bodies is there once. If more
  /// pairs were collected, lists the pairs with the smallest gaps. Among equal gaps, the order (first, second) decides.
  /// @param bodies  number of bodies
  /// @returns the number of different pairs of bodies that were collected
  std::size_t list(std::size_t bodies, std::size_t most, std::vector<NearPair>& listed);

 private:
  void sort(std::size_t bodies, std::vector<NearPair>& sorted);
  void keepNearest(std::size_t most, std::vector<NearPair>& listed);

  std::vector<NearPair> collected_, sorted_;
  std::vector<std::uint32_t> next_of_first_, order_;
};

}  // namespace hgrid
