// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <vector>

#include "hgrid_proximity/pairs/near_pair.h"

namespace hgrid {

/// Makes the list of a snapshot's pairs from the pairs that a tick collected. Keeps its memory from tick to tick.
class PairChoice {
 public:
  /// The collected pairs, in any order; of several for two bodies the one with the least gap counts.
  std::vector<NearPair>& collected() { return collected_; }

  /// Replaces `listed` by at most `most` pairs, each once and sorted by (first, second). If there are more pairs, it
  /// lists those with the smallest gaps (contacts have gap 0), and of equal gaps the first by (first, second).
  /// @param bodies  number of bodies
  /// @returns the number of pairs of bodies that were collected
  std::size_t list(std::size_t bodies, std::size_t most, std::vector<NearPair>& listed);

 private:
  void sort(std::size_t bodies, std::vector<NearPair>& sorted);
  void keepNearest(std::size_t most, std::vector<NearPair>& listed);

  std::vector<NearPair> collected_, sorted_;
  std::vector<std::uint32_t> next_of_first_, order_;
};

}  // namespace hgrid
