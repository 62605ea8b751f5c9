// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "hgrid_proximity/pairs/near_pair.h"

namespace hgrid {

/// Whether two bodies are a candidate pair that truncation removed. Asked only about pairs that are not listed. Empty:
/// truncation removed none.
using IsCut = std::function<bool(std::uint32_t first, std::uint32_t second)>;

/// Remembers since when each pair is near. It knows bodies by their handles, so a new numbering of the bodies does not
/// interrupt a pair.
class PairTracker {
 public:
  /// @param most  pairs that are remembered; of more, those that truncation removed are forgotten, the last first
  explicit PairTracker(std::size_t most = std::numeric_limits<std::size_t>::max()) : most_(most) {}

  /// Fills `since` of every pair: `stamp`, or an older one if the pair was not interrupted since the last accepted
  /// call. Truncation does not interrupt a pair that is remembered.
  /// @param ids    handle per body index
  /// @param pairs  sorted by (first, second), each once; no more than are remembered
  void update(const std::vector<BodyId>& ids, Time stamp, std::vector<NearPair>& pairs, const IsCut& is_cut = nullptr);
  /// Makes the last update() the one that the next update() goes by. Allocates nothing.
  void accept();
  /// Pairs that were remembered before the last update() and are no more, by handle.
  const std::vector<std::pair<BodyId, BodyId>>& ended() const { return ended_; }
  void clear();

 private:
  struct Known {
    std::uint32_t first, second;
    Time since;
  };
  void renumber(const std::vector<BodyId>& ids);

  std::size_t most_;
  std::vector<BodyId> ids_;
  std::vector<Known> known_;  // sorted by (first, second), which index ids_

  // Of the last update(), until it is accepted.
  bool renumbered_ = false;
  std::vector<BodyId> next_ids_;     // if renumbered_
  std::vector<Known> carried_over_;  // if renumbered_: known_ in the numbers of next_ids_
  std::vector<Known> next_known_;
  std::vector<std::pair<BodyId, BodyId>> ended_;
};

}  // namespace hgrid
