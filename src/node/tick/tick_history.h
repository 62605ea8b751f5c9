// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <memory>

#include "hgrid_proximity/history/history.h"
#include "node/health/ledger.h"
#include "node/params/params.h"
#include "node/threads/newest_only.h"
#include "node/tick/tick.h"

namespace hgrid {

/// Keeps the ticks of the last ~history seconds within ~limits/history_bytes, so that queries can ask about them (see
/// History). A thread of its own makes the ticks compact, so that no tick waits for that.
class TickHistory {
 public:
  /// `ledger` must outlive this object.
  TickHistory(const Params& params, Ledger& ledger);
  ~TickHistory();

  /// Returns what is kept now. Any thread may call this.
  HistoryExtent extent() const { return history_.extent(); }
  /// Stores a tick that has a snapshot. If a new epoch began, first drops all ticks of the earlier one. Only the tick
  /// thread may call this.
  void see(const Tick& tick);
  /// Returns the tick that a question is about: the newest one for the stamp 0, otherwise the last one that is not
  /// later than the stamp. Any thread may call this.
  /// @param newest  the newest tick that the caller knows; it has a snapshot
  /// @throws Refusal extrapolation if there is no such tick; its sentence says for which times there is one
  std::shared_ptr<const Tick> at(const ros::Time& stamp, const std::shared_ptr<const Tick>& newest) const;

 private:
  void compact();

  const double span_;  // [s] ~history
  const int bytes_;    // [bytes] ~limits/history_bytes
  Ledger& ledger_;
  History history_;
  HistoryExtent counted_;                     // history thread only: what the counters contain
  std::unique_ptr<NewestOnly<bool>> worker_;  // null: nothing is kept. Declared last: its thread uses the other members
};

/// Returns whether a question names the time that it is about. If so, the age of the tick that answers it does not
/// matter, even if it is the newest tick.
inline bool namesItsTime(const ros::Time& stamp) { return !stamp.isZero(); }

/// Returns a clause that says how old the tick of an answer is: "at the tick of 12.5 s, 0.84 s before the newest tick".
/// Empty if it is the newest tick.
std::string agoText(const Snapshot& answered, const Snapshot& newest);

}  // namespace hgrid
