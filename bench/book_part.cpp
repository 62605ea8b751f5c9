// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cstdio>

#include "bench/parts.h"
#include "bench/peers/book_peers.h"
#include "bench/workload/workloads.h"

namespace hgrid {
namespace bench {
namespace {

void runLoading(const Options& options, const std::vector<std::size_t>& sizes, std::vector<Record>& records) {
  for (const std::string& workload : options.boxWorkloads(evenWorkloads())) {
    for (const std::size_t n : sizes) {
      const World world(workload, n, 1.0);
      std::printf("\n%s, n = %zu, loading\n", workload.c_str(), n);
      for (const QueryPeerKind& kind : bookQueryPeers()) {
        if (!options.peer(kind.name)) continue;
        const Loading loading = loadingOf(kind.name, world.boxes());
        std::printf("  %-28s %10.3f ms  %6.0f bytes per box\n", kind.name.c_str(), loading.ms, loading.bytes);
        records.push_back(Record("load")
                              .text("peer", kind.name)
                              .text("workload", workload)
                              .number("n", double(n))
                              .number("median_ms", loading.ms)
                              .number("bytes_per_object", loading.bytes));
      }
      std::fflush(stdout);
    }
  }
}

}  // namespace

void runBook(const Options& options, std::vector<Record>& records) {
  Options chosen = options;
  if (chosen.sizes.empty()) chosen.sizes = {1000, 10000, 100000};
  if (chosen.quick && options.sizes.empty()) chosen.sizes.pop_back();
  runPairsOf(bookPeers(), chosen, records);
  runLoading(chosen, chosen.sizes, records);
  for (const std::size_t n : chosen.sizes) runQueriesOf(bookQueryPeers(), n, chosen, records);
}

}  // namespace bench
}  // namespace hgrid
