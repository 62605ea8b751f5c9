// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

struct Structure;

/// Whether a pair began or ended. The numbers are part of the interface: do not change them.
enum class EventKind : std::uint8_t { begin = 0, end = 1 };

/// Why a pair began or ended. The numbers are part of the interface: do not change them.
enum class EventCause : std::uint8_t {
  moved = 0,      ///< the bodies moved toward each other or apart
  bodies = 1,     ///< a body is new, got its first pose, was replaced or was removed
  filter = 2,     ///< the pair filter, a configured margin or the hysteresis changed
  staleness = 3,  ///< the margin changed because the data of a body became older or was updated again
  epoch = 4,      ///< the pair existed already when a new epoch began
};

/// An event: a pair begins or ends. A pair begins in the first tick that selects it (see NearPair). It ends when it is
/// not selected any more and its gap exceeds its margin by more than SceneOptions::event_hysteresis. It also ends when
/// a rule switches it off or when one of its bodies is removed.
struct PairEvent {
  std::uint64_t number = 0;  ///< number of the event: 1 for the first event of an epoch, then one more each time
  EventKind kind = EventKind::begin;     ///< whether the pair began or ended
  EventCause cause = EventCause::moved;  ///< why it began or ended
  std::uint32_t first = 0;               ///< index into Snapshot::structureOf(event).bodies, first < second
  std::uint32_t second = 0;              ///< index into the same list
  Time since{0};                         ///< stamp of the tick in which the pair began
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< [m] gap of the pair; NaN if a body was removed
};

/// The events of one tick.
struct PairEventList {
  std::vector<PairEvent> events;            ///< sorted by number: first the END events, then the BEGIN events
  std::uint64_t last = 0;                   ///< number of the newest event of the epoch; 0: there was none
  std::shared_ptr<const Structure> before;  ///< previous structure if a removed body ended a pair; otherwise null
};

}  // namespace hgrid
