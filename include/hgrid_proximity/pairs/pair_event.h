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

/// The numbers are part of the interface: do not change them.
enum class EventKind : std::uint8_t { begin = 0, end = 1 };

/// Why a pair began or ended. The numbers are part of the interface: do not change them.
enum class EventCause : std::uint8_t {
  moved = 0,      ///< the bodies came near or moved apart
  bodies = 1,     ///< a body is new, has its first pose, was replaced or is gone
  filter = 2,     ///< the filter or a margin that was told changed
  staleness = 3,  ///< a margin widened or narrowed, since a body's data got older or came back
  epoch = 4,      ///< the pair was there when a new epoch began
};

/// A pair began: its gap came within its margin. Or it ended: its gap left the margin by more than
/// SceneOptions::event_hysteresis.
struct PairEvent {
  std::uint64_t number = 0;  ///< from 1 in each epoch, one more with every event
  EventKind kind = EventKind::begin;
  EventCause cause = EventCause::moved;
  std::uint32_t first = 0;  ///< index into Snapshot::structureOf(event).bodies, first < second
  std::uint32_t second = 0;
  Time since{0};                                          ///< stamp of the tick in which it began
  double gap = std::numeric_limits<double>::quiet_NaN();  ///< [m] least distance of their boxes; NaN if one is gone
};

/// The events of one tick.
struct PairEventList {
  std::vector<PairEvent> events;            ///< by number: the ends, then the begins
  std::uint64_t last = 0;                   ///< number of the newest event of the epoch; 0: there was none
  std::shared_ptr<const Structure> before;  ///< of the tick before, if a body of an end is gone; else null
};

}  // namespace hgrid
