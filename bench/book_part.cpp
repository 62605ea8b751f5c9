// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <chrono>
#include <cstdio>

#include "bench/parts.h"
#include "bench/peers/book_peers.h"
#include "bench/workload/workloads.h"
#include "partitions/cell_scale.h"
#include "partitions/pair_bits.h"
#include "partitions/stamps.h"

namespace hgrid {
namespace bench {
namespace {

void runLoading(const Options& options, std::vector<Record>& records) {
  for (const std::string& workload : options.boxWorkloads(evenWorkloads())) {
    for (const std::size_t n : options.sizes) {
      const World world(workload, n, 1.0);
      std::printf("\n%s, n = %zu, loading\n", workload.c_str(), n);
      for (const BroadPhaseType type : broadPhaseTypes()) {
        if (!options.peer(name(type))) continue;
        const Loading loading = loadingOf(type, world.boxes());
        std::printf("  %-28s %10.3f ms  %6.0f bytes per box\n", name(type), loading.ms, loading.bytes);
        records.push_back(Record("load")
                              .text("peer", name(type))
                              .text("workload", workload)
                              .number("n", double(n))
                              .number("median_ms", loading.ms)
                              .number("bytes_per_object", loading.bytes));
      }
      std::fflush(stdout);
    }
  }
}

/// Returns the time [ns] per call of `work`.
template <class Work>
double timeOf(std::size_t calls, Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < calls; ++i) work(i);
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count() / double(calls);
}

/// Compares ways to notice what was visited already (section 7.7): stamps of 64 and of 8 bits, and bits of pairs with
/// the cell in which a pair is reported. A query visits 32 objects; a frame has 4 candidate pairs per object.
void runBookkeeping(const std::vector<std::size_t>& sizes, std::vector<Record>& records) {
  constexpr std::size_t kVisits = 32, kCandidates = 4;
  for (const std::size_t n : sizes) {
    std::size_t sum = 0;
    const auto place = [&](std::size_t i) { return (i * 2654435761u) % n; };
    const auto note = [&](const char* name, double ns) {
      std::printf("  %-40s %10zu objects %12.1f ns\n", name, n, ns);
      records.push_back(Record("bookkeeping").text("name", name).number("n", double(n)).number("ns", ns));
    };
    book::Stamps stamps;
    note("query with 64-bit stamps", timeOf(20000, [&](std::size_t query) {
           stamps.begin(n);
           for (std::size_t i = 0; i < kVisits; ++i) sum += stamps.mark(place(query + i)) ? 1 : 0;
         }));
    book::SmallStamps small(n);
    note("query with 8-bit stamps", timeOf(20000, [&](std::size_t query) {
           small.begin();
           for (std::size_t i = 0; i < kVisits; ++i) sum += small.mark(place(query + i)) ? 1 : 0;
         }));
    if (n <= 20000) {
      book::PairBits bits;
      note("frame with bits of pairs", timeOf(20, [&](std::size_t) {
             bits.reset(n);
             for (std::size_t i = 0; i < kCandidates * n; ++i) {
               const std::size_t a = place(i), b = place(i + n / 2 + 1);
               sum += a != b && bits.mark(a, b) ? 1 : 0;
             }
           }));
    }
    const World world("uniform", n, 1.0);
    const book::CellScale scale(1.0);
    note("frame with the cell of a pair", timeOf(20, [&](std::size_t) {
           for (std::size_t i = 0; i < kCandidates * n; ++i) {
             const book::Cell cell = scale.reportingCell(world.boxes()[place(i)], world.boxes()[place(i + n / 2 + 1)]);
             sum += cell.x == 0 ? 1 : 0;
           }
         }));
    if (sum == 0) std::printf("nothing was visited\n");  // also keeps the compiler from leaving out the loops
  }
}

}  // namespace

void runBook(const Options& options, std::vector<Record>& records) {
  Options chosen = options;
  if (chosen.sizes.empty()) chosen.sizes = {1000, 10000, 100000};
  if (chosen.quick && options.sizes.empty()) chosen.sizes.pop_back();
  runPairsOf(bookPeers(), chosen, records);
  runLoading(chosen, records);
  runBookkeeping({300, 1000, 10000, 100000}, records);
  for (const std::size_t n : chosen.sizes) runQueriesOf(bookQueryPeers(), n, chosen, records);
}

}  // namespace bench
}  // namespace hgrid
