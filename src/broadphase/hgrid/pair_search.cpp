// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <mutex>
#include <new>

#include "broadphase/hgrid/engine.h"
#include "broadphase/hgrid/pair_writer.h"

namespace hgrid {
namespace {

/// Performs a task. The pairs go to `sink`.
void perform(const SearchTask& task, const kernels::Kernels& kernels, GatheredBoxes& gathered,
             kernels::PairSink* sink) {
  if (task.layer != nullptr) {
    RegionSearch search(kernels, gathered, sink);
    for (std::uint32_t region = task.begin; region < task.end && !sink->full; ++region) {
      if (task.other == nullptr) {
        search.within(*task.layer, region);
      } else {
        search.across(*task.layer, region, *task.other);
      }
    }
  } else if (task.asked == nullptr) {
    kernels.pairsWithin(task.asking, task.begin, task.end, sink);
  } else {
    kernels.pairsAcross(task.asking, task.begin, task.end, task.asked, sink);
  }
}

/// Performs the tasks. Writes the pairs after the first `used` pairs of the vector, in the order of the tasks.
/// @returns whether these are all pairs; false if they exceed the bound of the tally
bool performAll(SearchBuffers& buffers, const kernels::Kernels& kernels, const CombinedFilter& filter, Tally& tally,
                Workers* workers, std::vector<ProxyPair>& pairs, std::size_t used) {
  std::vector<SearchTask>& tasks = buffers.tasks;
  std::size_t boxes = 0;
  for (const SearchTask& task : tasks) boxes += task.boxes;
  if (workers == nullptr || workers->threads() == 1 || boxes < 2 * kWorthAThread) {
    if (buffers.gathered.empty()) buffers.gathered.resize(1);
    PairWriter writer(pairs, used, filter, tally);
    for (const SearchTask& task : tasks) {
      if (tally.exceeded()) return false;
      perform(task, kernels, buffers.gathered.front(), writer.sink());
    }
    pairs.resize(writer.filter());
    return !tally.exceeded();
  }
  const auto threads = static_cast<std::size_t>(workers->threads());
  buffers.parts.resize(threads);
  buffers.used.assign(threads, 0);
  if (buffers.gathered.size() < threads) buffers.gathered.resize(threads);
  workers->run(tasks.size(), [&](std::size_t number, std::size_t thread) {
    if (tally.exceeded()) return;
    SearchTask& task = tasks[number];
    std::vector<ProxyPair>& part = buffers.parts[thread];
    PairWriter writer(part, buffers.used[thread], filter, tally);
    perform(task, kernels, buffers.gathered[thread], writer.sink());
    task.thread = thread;
    task.first = buffers.used[thread];
    buffers.used[thread] = writer.filter();
    task.found = buffers.used[thread] - task.first;
  });
  if (tally.exceeded()) return false;
  std::size_t total = used;
  for (SearchTask& task : tasks) {
    task.to = total;
    total += task.found;
  }
  if (total > pairs.capacity()) pairs.reserve(total + total / 8);  // room for a few more pairs next time
  pairs.resize(total);
  for (std::vector<ProxyPair>& part : buffers.parts) {
    const std::size_t all = total - used + SearchTask::kBoxes;
    if (part.capacity() < all) part.reserve(all + all / 4);
  }
  workers->run(tasks.size(), [&](std::size_t number, std::size_t) {
    const SearchTask& task = tasks[number];
    std::copy_n(buffers.parts[task.thread].data() + task.first, task.found, pairs.data() + task.to);
  });
  return true;
}

}  // namespace

void HGrid::Engine::findKept() {
  kept_valid = kept_moving = false;
  buffers.tasks.clear();
  addWithin(buffers.tasks, layers[kResting]);
  addAcross(buffers.tasks, layers[kResting], layers[kFixed]);
  Tally tally(bound, 0, 0);
  kept_valid = performAll(buffers, *loops, {filter, nullptr}, tally, workers.get(), kept, 0);
  kept_overlaps = tally.overlaps();
  if (!kept_valid) kept.clear();
}

bool HGrid::Engine::findPairs(std::vector<ProxyPair>& pairs, const PairBound& up_to) const {
  pairs_wanted.store(true, std::memory_order_relaxed);
  sortLoose();
  std::unique_lock<std::mutex> lock(search_mutex, std::try_to_lock);
  SearchBuffers own;
  SearchBuffers& used_buffers = lock.owns_lock() ? buffers : own;
  std::vector<SearchTask>& tasks = used_buffers.tasks;
  tasks.clear();
  std::size_t used = 0;
  if (kept_valid) {
    if (pairs.size() < kept.size()) pairs.resize(kept.size());
    if (!kept_dirty) {
      used = static_cast<std::size_t>(std::copy(kept.begin(), kept.end(), pairs.begin()) - pairs.begin());
    } else {
      for (const ProxyPair& pair : kept) {
        pairs[used] = pair;
        used += isKept(pair) ? 1 : 0;
      }
    }
  } else {
    addWithin(tasks, layers[kResting]);
    addAcross(tasks, layers[kResting], layers[kFixed]);
  }
  for (const LayerNumber mobile : {kMoving, kLoose}) {
    if (mobile == kMoving && kept_valid && kept_moving) continue;
    addWithin(tasks, layers[mobile]);
    for (int other = kFixed; other < mobile; ++other)
      addAcross(tasks, layers[mobile], layers[static_cast<std::size_t>(other)]);
  }
  Tally tally(up_to, used, kept_valid ? kept_overlaps : 0);
  const bool complete = performAll(used_buffers, *loops, {filter, fixed_astray ? &fixed : nullptr}, tally,
                                   lock.owns_lock() ? workers.get() : nullptr, pairs, used);
  if (complete && keep_found && lock.owns_lock() && !buffers.found_valid) {
    try {
      // Like the caller's buffer, this one needs room for a few more pairs next time.
      if (buffers.found.capacity() < pairs.size()) buffers.found.reserve(pairs.size() + pairs.size() / 8);
      buffers.found.assign(pairs.begin(), pairs.end());
      buffers.found_overlaps = tally.overlaps();
      buffers.found_valid = true;
    } catch (const std::bad_alloc&) {  // then these pairs will be searched again
    }
  }
  return complete;
}

void HGrid::setPairBound(const PairBound& bound) {
  engine_->bound = bound;
  engine_->dropKept();
}

void HGrid::overlappingPairs(std::vector<ProxyPair>& pairs) const { engine_->findPairs(pairs, PairBound{}); }

// findPairs() may count more overlaps than collectPairs(), but never fewer: it also counts overlaps of boxes that have
// left their layer, and of fixed boxes in other layers. So collectPairs() decides whether the bound is exceeded.
bool HGrid::boundedPairs(std::vector<ProxyPair>& pairs) const {
  return engine_->findPairs(pairs, engine_->bound) || engine_->collectPairs(pairs);
}

}  // namespace hgrid
