// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <memory>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// How much a History keeps.
struct HistoryLimits {
  Time span = std::chrono::seconds(2);  ///< how far before the newest tick the kept ticks reach, >= 0
  /// Largest memory [bytes] of the kept ticks. If they need more, the history becomes shorter.
  std::size_t bytes = 64u << 20;
};

/// A tick that a History has kept.
struct PastTick {
  /// Whether the History has the tick, and why it does not.
  enum class Outcome : std::uint8_t {
    found,    ///< `snapshot` is the last tick that is not later than the requested time
    too_old,  ///< the requested time is before the oldest kept tick
    skipped,  ///< the tick of the requested time was not kept, because compact() was too slow
  };
  Outcome outcome = Outcome::too_old;        ///< the other members are null unless this is `found`
  std::shared_ptr<const Snapshot> snapshot;  ///< the state of the world at this tick; it has no events
  std::shared_ptr<const void> note;          ///< the note that add() received with the snapshot
};

/// What a History keeps at the moment.
struct HistoryExtent {
  std::size_t ticks = 0;      ///< number of kept ticks, including the newest one
  std::size_t bytes = 0;      ///< [bytes] memory of the kept ticks and of the past snapshots that were made again
  std::uint64_t epoch = 0;    ///< epoch of the kept ticks
  Time begin{0};              ///< stamp of the oldest kept tick; 0 if there is none
  Time end{0};                ///< stamp of the newest kept tick; 0 if there is none
  std::uint64_t dropped = 0;  ///< number of ticks that HistoryLimits::bytes has dropped so far
  std::uint64_t skipped = 0;  ///< number of ticks that were not kept so far, because compact() was too slow
};

/// Keeps the ticks of the last seconds, so that queries about the recent past can be answered.
///
/// A kept tick is compact: it stores the poses and the pairs, and shares with the tick before it what did not change.
/// It stores neither boxes nor a broad phase. find() makes them again when a query asks for the tick. The answers are
/// then the same as those of the original snapshot. The snapshots that were made last are kept for the next queries.
/// Of several ticks with the same stamp, only the last one is kept.
///
/// The bytes of a tick count what only the history keeps alive. Bodies, rules and the cells of maps count once, and
/// only if the newest tick no longer uses them.
///
/// Threads: one thread calls add() and clear(), another thread calls compact(), and any threads call find() and
/// extent(). A call of add() takes about a microsecond, whatever the number of bodies. No thread waits for compact() or
/// for find(), except that queries for the same tick wait for the first of them.
class History {
 public:
  /// Creates an empty history.
  explicit History(const HistoryLimits& limits);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  /// Appends the newest tick. If its epoch is another one, drops all earlier ticks. Call compact() afterwards on
  /// another thread: until then the history keeps the snapshot itself. If too many ticks wait for compact(), this tick
  /// is skipped, and queries about its time are refused.
  /// @param snapshot    not null; its stamp and its sequence must not be less than those of the tick before
  /// @param note        returned by find() together with the snapshot; may be null
  /// @param note_bytes  memory [bytes] of the note
  void add(std::shared_ptr<const Snapshot> snapshot, std::shared_ptr<const void> note = nullptr,
           std::size_t note_bytes = 0);
  /// Drops all ticks.
  void clear();

  /// Makes the added ticks compact, and drops the ticks that are beyond the limits. If it throws, all ticks have been
  /// dropped.
  void compact();

  /// Returns the last tick that is not later than `stamp`.
  /// @param newest  the newest tick that the caller knows; `stamp` must be before its stamp
  PastTick find(Time stamp, const Snapshot& newest) const;
  /// Returns what is kept.
  HistoryExtent extent() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace hgrid
