// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"
#include "pairs/pair_tracker.h"

namespace hgrid {

/// What a tick knows when it asks for its events.
struct PairsNow {
  const std::shared_ptr<const Structure>& structure;
  const std::vector<BodyPose>& poses;
  const std::vector<Aabb>& boxes;
  const std::vector<NearPair>& pairs;  ///< sorted by (first, second), each once
  Freshness worst_state;
  double max_growth;  ///< [m] of any body
  Time stamp;
  /// [m] gap of a map and another body, infinite if more than `up_to`; asked of those pairs alone
  std::function<double(std::uint32_t first, std::uint32_t second, double up_to)> gap_to_map = nullptr;
  IsCut is_cut = nullptr;  ///< asked about pairs that are on and not in `pairs`
};

/// Says which pairs began and which ended since the tick before, each once, and why.
///
/// A pair that began is on until its gap exceeds its margin by more than the hysteresis. The broad phase does not know
/// the hysteresis: of the pairs that are on, only those that are not listed any more are measured, shape by shape.
///
/// A pair that only truncation removed stays on. So there may be more pairs that are on than pairs that are listed.
/// While the limit of them is reached, listed pairs do not begin; each begins in the first tick that has room for it.
class PairEvents {
 public:
  /// @param hysteresis  [m] >= 0
  /// @param most        pairs that are on at a time
  explicit PairEvents(double hysteresis, std::size_t most = std::numeric_limits<std::size_t>::max())
      : hysteresis_(hysteresis), most_(most) {}

  /// Replaces what stands in `list` by the events of this tick: what changed since the last accepted tick.
  void update(const PairsNow& now, PairEventList& list);
  /// Makes the tick of the last update() the one that the next update() goes by. Allocates nothing.
  void accept();
  /// Numbers start again; pairs that are still near begin again, the others are forgotten without an end.
  void beginEpoch();

 private:
  struct On {
    std::uint32_t first, second;
    Time since;
  };
  struct Known {
    double growth;
    std::uint32_t cohort;
    bool placed;
  };

  void renumber(const Structure& now, PairEventList& list);
  void judge(const On& on, const PairsNow& now, PairEventList& list);
  void begin(const NearPair& pair, EventCause cause, const PairsNow& now);
  EventCause causeOfBegin(const NearPair& pair, const Structure& now) const;
  EventCause causeOfEnd(const On& on, double margin, double gap, const Structure& now) const;
  void remember(const PairsNow& now);
  std::uint32_t numberBefore(std::uint32_t body) const { return renumbered_ ? before_[body] : body; }
  double marginBefore(std::uint32_t first, std::uint32_t second) const;

  double hysteresis_;
  std::size_t most_;
  std::uint64_t last_ = 0;
  bool epoch_began_ = false;

  // Of the tick before, which was accepted.
  std::vector<On> on_;  // sorted by (first, second)
  std::shared_ptr<const Structure> structure_ = std::make_shared<Structure>();
  std::vector<Known> known_;  // by body; empty: all were placed and none was stale

  // Of this tick, until it is accepted.
  std::uint64_t next_last_ = 0;
  std::vector<On> next_;
  std::shared_ptr<const Structure> next_structure_ = structure_;
  std::vector<Known> next_known_;

  // Scratch of a tick.
  bool renumbered_ = false;
  std::vector<On> carried_over_;       // if renumbered_: on_ in the numbers of this tick
  std::vector<std::uint32_t> before_;  // by body: its number before
  std::vector<std::uint32_t> after_;   // by body of the tick before: its number now
  std::vector<PairEvent> begun_;
};

}  // namespace hgrid
