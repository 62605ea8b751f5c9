// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <algorithm>
#include <atomic>

#include "broadphase/hgrid/engine.h"

namespace hgrid {
namespace {

constexpr std::uint32_t kTask = 1024;         // boxes per task; a multiple of what kernels take at once
constexpr std::size_t kWorthAThread = 16384;  // boxes

bool notBothFixed(const void* fixed, ProxyId first, ProxyId second) {
  const auto& is = *static_cast<const std::vector<bool>*>(fixed);
  return !(first < is.size() && is[first] && second < is.size() && is[second]);
}

/// Leaves out the pairs of two fixed boxes, then those that the overlap filter does not keep.
struct CombinedFilter {
  const OverlapFilter& overlaps;
  const std::vector<bool>* fixed;  // by id; null if all fixed boxes are in the fixed layer, which makes no pairs

  /// Moves the kept ones of the pairs from index `from` to `end` to the front. @returns their end
  std::size_t keep(std::vector<ProxyPair>& pairs, std::size_t from, std::size_t end) const {
    ProxyPair *const first = pairs.data() + from, *last = pairs.data() + end;
    if (fixed != nullptr) last = OverlapFilter::of<notBothFixed>(fixed)(first, last);
    return static_cast<std::size_t>(overlaps(first, last) - pairs.data());
  }
};

/// Counts what all threads of a search find, and says when that exceeds the bound.
class Tally {
 public:
  /// @param pairs, overlaps  known before the search
  Tally(const PairBound& bound, std::size_t pairs, std::size_t overlaps)
      : bound_(bound),
        pairs_(pairs),
        overlaps_(overlaps),
        exceeded_(pairs > bound.pairs || overlaps > bound.overlaps) {}

  void add(std::size_t pairs, std::size_t overlaps) {
    const std::size_t all_pairs = pairs_.fetch_add(pairs, std::memory_order_relaxed) + pairs;
    const std::size_t all_overlaps = overlaps_.fetch_add(overlaps, std::memory_order_relaxed) + overlaps;
    if (all_pairs > bound_.pairs || all_overlaps > bound_.overlaps) exceeded_.store(true, std::memory_order_relaxed);
  }
  bool exceeded() const { return exceeded_.load(std::memory_order_relaxed); }
  std::size_t overlaps() const { return overlaps_.load(std::memory_order_relaxed); }
  const PairBound& bound() const { return bound_; }

 private:
  const PairBound bound_;
  std::atomic<std::size_t> pairs_, overlaps_;
  std::atomic<bool> exceeded_;
};

/// Lets kernels write into a vector after the first `used` pairs.
///
/// The vector grows until it has room for the bound and kRoom more. When that is full, the pairs are filtered to make
/// room. When the bound is exceeded, nothing more is wanted. The vector ends up as large as it ever was.
class PairWriter {
 public:
  PairWriter(std::vector<ProxyPair>& pairs, std::size_t used, const CombinedFilter& filter, Tally& tally)
      : pairs_(pairs), wanted_end_(used), filter_(filter), tally_(tally) {
    pairs_.resize(std::max<std::size_t>({pairs_.capacity(), used + 64, 256}));
    sink_.owner = this;
    sink_.grow = grow;
    point(used);
  }
  PairWriter(const PairWriter&) = delete;
  PairWriter& operator=(const PairWriter&) = delete;

  kernels::PairSink* sink() { return &sink_; }
  /// Filters what was written since the last time. @returns the end of the wanted pairs; of no use beyond the bound
  std::size_t filter() {
    if (tally_.exceeded()) return wanted_end_;
    const std::size_t end = used(), begin = wanted_end_;
    wanted_end_ = filter_.keep(pairs_, begin, end);
    tally_.add(wanted_end_ - begin, end - begin);
    return wanted_end_;
  }

 private:
  static constexpr std::size_t kRoom = 65536;  // pairs that can at least be written between two times of filtering
  static constexpr std::size_t kLeast = 16;    // pairs that a kernel writes before it asks again

  kernels::Pair* data() const { return reinterpret_cast<kernels::Pair*>(pairs_.data()); }
  std::size_t used() const { return static_cast<std::size_t>(sink_.next - data()); }
  void point(std::size_t used) {
    sink_.next = data() + used;
    sink_.limit = data() + pairs_.size();
  }
  void makeRoom() {
    const std::size_t bound = tally_.bound().pairs;
    const std::size_t largest = bound < PairBound::kNone - kRoom ? bound + kRoom : PairBound::kNone;
    if (pairs_.size() + kLeast <= largest) {
      const std::size_t end = used();
      pairs_.resize(std::min(2 * pairs_.size(), largest));
      return point(end);
    }
    point(filter());
    if (!tally_.exceeded()) return;
    sink_.full = true;
    point(0);
  }
  static void grow(kernels::PairSink* sink) { static_cast<PairWriter*>(sink->owner)->makeRoom(); }

