// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bench/peers/peer.h"
#include "bench/queries/query_peer.h"
#include "hgrid_proximity/partitions/broad_phase_type.h"

namespace hgrid {
namespace bench {

/// Returns the partitions of the book, without HGrid, as peers that find pairs. The names are those of name().
std::vector<PeerKind> bookPeers();
/// Returns the partitions of the book and HGrid as peers that answer single queries.
std::vector<QueryPeerKind> bookQueryPeers();

/// The time and the memory of loading.
struct Loading {
  double ms = 0.0;     ///< [ms] to store all boxes with one call and to be ready for queries
  double bytes = 0.0;  ///< [byte] per box
};
/// Measures the loading of a partition of the book or of HGrid. The time is the median of some runs.
Loading loadingOf(BroadPhaseType type, const std::vector<Aabb>& boxes);

}  // namespace bench
}  // namespace hgrid
