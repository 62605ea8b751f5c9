// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <vector>

#include "bench/measure/record.h"
#include "bench/options.h"
#include "bench/peers/peer.h"
#include "bench/queries/query_peer.h"

namespace hgrid {
namespace bench {

// Each function runs one part of the benchmark, prints the results, and appends them to `records`.

/// Measures how long it takes to find all overlapping pairs, for each workload, number of boxes and moving fraction.
void runPairs(const Options& options, std::vector<Record>& records);
/// The same for the recorded worlds of the folder `options.worlds`.
void runReal(const Options& options, std::vector<Record>& records);
/// As runPairs(), with HGrid and these peers only.
void runPairsOf(const std::vector<PeerKind>& kinds, const Options& options, std::vector<Record>& records);

/// Measures how long each peer takes to load all boxes and to find the pairs for the first time, for each workload and
/// number of boxes.
void runLoadings(const Options& options, std::vector<Record>& records);

/// Measures whether HGrid and FCL's tree get slower after many frames.
void runAgeing(const Options& options, std::vector<Record>& records);

/// Compares HGrid with two threads and with one thread. Also measures how much the machine gains from a second
/// processor.
void runThreads(const Options& options, std::vector<Record>& records);

/// Measures queries of each kind. The boxes do not move.
void runQueries(const Options& options, std::vector<Record>& records);
/// As above, with these peers only, and with this number of boxes.
void runQueriesOf(const std::vector<QueryPeerKind>& kinds, std::size_t n, const Options& options,
                  std::vector<Record>& records);

/// Measures changes of one box at a time, with and without a question about it after each.
void runSingle(const Options& options, std::vector<Record>& records);

/// Compares the partitions of the book (doc/partitions.md) with HGrid: pairs, queries, loading and memory. It does not
/// use the libraries of other projects.
void runBook(const Options& options, std::vector<Record>& records);

/// Measures how exact distances, touches and depths of convex shapes are, beside those of other libraries.
void runExactness(const Options& options, std::vector<Record>& records);

/// Compares maps of hgrid, OctoMap and FCL: loading, memory, and questions about the leaves. Also measures point
/// clouds.
void runMaps(const Options& options, std::vector<Record>& records);

/// Measures distances of two meshes beside FCL, and winding numbers.
void runMeshes(const Options& options, std::vector<Record>& records);

/// Measures how fast states of robots are checked for contacts, beside FCL in the way of MoveIt.
void runStates(const Options& options, std::vector<Record>& records);

/// Measures the memory of a history of past ticks, what it adds to a tick, and queries about the past.
void runHistory(const Options& options, std::vector<Record>& records);

}  // namespace bench
}  // namespace hgrid