  std::vector<ProxyPair>& pairs_;
  std::size_t wanted_end_;  // pairs before it are filtered and counted
  const CombinedFilter& filter_;
  Tally& tally_;
  kernels::PairSink sink_{};
};

void addTask(std::vector<SearchTask>& tasks, const kernels::Level& asking, const kernels::Level* asked) {
  for (std::uint32_t begin = asking.begin; begin < asking.end; begin += kTask) {
    tasks.push_back({&asking, asked, begin, std::min(begin + kTask, asking.end)});
  }
}

/// Two levels: those ask whose boxes have fewer rows of cells to look at in all.
void addAcross(std::vector<SearchTask>& tasks, const Layer& a, std::size_t level_a, const Layer& b,
               std::size_t level_b) {
  const kernels::Level &first = a.levels()[level_a], &second = b.levels()[level_b];
  if (first.begin == first.end || second.begin == second.end) return;
  const double first_asks =
      static_cast<double>(first.end - first.begin) * rowsAsked(a.plan(), level_a, b.plan(), level_b, second.reach);
  const double second_asks =
      static_cast<double>(second.end - second.begin) * rowsAsked(b.plan(), level_b, a.plan(), level_a, first.reach);
  if (first_asks <= second_asks) {
    addTask(tasks, first, &second);
  } else {
    addTask(tasks, second, &first);
  }
}

/// Each level with itself and with each coarser one (Ericson 2005, 7.2).
void addWithin(std::vector<SearchTask>& tasks, const Layer& layer) {
  for (std::size_t level = 0; level < layer.levels().size(); ++level) {
    addTask(tasks, layer.levels()[level], nullptr);
    for (std::size_t coarser = level + 1; coarser < layer.levels().size(); ++coarser) {
      addAcross(tasks, layer, level, layer, coarser);
    }
  }
}

void addAcross(std::vector<SearchTask>& tasks, const Layer& a, const Layer& b) {
  for (std::size_t i = 0; i < a.levels().size(); ++i) {
    for (std::size_t j = 0; j < b.levels().size(); ++j) addAcross(tasks, a, i, b, j);
  }
}

void perform(const SearchTask& task, const kernels::Kernels& kernels, kernels::PairSink* sink) {
  if (task.asked == nullptr) {
    kernels.pairsWithin(task.asking, task.begin, task.end, sink);
  } else {
    kernels.pairsAcross(task.asking, task.begin, task.end, task.asked, sink);
  }
}

/// Performs the tasks. Writes the pairs after the first `used` of the vector, in the order of the tasks.
/// @returns whether these are all pairs; not if the tally exceeds its bound
bool performAll(SearchBuffers& buffers, const kernels::Kernels& kernels, const CombinedFilter& filter, Tally& tally,
                Workers* workers, std::vector<ProxyPair>& pairs, std::size_t used) {
  std::vector<SearchTask>& tasks = buffers.tasks;
  std::size_t boxes = 0;
  for (const SearchTask& task : tasks) boxes += task.end - task.begin;
  if (workers == nullptr || workers->threads() == 1 || boxes < 2 * kWorthAThread) {
    PairWriter writer(pairs, used, filter, tally);
    for (const SearchTask& task : tasks) {
      if (tally.exceeded()) return false;
      perform(task, kernels, writer.sink());
    }
    pairs.resize(writer.filter());
    return !tally.exceeded();
  }
  const auto threads = static_cast<std::size_t>(workers->threads());
  buffers.parts.resize(threads);
  buffers.used.assign(threads, 0);
  workers->run(tasks.size(), [&](std::size_t number, std::size_t thread) {
    if (tally.exceeded()) return;
    SearchTask& task = tasks[number];
    std::vector<ProxyPair>& part = buffers.parts[thread];
    PairWriter writer(part, buffers.used[thread], filter, tally);
    perform(task, kernels, writer.sink());
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
  if (total > pairs.capacity()) pairs.reserve(total + total / 8);  // the next time there may be a few more
  pairs.resize(total);
  for (std::vector<ProxyPair>& part : buffers.parts) {
    const std::size_t all = total - used + kTask;
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
  kept_valid = false;
  buffers.tasks.clear();
  addWithin(buffers.tasks, layers[kResting]);
  addAcross(buffers.tasks, layers[kResting], layers[kFixed]);
  Tally tally(bound, 0, 0);
  kept_valid = performAll(buffers, kernels::of(isa), {filter, nullptr}, tally, workers.get(), kept, 0);
  kept_overlaps = tally.overlaps();
  if (!kept_valid) kept.clear();
}

bool HGrid::Engine::findPairs(std::vector<ProxyPair>& pairs, const PairBound& up_to) const {
  pairs_wanted.store(true, std::memory_order_relaxed);
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
        used += layer_of[pair.first] <= kResting && layer_of[pair.second] <= kResting;
      }
    }
  } else {
    addWithin(tasks, layers[kResting]);
    addAcross(tasks, layers[kResting], layers[kFixed]);
  }
  for (const LayerNumber mobile : {kMoving, kLoose}) {
    addWithin(tasks, layers[mobile]);
    for (int other = kFixed; other < mobile; ++other)
      addAcross(tasks, layers[mobile], layers[static_cast<std::size_t>(other)]);
  }
  Tally tally(up_to, used, kept_valid ? kept_overlaps : 0);
  return performAll(used_buffers, kernels::of(isa), {filter, fixed_astray ? &fixed : nullptr}, tally,
                    lock.owns_lock() ? workers.get() : nullptr, pairs, used);
}

void HGrid::setPairBound(const PairBound& bound) {
  engine_->bound = bound;
  engine_->kept_valid = false;
}

void HGrid::overlappingPairs(std::vector<ProxyPair>& pairs) const { engine_->findPairs(pairs, PairBound{}); }

// What the search counts may exceed the bound although the collection does not: it includes overlaps of boxes that
// have left their layer and of fixed boxes that stand among others. It is never less. So the collection decides.
bool HGrid::boundedPairs(std::vector<ProxyPair>& pairs) const {
  return engine_->findPairs(pairs, engine_->bound) || engine_->collectPairs(pairs);
}

}  // namespace hgrid
