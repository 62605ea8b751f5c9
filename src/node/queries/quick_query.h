// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <chrono>
#include <cstddef>

#include "node/queries/query_request.h"

namespace hgrid {

// Bounds of a query that the receiving thread may answer (see QuickCallbacks). With them, an answer takes about 0.1 ms
// at most.

inline constexpr std::chrono::microseconds kQuickSearch{50};  ///< a quick query that searches longer is no longer quick
inline constexpr std::size_t kQuickHits = 64;                 ///< largest number of hits in a quick answer
inline constexpr std::size_t kQuickBoxes = 5000;              ///< number of boxes; to look at all takes about 50 us
inline constexpr std::size_t kQuickRules = 2000;              ///< number of rules, which an answer looks through
inline constexpr std::size_t kQuickGaps = 16;                 ///< number of source gaps, which a query looks through

/// Whether a query about the present may be quick. Looks only at sizes, which takes less than a microsecond.
/// @param tick  must have a snapshot
bool mayBeQuick(const QueryOptions& options, const Tick& tick);

}  // namespace hgrid
