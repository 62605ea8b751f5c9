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

/// The data of a tick from which its events are computed.
struct PairsNow {
  const std::shared_ptr<const Structure>& structure;
  const std::vector<BodyPose>& poses;
  const std::vector<Aabb>& boxes;
  const std::vector<NearPair>& pairs;  ///< the listed pairs, sorted by (first, second), each once
  Freshness worst_state;
  double max_growth;  ///< [m] largest growth of any body
  Time stamp;
  /// Returns the gap [m] of two bodies; infinite if it exceeds `up_to`. Called only for pairs with a map or a plane.
  std::function<double(std::uint32_t first, std::uint32_t second, double up_to)> special_gap = nullptr;
  IsCut is_cut = nullptr;            ///< called for pairs that are on (see PairEvents) but not in `pairs`
  const BodyRooms* rooms = nullptr;  ///< Snapshot::rooms(); bodies without a common room make no pair
};

/// Finds the pairs that began or ended since the previous tick, and the cause of each event.
///
/// A pair is "on" from its BEGIN event to its END event. It ends when its gap exceeds its margin by more than the
/// hysteresis, or when its bodies have no room in common. The broad phase does not know the hysteresis, so the list of
/// near pairs may lack a pair that has not ended yet. This class computes the gap of such a pair itself.
///
/// If only truncation removed a pair from the list, the pair stays on. So more pairs may be on than are listed. While
/// the maximum number of pairs is on, listed pairs do not begin. They begin in the first tick that has room for them.
class PairEvents {
 public:
  /// @param hysteresis  [m] how far the gap must exceed the margin before a pair ends, >= 0
  /// @param most        maximum number of pairs that are on at a time
  explicit PairEvents(double hysteresis, std::size_t most = std::numeric_limits<std::size_t>::max())
      : hysteresis_(hysteresis), hysteresis_before_(hysteresis), most_(most) {}

  /// Sets the hysteresis of the next update().
  void setHysteresis(double hysteresis) { hysteresis_ = hysteresis; }
  /// Replaces `list` by the events of this tick, that is, by the changes since the last accepted tick.
  void update(const PairsNow& now, PairEventList& list);
  /// Accepts the tick of the last update(): the next update() compares with it. Allocates no memory.
  void accept();
  /// Begins a new epoch: events are numbered from 1 again. Pairs that are still listed begin again. The other pairs
  /// are forgotten without an END event.
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

  double hysteresis_, hysteresis_before_;  // [m] of the next update(), and of the last accepted one
  std::size_t most_;
  std::uint64_t last_ = 0;
  bool epoch_began_ = false;

  // Data of the last accepted tick.
  std::vector<On> on_;  // the pairs that are on, sorted by (first, second)
  std::shared_ptr<const Structure> structure_ = std::make_shared<Structure>();
  std::vector<Known> known_;  // indexed by body; empty if all bodies were placed and none was stale

  // Data of this tick, until it is accepted.
  std::uint64_t next_last_ = 0;
  std::vector<On> next_;
  std::shared_ptr<const Structure> next_structure_ = structure_;
  std::vector<Known> next_known_;

  // Buffers that are used within one update().
  bool renumbered_ = false;            // whether the structure has changed; only then the next three are valid
  std::vector<On> carried_over_;       // on_ with the body indices of this tick
  std::vector<std::uint32_t> before_;  // for each present body: its previous index
  std::vector<std::uint32_t> after_;   // for each previous body: its present index
  std::vector<PairEvent> begun_;       // the BEGIN events of this tick
};

}  // namespace hgrid
