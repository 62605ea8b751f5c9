// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "hgrid_proximity/pairs/near_pair.h"

namespace hgrid {

/// Returns whether truncation removed this pair of bodies from the list. Called only for pairs that are not listed. An
/// empty function means that truncation removed no pair.
using IsCut = std::function<bool(std::uint32_t first, std::uint32_t second)>;

/// Remembers for each pair when it began. The tracker identifies bodies by their handles, so a pair is not interrupted
/// when the bodies get other indices.
class PairTracker {
 public:
  /// @param most  maximum number of remembered pairs. If there are more, the tracker forgets some of the pairs that
  ///              truncation removed: the last ones in the order (first, second).
  explicit PairTracker(std::size_t most = std::numeric_limits<std::size_t>::max()) : most_(most) {}

  /// Sets `since` of every pair. A new pair gets `stamp`. A pair that was remembered after the last accepted update()
  /// keeps its value. Truncation does not interrupt a remembered pair.
  /// @param ids    handle of each body, in the order of the body indices
  /// @param pairs  sorted by (first, second), each pair once; not more than the maximum number of remembered pairs
  void update(const std::vector<BodyId>& ids, Time stamp, std::vector<NearPair>& pairs, const IsCut& is_cut = nullptr);
  /// Accepts the last update(): the next update() compares with its pairs. Allocates no memory.
  void accept();
  /// The pairs, as handles, that were remembered before the last update() and are not remembered any more.
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
  std::vector<Known> known_;  // sorted by (first, second), which are indices into ids_

  // Results of the last update(), until it is accepted.
  bool renumbered_ = false;          // whether the ids have changed; only then the next two members are valid
  std::vector<BodyId> next_ids_;     // the new ids
  std::vector<Known> carried_over_;  // known_ with indices into next_ids_
  std::vector<Known> next_known_;
  std::vector<std::pair<BodyId, BodyId>> ended_;
};

}  // namespace hgrid
